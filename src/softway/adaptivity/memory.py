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
    """

    means: sp.csr_array
    weights: Array
    same: BoolArray
    own: IntArray

    def of(self, values: Array) -> Array:
        """Values (b q, ...) at the points of B from those (a q, ...) of A."""
        count, points = self.weights.shape
        old = values.reshape(count, points, int(np.prod(values.shape[1:])))
        mean = np.asarray(self.means @ np.einsum("aq,aqk->ak", self.weights, old))
        new = np.repeat(mean[:, None], points, axis=1)
        new[self.same] = old[self.own[self.same]]
        return new.reshape(len(new) * points, *values.shape[1:])


def inheritance(one: Leaves, other: Leaves, volume: Array) -> Inheritance:
    """Inheritance from leaves of A (a,) to leaves of B (b,) that cover the same places.

    Parameters
    ----------
    one, other
        Leaves of A and B, or those in one region.
    volume
        (a q,) volumes of the points of A [m^3].

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
    return Inheritance(
        means=sp.csr_array((shares, (rows, columns)), shape=(len(other.start), len(one.start))),
        weights=parts / whole[:, None],
        same=down & (other.level == one.level[own]),
        own=own,
    )


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
    if not (isinstance(old, RegionForces) and isinstance(new, RegionForces)):
        return _carried(state, inheritance(ours, theirs, old.sampling.volume), displacement)
    terms = {term.region: term for term in old.terms}
    regions, elastic = {}, 0.0
    for term in new.terms:
        mine, was = displacement[term.nodes], terms[term.region]
        if term.region in state.regions:
            found = inheritance(_some(ours, was.cells), _some(theirs, term.cells), was.internal.sampling.volume)
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
        stored=found.of(state.stored),
        dissipated=found.of(state.dissipated),
        **optional,
    )
