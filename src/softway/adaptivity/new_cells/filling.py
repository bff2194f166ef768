"""Triangles inside an outline, with points of a size field."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay

from softway.adaptivity.new_cells.sizes import SizeField
from softway.adaptivity.new_cells.swaps import improved
from softway.adaptivity.new_cells.triangulation import enclosed, triangulated
from softway.arrays import Array, BoolArray, IntArray

LARGE = 0.75
"""Radius of the circle around a triangle over the length of the edges beyond which a point is put into it."""
APART = 0.7
"""Least distance of two points over the length of the edges."""
AWAY = 0.55
"""Least distance of a point from the boundary over the length of the edges."""
ROUNDS = 40
"""Greatest number of times that points are added."""
GRAIN = 1e-6
"""Rounding of the order in which points are added."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Filled:
    """Triangles (t, 3) of points (n, 2); the corners of the outline come first."""

    points: Array
    triangles: IntArray


def filled(corners: Array, sides: IntArray, field: SizeField) -> Filled | None:
    """Triangles inside closed polygons, whose sides are edges of them; None if the polygons cross.

    In rounds points are added at the centres of the circles around triangles that are too large for the size field, if
    they are not close to others (refinement of Delaunay); then edges are swapped, and points moved, for the quality of
    the triangles.

    Parameters
    ----------
    corners, sides
        (k, 2) corners [m], and the sides (s, 2) between them, with the body to the left.
    field
        Lengths of the edges inside.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> field = SizeField(blocks={"quad4": np.array([[0, 1, 2, 3]])}, places=square, sizes=np.full(4, 1.0),
    ...                   points=square, limits=np.full(4, 1.0))
    >>> len(filled(square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]), field).triangles)
    4
    """
    size = float(np.ptp(corners, axis=0).max())
    points = np.array(corners)
    for _ in range(ROUNDS):
        new = _new_points(points, corners, sides, field, size)
        if not len(new):
            break
        points = np.vstack([points, new])
    triangles = triangulated(points, sides)
    if triangles is None:
        return None
    points, triangles = improved(points, triangles, sides)
    return Filled(points=points, triangles=triangles)


def _new_points(points: Array, corners: Array, sides: IntArray, field: SizeField, size: float) -> Array:
    """Centres (m, 2) of the circles around triangles that are too large, apart from each other."""
    simplices = Delaunay(_boxed(points)).simplices
    simplices = simplices[(simplices < len(points)).all(axis=1)]
    x = points[simplices]
    centre, radius = _circles(x)
    chosen = enclosed(x.mean(axis=1), corners, sides)
    centre, radius, middle = centre[chosen], radius[chosen], x[chosen].mean(axis=1)
    wanted = field.at(middle)
    outside = ~enclosed(centre, corners, sides)
    centre[outside] = middle[outside]
    large = radius > LARGE * wanted
    centre, ratio, wanted = centre[large], (radius / wanted)[large], field.at(centre[large])
    if not len(centre):
        return centre
    clear = _distances(centre, corners[sides]) > AWAY * wanted
    clear &= np.linalg.norm(centre[:, None] - points[None], axis=2).min(axis=1) > APART * wanted
    return _spread(centre[clear], ratio[clear], wanted[clear], size)


def _distances(points: Array, segments: Array) -> Array:
    """Distances (m,) of points (m, 2) from the nearest of segments (s, 2, 2) [m]."""
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    way = points[:, None] - start[None]
    share = np.clip((way * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(way - share[:, :, None] * along, axis=2).min(axis=1))


def _spread(points: Array, ratio: Array, wanted: Array, size: float) -> Array:
    """Points that are apart from each other, those of the largest ratios before the others."""
    grid = np.floor(points / (GRAIN * size) + 0.318)
    order = np.lexsort([grid[:, 0], grid[:, 1], -np.floor(ratio / GRAIN + 0.318)])
    free: BoolArray = np.ones(len(points), dtype=bool)
    taken: list[int] = []
    for k in order.tolist():
        if free[k]:
            taken.append(k)
            free &= np.linalg.norm(points - points[k], axis=1) > APART * np.maximum(wanted, wanted[k])
    return points[taken]


def _boxed(points: Array) -> Array:
    """Points (n + 4, 2) with the corners of a large square around them at the end."""
    low, high = points.min(axis=0), points.max(axis=0)
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return np.vstack([points, 0.5 * (low + high) + 8.0 * float((high - low).max()) * corners])


def _circles(x: Array) -> tuple[Array, Array]:
    """Centres (t, 2) and radii (t,) of the circles through the corners x (t, 3, 2) of triangles."""
    u, v = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    twice = 2.0 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    safe = np.where(np.abs(twice) > 1e-14 * (u**2 + v**2).sum(axis=1), twice, np.inf)
    uu, vv = (u**2).sum(axis=1), (v**2).sum(axis=1)
    way = np.stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu], axis=1) / safe[:, None]
    return x[:, 0] + way, np.where(np.isfinite(safe), np.linalg.norm(way, axis=1), 0.0)
