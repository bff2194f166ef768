"""Slaves and the facets that they may touch, pair by pair: where the foot lies, and the rows of the condition."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.contact.facets import Feet, nearest
from softway.contact.side import Side
from softway.contact.stencils import Stencils
from softway.kernels.closest import dot
from softway.typing import Array, BoolArray, IntArray

EDGE = 1e-6
"""Share of the size of a facet by which a foot may lie beyond its edge and still counts as inner."""


See = Callable[[str, Array, Array, Array], Feet]


def firsts(numbers: IntArray) -> IntArray:
    """Where each new number begins in rising numbers (p,).

    Examples
    --------
    >>> firsts(np.array([2, 2, 3, 7, 7])).tolist()
    [0, 2, 3]
    """
    return np.flatnonzero(np.diff(numbers, prepend=-1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pairs:
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

    side: Side
    slave: IntArray
    node: IntArray
    facet: IntArray

    def take(self, which: IntArray | BoolArray) -> "Pairs":
        """Some of the pairs."""
        return Pairs(side=self.side, slave=self.slave[which], node=self.node[which], facet=self.facet[which])

    @property
    def masters(self) -> IntArray:
        """Nodes (p, b) of the facets."""
        return self.side.table[self.facet]

    def least(self, values: Array) -> Array:
        """For each pair the least of the values (p,) of its slave."""
        heads = firsts(self.slave)
        if not len(heads):
            return values
        return np.repeat(np.minimum.reduceat(values, heads), np.diff(heads, append=len(values)))

    def feet(self, x: Array, see: See = nearest) -> Feet:
        """The slaves as seen from their facets at positions x (n, d)."""
        return self.look(x[self.node], x[self.masters], see)

    def look(self, points: Array, nodes: Array, see: See) -> Feet:
        """Points (p, d) as seen from facets with nodes at (p, b, d)."""
        p, d = points.shape
        out = Feet(shapes=np.zeros(nodes.shape[:2]), offset=np.zeros((p, d)), normal=np.zeros((p, d)))
        for kind, first, found in self.side.numbers:
            if len(self.side.facets) == 1:
                return see(kind, points, nodes, self.side.ends[self.facet] if kind == "point1" else self.side.ends)
            at, width = np.flatnonzero((self.facet >= first) & (self.facet < first + len(found))), found.shape[1]
            part = see(kind, points[at], nodes[at, :width], self.side.ends)
            out.shapes[at, :width], out.offset[at], out.normal[at] = part.shapes, part.offset, part.normal
        return out

    def stencils(self, rows: IntArray, count: int, feet: Feet, gap: Array, normal: Array, nodes: int) -> Stencils:
        """The pairs as some ``rows`` (p,) in rising order out of ``count``; the others are out of reach."""
        columns = np.concatenate([self.node[:, None], self.masters], axis=1)
        data = np.concatenate([np.ones((len(rows), 1)), -feet.shapes], axis=1)
        stored = data != 0.0
        filled = np.zeros(count + 1, dtype=np.int64)
        filled[rows + 1] = np.count_nonzero(stored, axis=1)
        weights = sp.csr_array((data[stored], columns[stored], np.cumsum(filled)), shape=(count, nodes))
        gaps, normals = np.full(count, np.inf), np.zeros((count, normal.shape[1]))
        gaps[rows], normals[rows] = gap, normal
        return Stencils(gap=gaps, normal=normals, weights=weights)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class View:
    """Slaves relative to the facets of their pairs: feet, height (p,) above the tangent plane, distance (p,) and unit
    direction (p, d) beyond the edge, and which of the feet are inner (p,).
    """

    feet: Feet
    height: Array
    distance: Array
    beyond: Array
    inner: BoolArray


def view(pairs: Pairs, x: Array, size: Array) -> View:
    """The view of pairs at positions x (n, d), with facets of some size (p,) [m]."""
    feet = pairs.feet(x)
    height = dot(feet.normal, feet.offset)
    beyond = feet.offset - height[:, None] * feet.normal
    sideways = np.sqrt(dot(beyond, beyond))
    inner = sideways <= EDGE * size
    beyond /= np.where(inner, 1.0, sideways)[:, None]
    return View(feet=feet, height=height, distance=np.hypot(height, sideways), beyond=beyond, inner=inner)
