"""Pairs of slave nodes and facets that may touch, and the stencils of their rows."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.stencils import Stencils
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.facet_geometry import ClosestPoints, nearest

See = Callable[[str, Array, Array, Array], ClosestPoints]


def firsts(numbers: IntArray) -> IntArray:
    """Places of the first occurrence of each number in ascending numbers (p,).

    Examples
    --------
    >>> firsts(np.array([2, 2, 3, 7, 7])).tolist()
    [0, 2, 3]
    """
    return np.flatnonzero(np.diff(numbers, prepend=-1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodeFacetPairs:
    """Pairs of a slave and a facet, sorted by slaves.

    Parameters
    ----------
    side
        The facets.
    slave, node
        (p,) number of the slave among the slaves, and its node.
    facet
        (p,) number of the facet.
    """

    side: ContactSurface
    slave: IntArray
    node: IntArray
    facet: IntArray

    def subset(self, which: IntArray | BoolArray) -> "NodeFacetPairs":
        """Subset of the pairs."""
        return NodeFacetPairs(side=self.side, slave=self.slave[which], node=self.node[which], facet=self.facet[which])

    @property
    def masters(self) -> IntArray:
        """Nodes (p, b) of the facets."""
        return self.side.table[self.facet]

    def least(self, values: Array) -> Array:
        """Least of the values (p,) of the slave of each pair."""
        heads = firsts(self.slave)
        if not len(heads):
            return values
        return np.repeat(np.minimum.reduceat(values, heads), np.diff(heads, append=len(values)))

    def feet(self, x: Array, see: See = nearest) -> ClosestPoints:
        """Closest points of the facets to their slaves at positions x (n, d)."""
        return self.closest_points(x[self.node], x[self.masters], see)

    def closest_points(self, points: Array, nodes: Array, see: See) -> ClosestPoints:
        """Closest points of facets with nodes at (p, b, d) to points (p, d)."""
        p, d = points.shape
        out = ClosestPoints(shapes=np.zeros(nodes.shape[:2]), offset=np.zeros((p, d)), normal=np.zeros((p, d)))
        for kind, first, found in self.side.numbers:
            if len(self.side.facets) == 1:
                return see(kind, points, nodes, self.side.ends[self.facet] if kind == "point1" else self.side.ends)
            at, width = np.flatnonzero((self.facet >= first) & (self.facet < first + len(found))), found.shape[1]
            part = see(kind, points[at], nodes[at, :width], self.side.ends)
            out.shapes[at, :width], out.offset[at], out.normal[at] = part.shapes, part.offset, part.normal
        return out

    def stencils(
        self, rows: IntArray, count: int, feet: ClosestPoints, gap: Array, normal: Array, nodes: int
    ) -> Stencils:
        """Stencils of ``count`` rows on n ``nodes``: the pairs make the ``rows`` (p,), in ascending order."""
        columns = np.concatenate([self.node[:, None], self.masters], axis=1)
        data = np.concatenate([np.ones((len(rows), 1)), -feet.shapes], axis=1)
        return filled(rows, count, gap, normal, data, columns, nodes)


def filled(
    rows: IntArray, count: int, gap: Array, normal: Array, data: Array, columns: IntArray, nodes: int
) -> Stencils:
    """Stencils of ``count`` rows with the ascending ``rows`` (p,) given; the others are out of reach.

    Parameters
    ----------
    gap, normal
        (p,) and (p, d).
    data, columns
        (p, k) weights and their nodes; weights of zero are left out.

    Examples
    --------
    >>> data, columns = np.array([[1.0, -1.0]]), np.array([[0, 2]])
    >>> found = filled(np.array([1]), 2, np.array([0.5]), np.array([[1.0]]), data, columns, 3)
    >>> found.gap.tolist(), found.weights.toarray().tolist()
    ([inf, 0.5], [[0.0, 0.0, 0.0], [1.0, 0.0, -1.0]])
    """
    stored, starts = data != 0.0, np.zeros(count + 1, dtype=np.int64)
    starts[rows + 1] = np.count_nonzero(stored, axis=1)
    weights = sp.csr_array((data[stored], columns[stored], np.cumsum(starts)), shape=(count, nodes))
    gaps, normals = np.full(count, np.inf), np.zeros((count, normal.shape[1]))
    gaps[rows], normals[rows] = gap, normal
    return Stencils(gap=gaps, normal=normals, weights=weights)
