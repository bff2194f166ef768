"""Memory of the matter on an adapted mesh: children inherit, parents take means by volume."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.internal_force.material_state import OPTIONAL, MaterialState
from softway.bodies.internal_force.regions import RegionForces
from softway.meshes.adaptive.leaves import Leaves, nested


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Inheritance:
    """Values at the points of some leaves of mesh B from those of some leaves of mesh A, q points each.

    Parameters
    ----------
    means
        (b, a) values of the leaves of B from means over those of A: of one around them, or of several inside by volume.
    weights
        (a, q) shares of the points in the volume of their leaf.
    same
        (b,) leaves that both meshes have; they keep the values of each point.
    own
        (b,) number of the leaf of A around each of B; of any for larger ones.
    ratio
        (b,) volume in A over that in B of the larger leaf at each place, where a curved boundary makes them differ.
    """

    means: sp.csr_array
    weights: Array
    same: BoolArray
    own: IntArray
    ratio: Array | float = 1.0

    def sums(self, values: Array) -> Array:
        """Densities (b q,) at the points of B from those (a q,) of A, with the integrals of A."""
        found = self.of(values).reshape(len(self.own), -1)
        return np.asarray((found * np.reshape(self.ratio, (-1, 1))).ravel())

    def of(self, values: Array) -> Array:
        """Values (b q, ...) at the points of B from those (a q, ...) of A."""
        count, points = self.weights.shape
        old = values.reshape(count, points, int(np.prod(values.shape[1:])))
        mean = np.asarray(self.means @ np.einsum("aq,aqk->ak", self.weights, old))
        new = np.repeat(mean[:, None], points, axis=1)
        new[self.same] = old[self.own[self.same]]
        return new.reshape(len(new) * points, *values.shape[1:])


def inheritance(one: Leaves, other: Leaves, volume: Array, after: Array | None = None) -> Inheritance:
    """Inheritance from leaves of A (a,) to leaves of B (b,) that cover the same places.

    Parameters
    ----------
    one, other
        Leaves of A and B, or those in one region.
    volume
        (a q,) volumes of the points of A [m^3].
    after
        (b q,) those of B, where the cells of both meshes fill other volumes; None where they do not.

    Examples
    --------
    >>> from softway.meshes.adaptive.leaves import roots
    >>> halves = Leaves(np.array([0, 2**39]), np.array([1, 1]))
    >>> inheritance(halves, roots(1), np.array([1.0, 3.0])).of(np.array([4.0, 8.0])).tolist()
    [7.0]
    >>> inheritance(roots(1), halves, np.array([4.0])).of(np.array([7.0])).tolist()
    [7.0, 7.0]
    """
    parts = volume.reshape(len(one.start), -1)
    whole = parts.sum(axis=1)
    down = nested(one, other)
    own = np.maximum(one.around(other.start), 0)
    up = np.flatnonzero(one.level > other.level[np.maximum(other.around(one.start), 0)])
    parent = other.around(one.start[up])
    total = np.bincount(parent, whole[up], minlength=len(other.start))
    rows = np.concatenate([np.flatnonzero(down), parent])
    columns = np.concatenate([own[down], up])
    shares = np.concatenate([np.ones(int(down.sum())), whole[up] / total[parent]])
    there = None if after is None else after.reshape(len(other.start), -1).sum(axis=1)
    return Inheritance(
        means=sp.csr_array((shares, (rows, columns)), shape=(len(other.start), len(one.start))),
        weights=parts / whole[:, None],
        same=down & (other.level == one.level[own]),
        own=own,
        ratio=1.0 if there is None else _ratio(whole, there, own, (parent, up)),
    )


def _ratio(before: Array, after: Array, own: IntArray, grown: tuple[IntArray, IntArray]) -> Array:
    """Volume ``before`` (a,) over that ``after`` (b,) of the larger leaf at each place; ``grown`` are leaves of B and
    those of A in them.
    """
    parent, up = grown
    larger = np.bincount(parent, before[up], minlength=len(after))
    within = np.bincount(own, np.where(larger > 0.0, 0.0, after), minlength=len(before))
    return np.where(larger > 0.0, larger / after, before[own] / np.where(within > 0.0, within, 1.0)[own])


def remembered(before: AdaptedSolid, after: AdaptedSolid, state: MaterialState, displacement: Array) -> MaterialState:
    """Material state on a new mesh: what the law keeps, and the stress of laws of rates, at each point.

    Parameters
    ----------
    before, after
        The solid on both meshes.
    state
        Material state on the mesh before.
    displacement
        (n, d) displacement on the new mesh [m].
    """
    old, new = before.part.internal, after.part.internal
    ours, theirs = before.adapted.leaves, after.adapted.leaves
    straight = before.adapted.base.rounding is None
    if not (isinstance(old, RegionForces) and isinstance(new, RegionForces)):
        there = None if straight else new.sampling.volume
        return _carried(state, inheritance(ours, theirs, old.sampling.volume, there), displacement)
    terms = {term.region: term for term in old.terms}
    regions, elastic = {}, 0.0
    for term in new.terms:
        mine, was = displacement[term.nodes], terms[term.region]
        if term.region in state.regions:
            there = None if straight else term.internal.sampling.volume
            leaves = _some(ours, was.cells), _some(theirs, term.cells)
            found = inheritance(*leaves, was.internal.sampling.volume, there)
            regions[term.region] = _carried(state.regions[term.region], found, mine)
        else:
            elastic += term.internal.energy(mine)
    return replace(state, displacement=np.array(displacement), regions=regions, elastic=elastic)


def _some(leaves: Leaves, chosen: IntArray) -> Leaves:
    """The chosen leaves."""
    return Leaves(leaves.start[chosen], leaves.level[chosen])


def _carried(state: MaterialState, found: Inheritance, displacement: Array) -> MaterialState:
    """State with the values of all points carried over."""
    optional: dict[str, Any] = {
        name: found.of(values) for name in OPTIONAL if (values := getattr(state, name)) is not None
    }
    return replace(
        state,
        displacement=np.array(displacement),
        stress=found.of(state.stress),
        law={name: found.of(values) for name, values in state.law.items()},
        lateral=found.of(state.lateral),
        stored=found.sums(state.stored),
        dissipated=found.sums(state.dissipated),
        **optional,
    )
