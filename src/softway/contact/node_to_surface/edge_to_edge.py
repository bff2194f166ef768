"""Sharp edges of one side against sharp edges of the other, in three dimensions.

Two convex edges touch where they cross.  Their common normal m is perpendicular to both and points out of the second
body into the first; it must lie within the range of normals of each surface around its edge.  The gap is ``m .
(x_a - x_b)`` between the closest points of the two lines, and since these are stationary its derivative is
``m . ((1 - s) dx_a0 + s dx_a1 - (1 - t) dx_b0 - t dx_b1)``.

Contact of nodes with facets cannot detect this touch: no node is near it.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.node_to_surface.pairs import filled, firsts
from softway.contact.stencils import Stencils
from softway.contact.surfaces.boundary import Edges
from softway.contact.surfaces.broad_phase import near, sweep
from softway.kernels.geometry.closest_points import dot

PARALLEL = 1e-2
"""Sine of the angle below which two edges have no well-defined common normal."""
END = 1e-9
"""Fraction of the length of an edge by which the crossing may lie beyond its end."""
CONE = 0.1
"""Relative distance by which the common normal may leave the range of normals around an edge; blocks that lie flat on
each other are at its limit."""
BEHIND = 1e-3
"""Fraction of the length of an edge by which an open pair may overlap at the start of a slab."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeCrossings:
    """Crossings of pairs of edges.

    Parameters
    ----------
    gap
        (p,) [m].
    normal
        (p, 3) common unit normal.
    s, t
        (p,) coordinates on the two edges.
    valid
        (p,) pairs that may touch.
    """

    gap: Array
    normal: Array
    s: Array
    t: Array
    valid: BoolArray


def edge_crossings(x: Array, one: Edges, two: Edges) -> EdgeCrossings:
    """Crossings of pairs of edges (p,) at positions x (n, 3).

    Examples
    --------
    The lower edge of a body above crosses the upper edge of a body below at a distance of one tenth:

    >>> x = np.array([[-1, 0, 0.1], [1, 0, 0.1], [0, -1, 1], [0, 1, 1], [0, 1, 0], [0, -1, 0], [1, 0, -1], [-1, 0, -1]])
    >>> lower = Edges(ends=np.array([[0, 1]]), wings=np.array([[2, 3]]))
    >>> upper = Edges(ends=np.array([[4, 5]]), wings=np.array([[6, 7]]))
    >>> found = edge_crossings(x, lower, upper)
    >>> [(v.round(12) + 0.0).tolist() for v in (found.gap, found.normal, found.s, found.t)], found.valid.tolist()
    ([[0.1], [[0.0, 0.0, 1.0]], [0.5], [0.5]], [True])
    """
    a0, a1, b0, b1 = x[one.ends[:, 0]], x[one.ends[:, 1]], x[two.ends[:, 0]], x[two.ends[:, 1]]
    u, v, w = a1 - a0, b1 - b0, a0 - b0
    uu, uv, vv = dot(u, u), dot(u, v), dot(v, v)
    det = uu * vv - uv * uv
    crossing = det > PARALLEL**2 * uu * vv
    det = np.where(crossing, det, 1.0)
    s = (uv * dot(v, w) - vv * dot(u, w)) / det
    t = (uu * dot(v, w) - uv * dot(u, w)) / det
    normal = np.cross(u, v)
    normal /= np.sqrt(np.where(crossing, dot(normal, normal), 1.0))[:, None]
    around_one, around_two = one.normals(x), two.normals(x)
    lean = dot(normal, around_two[0] + around_two[1] - around_one[0] - around_one[1])
    normal *= np.where(lean < 0.0, -1.0, 1.0)[:, None]
    valid = crossing & _among(normal, *around_two) & _among(-normal, *around_one)
    gap = np.where(crossing, dot(normal, w), np.inf)
    return EdgeCrossings(gap=gap, normal=normal, s=s, t=t, valid=valid)


def _among(m: Array, n1: Array, n2: Array) -> BoolArray:
    """True where m (p, 3), in the plane of n1 and n2, lies between them."""
    c, m1, m2 = dot(n1, n2), dot(m, n1), dot(m, n2)
    return np.asarray((m1 - c * m2 >= -CONE * (1.0 - c * c)) & (m2 - c * m1 >= -CONE * (1.0 - c * c)))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeToEdge:
    """Contact of the sharp edges of two surfaces: one row for every edge of the first, with the nearest of the second.

    Parameters
    ----------
    first, second
        Sharp convex edges, see :meth:`softway.contact.surfaces.boundary.ContactSurface.sharp_edges`; the finer
        surface comes first.
    """

    first: Edges
    second: Edges

    @property
    def node(self) -> IntArray:
        """First node (m,) of the edge of each row."""
        return np.asarray(self.first.ends[:, 0])

    def meet(self, x0: Array, x1: Array, reach: float) -> "EdgeContact":
        """Pairs that may touch in a slab from positions x0 to about x1 (n, 3), within ``reach`` [m]."""
        i, j = near(sweep(x0, x1, self.first.ends), sweep(x0, x1, self.second.ends), reach)
        apart = self.first.ends[i][:, :, None] != self.second.ends[j][:, None, :]
        i, j = i[apart.all(axis=(1, 2))], j[apart.all(axis=(1, 2))]
        one, two = self.first.subset(i), self.second.subset(j)
        begun = edge_crossings(x0, one, two)
        length = np.linalg.norm(x0[two.ends[:, 1]] - x0[two.ends[:, 0]], axis=1)
        open_ = begun.gap >= -BEHIND * length
        return EdgeContact(row=i[open_], one=one.subset(open_), two=two.subset(open_), count=len(self.first.ends))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeContact:
    """Pairs of edges ``one``, ``two`` that may touch in a slab; ``row`` (p,) is sorted, out of ``count``."""

    row: IntArray
    one: Edges
    two: Edges
    count: int

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        return len(self.row)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, 3)."""
        found = edge_crossings(x, self.one, self.two)
        return edge_stencils(self, found, self.live(found), len(x))

    def live(self, found: EdgeCrossings) -> IntArray:
        """Active pair of each row, in the order of the rows: the nearest crossing inside both edges."""
        inside = (np.minimum(found.s, found.t) >= -END) & (np.maximum(found.s, found.t) <= 1.0 + END)
        live = np.flatnonzero(found.valid & inside)
        live = live[np.lexsort((np.abs(found.gap[live]), self.row[live]))]
        return live[firsts(self.row[live])]

    def subset(self, which: IntArray) -> "EdgeContact":
        """Subset of the pairs."""
        return EdgeContact(
            row=self.row[which], one=self.one.subset(which), two=self.two.subset(which), count=self.count
        )


def edge_stencils(pairs: EdgeContact, found: EdgeCrossings, live: IntArray, nodes: int) -> Stencils:
    """Stencils of the pairs ``live`` (l,), in the order of their rows; ``nodes`` is n."""
    s, t = found.s[live], found.t[live]
    data = np.stack([1.0 - s, s, t - 1.0, -t], axis=1)
    columns = np.concatenate([pairs.one.ends[live], pairs.two.ends[live]], axis=1)
    return filled(pairs.row[live], pairs.count, found.gap[live], found.normal[live], data, columns, nodes)
