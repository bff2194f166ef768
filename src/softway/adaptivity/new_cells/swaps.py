"""Triangles made better by swaps of edges and motion of points, with a given boundary."""

from dataclasses import replace

import numpy as np

from softway.adaptivity.new_cells.triangulation import Edges, area, edges_of, swapped, triangles_of
from softway.adaptivity.rezoning.smoothing import Distortion, moved
from softway.arrays import Array, IntArray

ROUNDS = 6
"""Greatest number of times that edges are swapped and points moved."""
BETTER = 1e-3
"""Least gain of quality by a swap, or by a motion of points."""
POWER = 1.0
"""Power of the distortion of a triangle by which its weight grows in each round."""
TIP = 0.6
"""Cosine of the angle of a corner of the boundary beyond which it has one triangle."""
_IDEAL = {
    3: np.array([[-1.0, -1.0 / np.sqrt(3.0)], [1.0, -1.0 / np.sqrt(3.0)], [0.0, 2.0 / np.sqrt(3.0)]]),
    4: np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]]),
}


def improved(points: Array, triangles: IntArray, sides: IntArray) -> tuple[Array, IntArray]:
    """Points (n, 2) and triangles (t, 3) after swaps and motions of the points inside towards least distortion.

    Edges across the body from boundary to boundary are halved, so that no triangle has all its corners on it, but for
    sharp corners.

    Parameters
    ----------
    points
        (n, 2) points [m].
    triangles
        (t, 3) valid triangles.
    sides
        (s, 2) sides of the boundary, whose ends stay.

    Examples
    --------
    >>> points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.9, 0.8]])
    >>> triangles = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [0, 4, 3]])
    >>> new, _ = improved(points, triangles, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))
    >>> new[4].round(2).tolist()
    [0.5, 0.5]
    """
    rim = np.unique(sides)
    points, triangles = _parted(points, triangles, sides)
    for _ in range(ROUNDS):
        before = triangles
        places = moved(regular(triangles), points, rim, points[rim])
        points = points if places is None else places
        triangles = _swapped(points, triangles, sides)
        if np.array_equal(before, triangles):
            break
    return _evened(points, triangles, rim), triangles


def _evened(points: Array, triangles: IntArray, rim: IntArray) -> Array:
    """Points moved so that the worst triangles get better: their distortion gets more weight, round by round."""
    measure = regular(triangles)
    best, weights = points, measure.weights
    for _ in range(ROUNDS):
        weights = weights * measure.values(points) ** POWER
        found = moved(replace(measure, weights=weights / weights.sum()), points, rim, points[rim])
        if found is None:
            break
        points = found
        if measure.values(points).max() < measure.values(best).max() * (1.0 - BETTER):
            best = points
    return best


def _parted(points: Array, triangles: IntArray, sides: IntArray) -> tuple[Array, IntArray]:
    """Points and triangles with a new point in the middle of each edge across the body from boundary to boundary."""
    edges = edges_of(map(tuple, triangles.tolist()))
    outer, fixed = set(np.unique(sides).tolist()), {tuple(side) for side in sides.tolist()}
    new: list[Array] = []
    for a, b in sorted(e for e in edges if e[0] < e[1] and outer.issuperset(e)):
        if (a, b) in fixed or (b, a) in fixed or _cuts_tip(points, edges, fixed, a, b):
            continue
        c, d, m = edges.pop((a, b)), edges.pop((b, a)), len(points) + len(new)
        new.append(0.5 * (points[a] + points[b]))
        for one, two, three in ((a, m, c), (m, b, c), (b, m, d), (m, a, d)):
            edges[one, two], edges[two, three], edges[three, one] = three, one, two
    return (np.vstack([points, np.array(new)]), triangles_of(edges)) if new else (points, triangles)


def _cuts_tip(points: Array, edges: Edges, fixed: set[tuple[int, ...]], a: int, b: int) -> bool:
    """Whether an edge cuts a sharp corner of the boundary off, whose angle would be halved with it."""
    for one, two in ((a, b), (b, a)):
        tip = edges[one, two]
        if (two, tip) in fixed and (tip, one) in fixed:
            u, v = points[one] - points[tip], points[two] - points[tip]
            return bool(u @ v > TIP * np.sqrt((u @ u) * (v @ v)))
    return False


def regular(simplices: IntArray) -> Distortion:
    """Distortion of triangles (t, 3) or tetrahedra (t, 4) from regular ones, of any size.

    Examples
    --------
    >>> found = regular(np.array([[0, 1, 2]]))
    >>> round(found.value(np.array([[0.0, 0.0], [4.0, 0.0], [2.0, 12.0**0.5]])), 12)
    1.0
    """
    count, corners = simplices.shape
    ideal = _IDEAL[corners]
    rows = np.linalg.inv(ideal[1:] - ideal[:1]).T
    gradients = np.concatenate([-rows.sum(axis=0, keepdims=True), rows])
    return Distortion(
        simplices=simplices,
        gradients=np.broadcast_to(gradients, (count, *gradients.shape)),
        weights=np.full(count, 1.0 / count),
    )


def _swapped(points: Array, triangles: IntArray, sides: IntArray) -> IntArray:
    """Triangles after all swaps that make the worse of two triangles better."""

    def quality(a: int, b: int, c: int) -> float:
        x = points[[a, b, c]]
        return 2.0 * 3.0**0.5 * area(points, a, b, c) / float(((x - np.roll(x, 1, axis=0)) ** 2).sum())

    outer = set(np.unique(sides).tolist())

    def asks(a: int, b: int, c: int, d: int) -> bool:
        if c in outer and d in outer:
            return False
        now = min(quality(a, b, c), quality(b, a, d))
        return min(quality(d, b, c), quality(c, a, d)) > now + BETTER

    edges = edges_of(map(tuple, triangles.tolist()))
    swapped(edges, points, sides, asks)
    return triangles_of(edges)
