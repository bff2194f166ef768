"""The memories of several solids: what was, from slab to slab."""

from collections.abc import Sequence

import numpy as np

from softway.bodies.memory import Memory
from softway.bodies.part import Part
from softway.bodies.rate_force import RateForce
from softway.typing import Array

Memories = tuple[Memory | None, ...]
"""The memory of each solid, None where it has none; empty before anything happened."""


def remembering(parts: Sequence[Part]) -> bool:
    """Whether any solid has a memory."""
    return any(isinstance(p.internal, RateForce) for p in parts)


def known(parts: Sequence[Part], memories: Memories) -> Memories:
    """The memories, or those that the solids have as they are."""
    return memories or tuple(p.internal.memory if isinstance(p.internal, RateForce) else None for p in parts)


def during(parts: Sequence[Part], memories: Memories, span: float) -> tuple[Part, ...]:
    """The solids in a slab of length ``span`` [s]: those with a memory answer from it."""
    return tuple(p.during(m, span) for p, m in zip(parts, known(parts, memories), strict=True))


def settled(parts: Sequence[Part], u: Array) -> Memories:
    """The memories at the end of the slab, at the displacement u (n, d)."""
    if not remembering(parts):
        return ()
    return tuple(p.internal.settled(u[p.rows]) if isinstance(p.internal, RateForce) else None for p in parts)


def stored(parts: Sequence[Part], memories: Memories, energy: Array) -> Array:
    """Stored energy (parts,) [J]: that of the memories, and ``energy`` (parts,) of the solids that have none."""
    found = [
        p.internal.stored(m) if m is not None and isinstance(p.internal, RateForce) else e
        for p, m, e in zip(parts, known(parts, memories), energy, strict=True)
    ]
    return np.array(found)


def dissipated(parts: Sequence[Part], memories: Memories) -> float:
    """Energy that the laws have dissipated since the start [J]."""
    pairs = zip(parts, known(parts, memories), strict=True)
    return sum(p.internal.dissipated(m) for p, m in pairs if m is not None and isinstance(p.internal, RateForce))


def viscous_force(parts: Sequence[Part], u: Array) -> Array | None:
    """The part (n, d) of the internal force that belongs to the mean rate of the slab [N]; None without any."""
    return _joined(
        parts, [p.internal.viscous_force(u[p.rows]) if isinstance(p.internal, RateForce) else None for p in parts]
    )


def remembered_viscous(parts: Sequence[Part], memories: Memories) -> Array | None:
    """:func:`viscous_force` of the slab that left the memories, (n, d) [N]: nothing is asked of the laws again."""
    found = [
        p.internal.remembered(m)[2]
        if isinstance(p.internal, RateForce) and m is not None and m.viscous is not None
        else None
        for p, m in zip(parts, known(parts, memories), strict=True)
    ]
    return _joined(parts, found)


def remembered(parts: Sequence[Part], memories: Memories, u: Array) -> tuple[Array, Array, Array | None]:
    """Stored energy (parts,) [J], force (n, d) and its viscous part [N] at the time of the memories."""
    found: list[tuple[float, Array, Array | None]] = []
    for p, m in zip(parts, known(parts, memories), strict=True):
        if m is not None and isinstance(p.internal, RateForce):
            found.append(p.internal.remembered(m))
        else:
            found.append((*p.internal.energy_and_force(u[p.rows]), None))
    viscous = _joined(parts, [v for _, _, v in found])
    return np.array([e for e, _, _ in found]), np.concatenate([f for _, f, _ in found]), viscous


def remembered_stress(part: Part, u: Array, memory: Memory | None) -> Array:
    """Mean Cauchy stress (cells, 3, 3) of a solid at its displacement u (n, d) [Pa], or of its memory."""
    if memory is None or not isinstance(part.internal, RateForce):
        return part.internal.stress(u)
    return part.internal.remembered_stress(memory)


def remembered_scalars(part: Part, memory: Memory | None) -> dict[str, Array]:
    """What a memory of a solid holds for each cell (e,) by name; nothing where it has none."""
    if memory is None or not isinstance(part.internal, RateForce):
        return {}
    return part.internal.remembered_scalars(memory)


def _joined(parts: Sequence[Part], fields: list[Array | None]) -> Array | None:
    """The field (n, d) of those of the solids, zero where a solid has none; None if none has."""
    if all(f is None for f in fields):
        return None
    return np.concatenate(
        [np.zeros((p.mesh.n_nodes, p.mesh.dim)) if f is None else f for p, f in zip(parts, fields, strict=True)]
    )
