"""Massless nodes on a new mesh: their equilibrium with contacts, friction and the memory of the material."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.material_states import MaterialStates, any_path_dependent
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import DofMap
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce
from softway.bodies.internal_force.material_state import OPTIONAL, MaterialState
from softway.bodies.internal_force.regions import RegionForces
from softway.errors import NumericsError
from softway.laws.law import Damped, Viscous
from softway.marching.remeshing.carried.kept_contacts import KeptContacts
from softway.marching.remeshing.carried.surface_forces import SurfaceForces
from softway.model.model import Model
from softway.solve.stagnation import Stagnation
from softway.solve.static.proximal_equilibrium import proximal_equilibrium
from softway.solve.static.static_equilibrium import InitialSlip, StaticState, equilibrium

log = logging.getLogger(__name__)
SUDDEN = 1e-6
"""Time of the change of a mesh, relative to a slab, for laws whose stress relaxes: it does not."""
EXACT = 1e-11
"""Change of the friction, relative to the greatest, below which it is found."""
PATIENCE = 6
"""Equilibria without a change half as small after which the search is given up."""
ROUNDED = 1e-6
"""Greatest change, relative as well, that the rounding of such equilibria explains."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Unsettled:
    """Solids on new meshes before their massless nodes are in equilibrium.

    Parameters
    ----------
    model
        Model of the new meshes, whose companion fields start from the present values.
    displacement
        (n, d) projected displacement [m].
    states
        Material states there.
    friction
        Friction on the surfaces; None without.
    kept
        Contacts of nodes with inertia that stay closed; None where contact nodes have none.
    time, span
        Time, and length of a slab [s].
    """

    model: Model
    displacement: Array
    states: MaterialStates
    friction: SurfaceForces | None
    kept: KeptContacts | None
    time: float
    span: float

    def settled(self) -> tuple[StaticState, MaterialStates]:
        """Equilibrium of the massless nodes, or contact nodes with inertia in their places, and the material states
        there; all other nodes are fixed.

        Raises
        ------
        NumericsError
            If there is none.
        """
        if not any_path_dependent(self.model.parts):
            return self._rest(self.model), ()
        parts = zip(self.model.parts, self.states, strict=True)
        model = replace(self.model, parts=tuple(_changing(part, state, self.span) for part, state in parts))
        rest = self._rest(model)
        light = ~model.massive | (rest.displacement != self.displacement).any(axis=1)
        found = (_reached(p, s, rest.displacement, light) for p, s in zip(model.parts, self.states, strict=True))
        return rest, tuple(found)

    def _rest(self, model: Model) -> StaticState:
        """Equilibrium of the massless nodes with the friction that passes over.

        Where there is none, rows stick where they are and slip beyond their limits; and where there is none either,
        the friction begins anew in the slab that follows.
        """
        u, dofs, load = self.displacement, model.dofs.only(~model.massive), model.loads.at(self.time)
        if self.kept is not None:
            u, rows = self.kept.placed(model, u, self.time)
            return StaticState.apart(u, len(rows.node))
        carried, glue = self.friction, model.bonds
        if carried is None or not dofs.size:
            return _smooth(model, u, dofs, load, self.time)
        none = np.zeros((len(model.contacts.contact), u.shape[1]))
        sticks = InitialSlip(reference=u, velocity=none)
        tries: tuple[tuple[str, Callable[[], StaticState]], ...] = (
            ("friction of the places", lambda: self._rubbing(model, carried, dofs, load)),
            ("sticking", lambda: equilibrium(model, u, dofs, load, self.time, friction=sticks, glue=glue)),
        )
        for name, found in tries:
            try:
                return found()
            except NumericsError as failure:
                log.info("massless nodes at t = %.6g s, %s: %s", self.time, name, failure.what)
        return _smooth(model, u, dofs, load, self.time)

    def _rubbing(self, model: Model, carried: SurfaceForces, dofs: DofMap, load: Array) -> StaticState:
        """Equilibrium under the friction of the places.

        Raises
        ------
        NumericsError
            If there is none: where rows hardly differ, beside an edge, friction may move the pressure from one to
            another, which have other friction.
        """
        u = self.displacement
        rows, friction = model.rows(u, self.time), model.friction.at(u)
        traction, sliding = carried.first(rows, friction), np.zeros(len(rows.node), bool)
        seen = Stagnation()
        while seen.since < PATIENCE:
            pushed = load + rows.shear.spread(traction)
            rest = equilibrium(model, u, dofs, pushed, self.time, glue=model.bonds)
            u, last = rest.displacement, traction
            rows, friction = model.rows(u, self.time), model.friction.at(u)
            traction, sliding = carried.forces(rows, friction, rest.pressure)
            change, size = model.space.greatest(traction - last), model.space.greatest(traction)
            seen = seen.after(change)
            if change <= (ROUNDED if seen.since == PATIENCE else EXACT) * size:
                return replace(rest, traction=traction, sliding=sliding)
        raise NumericsError("friction and pressure change each other without end", self.time)


