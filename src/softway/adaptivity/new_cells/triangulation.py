"""Triangles of given points in the plane whose edges contain given sides."""

from collections.abc import Callable, Iterable

import numpy as np
from scipy.spatial import Delaunay

from softway.arrays import Array, BoolArray, IntArray

Edges = dict[tuple[int, int], int]
"""Third corner of the triangle to the left of each directed edge."""
BOX = 8.0
"""Half of the sides of the square around the body, relative to its size."""
TIE = 1e-7
"""Sine of the excess of two opposite angles below which four points count as points of a circle."""
MOST = 40
"""Greatest number of swaps per edge."""


def edges_of(triangles: Iterable[tuple[int, int, int]]) -> Edges:
    """Directed edges of triangles.

    Examples
    --------
    >>> edges_of([(0, 1, 2)])
    {(0, 1): 2, (1, 2): 0, (2, 0): 1}
    """
    out: Edges = {}
    for a, b, c in triangles:
        out[a, b], out[b, c], out[c, a] = c, a, b
    return out


def triangles_of(edges: Edges) -> IntArray:
    """Triangles (t, 3) in rising order, each from its least corner on."""
    found = [(a, b, c) for (a, b), c in edges.items() if a < b and a < c]
    return np.array(sorted(found), dtype=np.int64).reshape(-1, 3)


def swap(edges: Edges, a: int, b: int) -> tuple[int, int]:
    """Replace the edge from a to b by that between the corners opposite, which are returned."""
    c, d = edges.pop((a, b)), edges.pop((b, a))
    edges[d, b], edges[b, c], edges[c, d] = c, d, b
    edges[c, a], edges[a, d], edges[d, c] = d, c, a
    return c, d


