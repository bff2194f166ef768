"""Sharp edges of one side against sharp edges of the other, in three dimensions.

Two convex edges touch where they cross.  Their common normal m is perpendicular to both and points out of the second
body into the first; it must lie within the range of normals of each surface around its edge.  The gap is ``m .
(x_a - x_b)`` between the closest points of the two lines, and since these are stationary its derivative is
``m . ((1 - s) dx_a0 + s dx_a1 - (1 - t) dx_b0 - t dx_b1)``.

Contact of nodes with facets cannot detect this touch: no node is near it.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.node_to_surface.admissible_pairs import AdmissiblePairs
from softway.contact.node_to_surface.pairs import filled, firsts
from softway.contact.stencils import Stencils, open_rows
from softway.contact.surfaces.boundary import Edges
from softway.contact.surfaces.broad_phase import Sweep, near, sweep
from softway.contact.surfaces.wall_thickness import admissible_depth, thickness_of
from softway.kernels.geometry.closest_points import dot

PARALLEL = 1e-2
"""Sine of the angle below which two edges have no well-defined common normal."""
END = 1e-9
"""Fraction of the length of an edge by which the crossing may lie beyond its end."""
CONE = 0.1
"""Relative distance by which the common normal may leave the range of normals around an edge; blocks that lie flat on
each other are at its limit."""
FLAT = 1e-9
"""Sine of the angle between two facets up to which their edge is flat: nodes on facets see what touches it."""
BEHIND = 1e-3
"""Fraction of the length of an edge by which an open pair may overlap at the start of a slab."""
INSIDE = 0.1
"""The same where the thickness of the bodies is known, whose quarter is the limit then: the lines of edges that pass
each other may cross beyond their ends."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeCrossings:
    """Crossings of pairs of edges.

    Parameters
    ----------
    gap
        (p,) [m]; of edges that are parallel their distance, negative where they are behind each other.
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
    out = around_two[0] + around_two[1] - around_one[0] - around_one[1]
    normal *= np.where(dot(normal, out) < 0.0, -1.0, 1.0)[:, None]
    convex = _convex(u, *around_one) & _convex(v, *around_two)
    valid = crossing & convex & _among(normal, *around_two) & _among(-normal, *around_one)
    gap, rest = dot(normal, w), np.flatnonzero(~crossing)
    apart = w[rest] - (dot(w[rest], u[rest]) / uu[rest])[:, None] * u[rest]
    gap[rest] = np.copysign(np.sqrt(dot(apart, apart)), dot(apart, out[rest]))
    return EdgeCrossings(gap=gap, normal=normal, s=s, t=t, valid=valid)


def _convex(along: Array, n1: Array, n2: Array) -> BoolArray:
    """True for edges (p, 3) where the facets with the normals n1 and n2 (p, 3) meet at a convex angle."""
    return np.asarray(dot(np.cross(n1, n2), along) > FLAT * np.sqrt(dot(along, along)))


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
    admissible
        Pairs that may touch where one method handles many surfaces, whose edges are ``first`` and ``second``; by
        default all.
    thickness
        (n,) thickness of the bodies behind the nodes [m]; if it is given, the lines of pairs may
        overlap further at the start of a slab.
    slots
        Rows of each edge of the first surface.
    """

    first: Edges
    second: Edges
    admissible: AdmissiblePairs | None = None
    thickness: Array | None = None
    slots: int = 1

    @property
    def node(self) -> IntArray:
        """First node (m,) of the edge of each row."""
        return np.repeat(self.first.ends[:, 0], self.slots)

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> "EdgeContact":
        """Pairs that may touch in a slab from positions x0 to about x1 (n, 3), within ``reach`` [m].

        With a ``margin`` [m], edges have pairs only if one of them is within the margin.
        """
        boxes, length = (sweep(x0, x1, self.first.ends), sweep(x0, x1, self.second.ends)), _lengths(x0, self.first)
        rows = None if margin is None else np.unique(self._near(boxes, length, margin)[0])
        i, j = self._near(boxes, length, reach, rows)
        one, two = self.first.subset(i), self.second.subset(j)
        begun = edge_crossings(x0, one, two)
        open_ = begun.gap >= -self._depth(one, two, _lengths(x0, two))
        return EdgeContact(
            edge=i[open_],
            other=j[open_],
            one=one.subset(open_),
            two=two.subset(open_),
            count=len(self.first.ends),
            slots=self.slots,
        )

    def _depth(self, one: Edges, two: Edges, length: Array) -> Array:
        """Overlaps (p,) of the lines of pairs at the start of a slab up to which they may touch [m]."""
        if self.thickness is None:
            return BEHIND * length
        walls = thickness_of(self.thickness, one.ends) + thickness_of(self.thickness, two.ends)
        return admissible_depth(INSIDE * length, walls)

    def _once(self, i: IntArray, j: IntArray, length: Array) -> BoolArray:
        """True for pairs of edges that are found from both, and here from the shorter one, and for all other pairs."""
        among = np.minimum(j, len(length) - 1)
        shorter = (length[i] < length[among]) | ((length[i] == length[among]) & (i < j))
        return np.asarray(shorter | (j >= len(length)))

    def _near(
        self, boxes: tuple[Sweep, Sweep], length: Array, reach: float, rows: IntArray | None = None
    ) -> tuple[IntArray, IntArray]:
        """Edges within reach of each other, of the first only the ``rows`` (k,), that may touch.

        ``length`` are those of the first edges.
        """
        i, j = near(*boxes, reach, rows)
        apart = np.ones(len(i), bool) if self.admissible is None else self._once(i, j, length)
        for a in self.first.ends.T:
            for b in self.second.ends.T:
                apart &= a[i] != b[j]
        i, j = i[apart], j[apart]
        if self.admissible is not None and len(i):
            may = self.admissible.edges(self.first.subset(i), self.second.subset(j))
            i, j = i[may], j[may]
        return i, j


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EdgeContact:
    """Pairs of edges ``one``, ``two`` that may touch in a slab.

    ``edge`` (p,), sorted, are their numbers among the ``count`` first edges, which have ``slots`` rows each, ``other``
    (p,) those among the second edges.
    """

    edge: IntArray
    other: IntArray
    one: Edges
    two: Edges
    count: int
    slots: int = 1

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        return len(self.edge)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, 3)."""
        if not self.found:
            return open_rows(self.count * self.slots, *x.shape)
        found = edge_crossings(x, self.one, self.two)
        return edge_stencils(self, found, *self.live(found), len(x))

    def live(self, found: EdgeCrossings) -> tuple[IntArray, IntArray]:
        """Active pairs, the nearest crossings inside both edges, and their rows, in ascending order."""
        inside = (np.minimum(found.s, found.t) >= -END) & (np.maximum(found.s, found.t) <= 1.0 + END)
        live = np.flatnonzero(found.valid & inside)
        live = live[np.lexsort((np.abs(found.gap[live]), self.edge[live]))]
        live = np.sort(live[_rank(self.edge[live]) < self.slots])
        return live, self.edge[live] * self.slots + _rank(self.edge[live])

    def subset(self, which: IntArray) -> "EdgeContact":
        """Subset of the pairs."""
        one, two = self.one.subset(which), self.two.subset(which)
        return replace(self, edge=self.edge[which], other=self.other[which], one=one, two=two)


def _lengths(x: Array, edges: Edges) -> Array:
    return np.asarray(np.linalg.norm(x[edges.ends[:, 1]] - x[edges.ends[:, 0]], axis=1))


def _rank(numbers: IntArray) -> IntArray:
    """Places (p,) among equal numbers, of ascending numbers (p,)."""
    heads = firsts(numbers)
    return np.arange(len(numbers)) - np.repeat(heads, np.diff(heads, append=len(numbers)))


def edge_stencils(pairs: EdgeContact, found: EdgeCrossings, live: IntArray, rows: IntArray, nodes: int) -> Stencils:
    """Stencils of the pairs ``live`` (l,) with the ascending ``rows`` (l,); ``nodes`` is n."""
    s, t = found.s[live], found.t[live]
    data = np.stack([1.0 - s, s, t - 1.0, -t], axis=1)
    columns = np.concatenate([pairs.one.ends[live], pairs.two.ends[live]], axis=1)
    count = pairs.count * pairs.slots
    return filled(rows, count, found.gap[live], found.normal[live], data, columns, nodes)