def _smooth(model: Model, u: Array, dofs: DofMap, load: Array, time: float) -> StaticState:
    """Equilibrium without friction, from the displacement u (n, d)."""
    try:
        return equilibrium(model, u, dofs, load, time, glue=model.bonds)
    except NumericsError as failure:
        log.info("massless nodes at t = %.6g s, no friction: %s", time, failure.what)
    return proximal_equilibrium(model, u, dofs, load, time, model.bonds)


def _changing(part: DiscreteSolid, state: MaterialState | None, span: float) -> DiscreteSolid:
    """Solid in the change of its mesh, from a material state."""
    internal = part.internal
    if state is None:
        return part
    if isinstance(internal, RegionForces):
        own = state.regions
        terms = (replace(t, internal=_law_changing(t.internal, own.get(t.region), span)) for t in internal.terms)
        return replace(part, internal=replace(internal, terms=tuple(terms)))
    return replace(part, internal=_law_changing(internal, state, span))


def _law_changing(internal: BodyForce, state: MaterialState | None, span: float) -> BodyForce:
    """Internal force of one law in the change of its mesh."""
    if state is None or not isinstance(internal, InelasticForce):
        return internal
    steady = isinstance(internal.material, Viscous | Damped)
    return internal.during(state, span if steady else SUDDEN * span)


def _reached(part: DiscreteSolid, state: MaterialState | None, u: Array, light: BoolArray) -> MaterialState | None:
    """Material state in the equilibrium u (n, d): in cells without a ``light`` node (n,) nothing has happened.

    Volume changes that are averaged around corners change one ring of cells further.
    """
    found = part.internal.committed(u[part.nodes])
    if state is None or found is None:
        return found
    blocks, nodes = part.mesh.blocks.values(), light[part.nodes]
    if part.dilatation == "corner":
        around = np.zeros_like(nodes)
        for block in blocks:
            around[block[nodes[block].any(axis=1)]] = True
        nodes = around
    counts = [table.shape[1] for table in part.internal.sampling.rows]
    points = np.concatenate([np.repeat(nodes[b].any(axis=1), q) for b, q in zip(blocks, counts, strict=True)])
    if not isinstance(part.internal, RegionForces):
        return _merged(found, state, points)
    terms: Mapping[str, IntArray] = {term.region: term.points for term in part.internal.terms}
    regions = {name: _merged(one, state.regions[name], points[terms[name]]) for name, one in found.regions.items()}
    return replace(found, regions=regions)


def _merged(new: MaterialState, old: MaterialState, which: BoolArray) -> MaterialState:
    """State with the values of ``new`` at some points (p,), and of ``old`` at the others."""

    def chosen(one: Array, other: Array) -> Array:
        return np.where(which.reshape(-1, *(1,) * (one.ndim - 1)), one, other)

    optional: dict[str, Any] = {}
    for name in OPTIONAL:
        one, other = getattr(new, name), getattr(old, name)
        optional[name] = one if other is None else chosen(other if one is None else one, other)
    return replace(
        new,
        stress=chosen(new.stress, old.stress),
        law={name: chosen(values, old.law[name]) for name, values in new.law.items()},
        lateral=chosen(new.lateral, old.lateral),
        stored=chosen(new.stored, old.stored),
        dissipated=chosen(new.dissipated, old.dissipated),
        **optional,
    )