def triangulated(points: Array, sides: IntArray) -> IntArray | None:
    """Delaunay triangles (t, 3) inside closed polygons, whose edges are kept; None if the polygons cross.

    Of points on a circle the one with the least number is in all their triangles.

    Parameters
    ----------
    points
        (n, 2) points [m].
    sides
        (s, 2) sides of the polygons, with the inside to the left.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> triangulated(square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]])).tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    low, high = points.min(axis=0), points.max(axis=0)
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    around = 0.5 * (low + high) + BOX * float((high - low).max()) * corners
    everything = np.vstack([points, around])
    found = Delaunay(everything).simplices.astype(np.int64)
    x = everything[found]
    turned = np.linalg.det(x[:, 1:] - x[:, :1]) < 0.0
    found[turned] = found[turned][:, ::-1]
    edges = edges_of(map(tuple, found.tolist()))
    for a, b in sides.tolist():
        if (a, b) not in edges and not _recovered(edges, everything, a, b):
            return None
    inside = _inside(edges, sides)
    if inside is None:
        return None
    delaunay(inside, everything, sides)
    triangles = triangles_of(inside)
    used = np.unique(triangles)
    return triangles if len(used) == len(points) and _fills(points, triangles, sides) else None


def delaunay(edges: Edges, points: Array, sides: IntArray) -> None:
    """Swap edges until the triangles are those of Delaunay, but for the sides."""

    def asks(a: int, b: int, c: int, d: int) -> bool:
        excess = _excess(points, a, b, c, d)
        return excess < -TIE or (excess < TIE and min(c, d) < min(a, b))

    swapped(edges, points, sides, asks)


def swapped(edges: Edges, points: Array, sides: IntArray, asks: Callable[[int, int, int, int], bool]) -> None:
    """Swap the edges (a, b), opposite c and d, that ask for it, where the triangles around stay valid."""
    fixed = {tuple(sorted(side)) for side in sides.tolist()}
    queue = sorted({(min(e), max(e)) for e in edges} - fixed)
    budget = MOST * len(queue)
    while queue and budget:
        budget -= 1
        a, b = queue.pop()
        if (a, b) not in edges or (b, a) not in edges:
            continue
        c, d = edges[a, b], edges[b, a]
        if (c, d) in edges or (d, c) in edges or not _convex(points, a, b, c, d) or not asks(a, b, c, d):
            continue
        swap(edges, a, b)
        around = {(min(e), max(e)) for e in ((a, c), (c, b), (b, d), (d, a))}
        queue += sorted(around - fixed)


def _excess(points: Array, a: int, b: int, c: int, d: int) -> float:
    """Sine of the sum of the angles at c and d of the triangles on the edge (a, b): negative if it is to be swapped."""
    cross, dot = [], []
    for corner, first, second in ((c, a, b), (d, b, a)):
        ux, uy = points[first] - points[corner]
        vx, vy = points[second] - points[corner]
        size = ((ux * ux + uy * uy) * (vx * vx + vy * vy)) ** 0.5
        cross.append((ux * vy - uy * vx) / size)
        dot.append((ux * vx + uy * vy) / size)
    return float(cross[0] * dot[1] + dot[0] * cross[1])


def area(points: Array, a: int, b: int, c: int) -> float:
    """Twice the area of a triangle [m^2]."""
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    return float((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def _convex(points: Array, a: int, b: int, c: int, d: int) -> bool:
    """Whether the triangles (d, b, c) and (c, a, d) that a swap makes are valid."""
    size = float(((points[c] - points[d]) ** 2).sum()) * 1e-9
    return area(points, d, b, c) > size and area(points, c, a, d) > size


def _recovered(edges: Edges, points: Array, a: int, b: int) -> bool:
    """Swap edges that cross the segment from a to b until it is one."""
    crossing = [e for e in edges if e[0] < e[1] and _cross(points, a, b, *e)]
    budget = MOST * (len(crossing) + 1)
    while crossing and budget:
        budget -= 1
        c, d = crossing.pop(0)
        if (c, d) not in edges or (d, c) not in edges:
            continue
        if not _convex(points, c, d, edges[c, d], edges[d, c]):
            crossing.append((c, d))
            continue
        new = sorted(swap(edges, c, d))
        if _cross(points, a, b, *new):
            crossing.append((new[0], new[1]))
    return (a, b) in edges


def _cross(points: Array, a: int, b: int, c: int, d: int) -> bool:
    """Whether two segments without a common end cross."""
    if len({a, b, c, d}) < 4:
        return False
    one, two = area(points, a, b, c), area(points, a, b, d)
    three, four = area(points, c, d, a), area(points, c, d, b)
    return (one > 0.0) != (two > 0.0) and (three > 0.0) != (four > 0.0)


def _inside(edges: Edges, sides: IntArray) -> Edges | None:
    """Edges of the triangles that the sides enclose; None where sides have crossed."""
    fixed = {tuple(side) for side in sides.tolist()}
    stack, out = list(fixed), edges_of([])
    while stack:
        a, b = stack.pop()
        if (a, b) in out:
            continue
        if (a, b) not in edges:
            return None
        c = edges[a, b]
        for one, two, three in ((a, b, c), (b, c, a), (c, a, b)):
            out[one, two] = three
            if (two, one) in fixed:
                return None
            if (one, two) not in fixed:
                stack.append((two, one))
    return out


def _fills(points: Array, triangles: IntArray, sides: IntArray) -> bool:
    """Whether triangles fill the polygons."""
    x, y = points[triangles], points[sides]
    whole = float((y[:, 0, 0] * y[:, 1, 1] - y[:, 1, 0] * y[:, 0, 1]).sum())
    parts = np.linalg.det(x[:, 1:] - x[:, :1])
    return bool((parts > 0.0).all() and abs(parts.sum() - whole) < 1e-9 * abs(whole))


def enclosed(points: Array, corners: Array, sides: IntArray) -> BoolArray:
    """Whether points (m, 2) are inside closed polygons with the sides (s, 2) between the corners (k, 2).

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> sides = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> enclosed(np.array([[0.5, 0.5], [1.5, 0.5]]), square, sides).tolist()
    [True, False]
    """
    start, end = corners[sides[:, 0]], corners[sides[:, 1]]
    y = points[:, 1, None]
    up, down = (start[:, 1] <= y) & (end[:, 1] > y), (start[:, 1] > y) & (end[:, 1] <= y)
    along = end - start
    left = along[:, 0] * (y - start[:, 1]) - along[:, 1] * (points[:, 0, None] - start[:, 0])
    return np.asarray((up & (left > 0.0)).sum(axis=1) - (down & (left < 0.0)).sum(axis=1) != 0)
