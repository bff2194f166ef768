"""Material states of all solids, from slab to slab."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.material_state import MaterialState

MaterialStates = tuple[MaterialState | None, ...]
"""Material state of each solid, None for elastic solids; empty for the initial states."""


def any_path_dependent(parts: Sequence[DiscreteSolid]) -> bool:
    """True if the force of any solid depends on a material state."""
    return any(p.internal.path_dependent for p in parts)


def initial_states(parts: Sequence[DiscreteSolid]) -> MaterialStates:
    """Material states from which the forces of the solids start."""
    return tuple(p.internal.state for p in parts)


def during(parts: Sequence[DiscreteSolid], states: MaterialStates, span: float) -> tuple[DiscreteSolid, ...]:
    """Solids in a slab of length ``span`` [s] that starts from the material states."""
    return tuple(p.during(s, span) for p, s in zip(parts, _given(parts, states), strict=True))


def own_state(states: MaterialStates, solid: int, region: str) -> MaterialState:
    """State of the law of a region of a solid, by its number; of a solid of one law without a region."""
    state = states[solid]
    assert state is not None
    return of_region(state, region)


def with_own_state(states: MaterialStates, solid: int, region: str, new: MaterialState) -> MaterialStates:
    """States with a new one in the place of :func:`own_state`."""
    state = states[solid]
    assert state is not None
    return (*states[:solid], with_region(state, region, new), *states[solid + 1 :])


def of_region(state: MaterialState, region: str) -> MaterialState:
    """State of the law of a region in that of a solid; the state itself of a solid of one law, without a region."""
    return state.regions[region] if region else state


def with_region(state: MaterialState, region: str, new: MaterialState) -> MaterialState:
    """State of a solid with a new one in the place of :func:`of_region`."""
    return replace(state, regions={**state.regions, region: new}) if region else new


def scaled(parts: tuple[DiscreteSolid, ...], factor: Array | None) -> tuple[DiscreteSolid, ...]:
    """Solids with factors (n,) of the stiffness at the nodes; the solids themselves without any."""
    return parts if factor is None else tuple(replace(part, factor=factor[part.nodes]) for part in parts)


def committed(parts: Sequence[DiscreteSolid], u: Array) -> MaterialStates:
    """Material states at the end of the slab, at the displacement u (n, d)."""
    return tuple(p.internal.committed(u[p.nodes]) for p in parts) if any_path_dependent(parts) else ()


def stored_energy(parts: Sequence[DiscreteSolid], states: MaterialStates, energy: Array) -> Array:
    """Stored energy (parts,) [J] in the material states, where the forces at their time gave ``energy`` (parts,)."""
    pairs = zip(parts, _given(parts, states), energy, strict=True)
    return np.array([p.internal.stored_energy(s, e) for p, s, e in pairs])


def dissipated_energy(parts: Sequence[DiscreteSolid], states: MaterialStates) -> float:
    """Energy dissipated by the materials since the start of the march [J]."""
    return sum(p.internal.dissipated_energy(s) for p, s in zip(parts, _given(parts, states), strict=True))


def end_force(parts: Sequence[DiscreteSolid], u: Array) -> tuple[Array, Array, Array | None]:
    """Energy (parts,) [J] and force (n, d) at the end of a slab, and the part of the force due to the mean rate of the
    slab (n, d) [N], None without viscosity.
    """
    return _assembled(parts, (p.internal.end_force(u[p.nodes]) for p in parts))


def stored_viscous_force(parts: Sequence[DiscreteSolid], states: MaterialStates) -> Array | None:
    """Viscous part (n, d) of :func:`end_force` [N] in the material states, without another evaluation of the laws."""
    pairs = zip(parts, _given(parts, states), strict=True)
    return _joined(parts, [p.internal.stored_viscous_force(s) for p, s in pairs])


def stored_force(parts: Sequence[DiscreteSolid], states: MaterialStates, u: Array) -> tuple[Array, Array, Array | None]:
    """Stored energy (parts,) [J], force (n, d) and its viscous part [N] in the material states, at u (n, d)."""
    pairs = zip(parts, _given(parts, states), strict=True)
    return _assembled(parts, (p.internal.stored_force(s, u[p.nodes]) for p, s in pairs))


def _assembled(
    parts: Sequence[DiscreteSolid], found: Iterable[tuple[float, Array, Array | None]]
) -> tuple[Array, Array, Array | None]:
    """Energy (parts,) [J], force (n, d) and its viscous part [N], None without viscosity, from those of the solids."""
    energy, force, viscous = zip(*found, strict=True)
    return np.array(energy), np.concatenate(force), _joined(parts, viscous)


def _given(parts: Sequence[DiscreteSolid], states: MaterialStates) -> MaterialStates:
    """The states, or the initial ones if there are none."""
    return states or initial_states(parts)


def _joined(parts: Sequence[DiscreteSolid], fields: Sequence[Array | None]) -> Array | None:
    """Field (n, d) of all solids, zero on solids without one; None if all are None."""
    if all(f is None for f in fields):
        return None
    return np.concatenate(
        [np.zeros((p.mesh.n_nodes, p.mesh.dim)) if f is None else f for p, f in zip(parts, fields, strict=True)]
    )
