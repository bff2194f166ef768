"""Ties that break on other meshes: their damage passes by the place on the surface."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.linked_solids import Glue
from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.marching.state.model_state import ModelState
from softway.model.cohesive_ties import CohesiveTie, CohesiveTies
from softway.model.model import Model
from softway.solve.equations.slab_values import SlabStart

NEAR = 0.5
"""Opening, relative to that at which the damage starts, from which a tie is near tearing."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CarriedBond:
    """A tie that breaks, on the surfaces of new meshes.

    Parameters
    ----------
    tie
        The tie on the new surfaces.
    damage
        (k,) damage around its nodes.
    leaps
        (k, d) jumps of the displacement there [m].
    """

    tie: CohesiveTie
    damage: Array
    leaps: Array

    def links(self, nodes: IntArray) -> bool:
        """True if the tie is between the ``nodes`` (n,) of some solids."""
        return bool(np.isin(self.tie.jump.node, nodes).all())

    def glue(self, nodes: IntArray) -> Glue:
        """Springs of the tie between the ``nodes`` (n,) of linked solids."""
        stiffness = self.tie.law.stiffness * self.tie.jump.area * (1.0 - self.damage)
        return Glue(rows=sp.csr_array(self.tie.jump.rows[:, nodes]), stiffness=stiffness, leaps=self.leaps)


def carried_bonds(old: Model, new: Model, now: ModelState, at_nodes: sp.csr_array) -> tuple[CarriedBond, ...]:
    """Ties that break of a state on the surfaces of a new model, from the values (m, n) at its nodes of fields on those
    of the old one.
    """
    found, u = [], now.start.displacement
    for before, after in zip(old.bonds, new.bonds, strict=True):
        values = now.start.fields[old.companions.index(before)].values
        for k, (was, tie) in enumerate(zip(before.ties, after.ties, strict=True)):
            turned = _first(was, old.parts) != _first(tie, new.parts)
            to = _between(was, tie, at_nodes, turned)
            damage = np.clip(to @ values[was.jump.node, k], 0.0, 1.0)
            leaps = np.asarray(to @ (was.jump.rows @ u))
            found.append(CarriedBond(tie=tie, damage=damage, leaps=-leaps if turned else leaps))
    return tuple(found)


def _first(tie: CohesiveTie, parts: Sequence[DiscreteSolid]) -> int:
    """Number of the surface, in the order of the declaration, around whose nodes the jumps are."""
    body, tag = tie.tie.bodies[0], tie.tie.tags[0]
    part = next(part for part in parts if part.name == body)
    return int(not np.isin(tie.jump.node, part.mesh.nodes(tag) + part.nodes.start).all())


def _between(was: CohesiveTie, tie: CohesiveTie, at_nodes: sp.csr_array, turned: bool) -> sp.csr_array:
    """Values (k, j) around the nodes of a tie from those around its nodes on the old surfaces; ``turned`` if these are
    on the other surface now.
    """
    own = sp.csr_array(at_nodes[:, was.jump.node])
    weights = (-tie.jump.rows).maximum(0.0) if turned else None
    found = sp.csr_array(own[tie.jump.node] if weights is None else weights @ own)
    total = np.asarray(found.sum(axis=1)).ravel()
    scale = np.divide(1.0, total, out=np.zeros_like(total), where=total > 0.0)
    return sp.csr_array(sp.diags_array(scale) @ found)


def damages(model: Model, bonds: Sequence[CarriedBond]) -> dict[str, Mapping[str, Array]]:
    """Damage of the ties as a field of each solid; empty without ties that break."""
    out: dict[str, Mapping[str, Array]] = {}
    for bond in model.bonds:
        values = bond.initial()
        for k, one in enumerate(bonds):
            values[one.tie.jump.node, k] = one.damage
        out[bond.field.name] = model.split(values)
    return out


def with_damage(model: Model, fields: Mapping[str, Mapping[str, Array]]) -> Model:
    """Model whose ties start with the damage among the ``fields`` of each solid."""
    companions = tuple(
        replace(c, damage=model.join(fields[c.field.name])) if isinstance(c, CohesiveTies) else c
        for c in model.companions
    )
    return replace(model, companions=companions)


def tearing(model: Model, start: SlabStart) -> IntArray:
    """Nodes (k,) on both sides of ties where they tear, or are near it."""
    found = [np.zeros(0, dtype=np.int64)]
    for bond in model.bonds:
        damage = start.fields[model.companions.index(bond)].values
        x = bond.points + start.displacement
        for k, tie in enumerate(bond.ties):
            own = damage[tie.jump.node, k]
            size, mode = tie.effective(*tie.opened(start.displacement, x)[:2])
            some = (own < 1.0) & ((own > 0.0) | (size > NEAR * tie.law.openings(mode)[0]))
            found.append(tie.jump.rows[np.flatnonzero(some)].indices)
    return np.unique(np.concatenate(found))
