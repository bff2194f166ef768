"""Oriented surfaces from segments in the plane or triangles in space.

Coincident vertices are merged, and neighbouring facets must have the same orientation. Every vertex and edge gets a
pseudo-normal, which gives the correct sign of the distance wherever the closest point lies.

Reference: J. A. Baerentzen, H. Aanaes, Signed distance computation using the angle weighted pseudonormal, IEEE Trans.
Visual. Comput. Graphics 11 (2005) 243-253.
"""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.obstacles.half_space import unit_vectors

RESOLUTION = 2.0**-22
"""Points closer than this fraction of the greatest coordinate coincide in a file of single precision."""
WALL = "one layer of facets that face the bodies, or a wall with a thickness"
CORNERS = {2: (1, 2), 3: (1, 2, 4)}
RIDGES = {2: (1, 2), 3: (3, 6, 5)}
"""A vertex, edge or face of a facet is numbered by the sum of 2^k over its corners k; facets meet at ridges."""


def merged(points: Array, cells: IntArray) -> tuple[Array, IntArray]:
    """Merge coincident vertices of the facets (f, d), and remove collapsed facets and unused points.

    Examples
    --------
    >>> points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1e-9], [1.0, 1.0]])
    >>> merged(points, np.array([[0, 1], [1, 2], [2, 3]]))[1].tolist()
    [[0, 1], [1, 2]]
    """
    near = cKDTree(points).query_pairs(RESOLUTION * float(np.abs(points).max()), output_type="ndarray")
    links = coo_array((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(len(points), len(points)))
    label = connected_components(links, directed=False)[1]
    cells = np.unique(label, return_index=True)[1][label][cells]
    whole = (cells != np.roll(cells, 1, axis=1)).all(axis=1)
    used, number = np.unique(cells[whole], return_inverse=True)
    return points[used], number.reshape(-1, cells.shape[1]).astype(np.int64)


def normals_of(points: Array, cells: IntArray) -> Array:
    """Unit normals (f, d) of the facets: (dy, -dx) for segments, by the right-hand rule for triangles.

    Raises
    ------
    InputError
        If the corners of a triangle lie on one line.
    """
    first, *others = (points[cells[:, k]] for k in range(cells.shape[1]))
    sides = [other - first for other in others]
    if len(sides) == 1:
        return unit_vectors(sides[0][:, ::-1] * [1.0, -1.0])
    sides.append(sides[1] - sides[0])
    area = np.cross(sides[0], sides[1])
    longest = np.linalg.norm(sides, axis=-1).max(axis=0)
    flat = np.linalg.norm(area, axis=-1) <= RESOLUTION * np.abs(points).max() * longest
    if flat.any():
        place = ", ".join(f"{value:.6g}" for value in first[flat][0])
        problem = f"{int(flat.sum())} of {len(cells)} triangles have no area; one has a corner at ({place}) m"
        raise InputError("", problem, "mesh the surface again, or repair it in the program that made it")
    return unit_vectors(area)


def oriented(points: Array, cells: IntArray) -> BoolArray:
    """True for the ridges (f, d) of the facets (f, d) that form the rim of the surface.

    Raises
    ------
    InputError
        If neighbouring facets have opposite orientations, facets coincide, or more than two facets meet; also if a
        closed surface faces inward or encloses no volume.
    """
    _, same, times = np.unique(np.sort(cells, axis=1), axis=0, return_inverse=True, return_counts=True)
    double = (times[same.ravel()] > 1)[:, None]
    _refuse(points, cells, double, "facets coincide, a wall of no thickness", WALL)
    number, sense = _ridges(cells, len(points))
    count = np.bincount(number.ravel())
    turned = (count == 2) & (np.bincount(number.ravel(), sense.ravel()) != 0.0)
    _refuse(points, cells, (count > 2)[number], "more than two facets meet", "remove the inner facets")
    remedy = "turn all facets to one side; in Gmsh, mesh the solid and save its cells: softway takes their boundary"
    _refuse(points, cells, turned[number], "neighbouring facets face opposite sides", remedy)
    rim: BoolArray = (count == 1)[number]
    if not rim.any():
        _refuse_hollow(points, cells)
    return rim


def pseudo_normals(points: Array, cells: IntArray, normals: Array) -> Array:
    """Unit pseudo-normals (f, 2^d, d) of every vertex, edge and face of the facets (f, d), by number.

    Parameters
    ----------
    points, cells, normals
        (n, d) vertices [m]; (f, d) facets and their unit normals.

    Examples
    --------
    >>> corner = np.array([[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]])
    >>> cells = np.array([[0, 1], [1, 2]])
    >>> pseudo_normals(corner, cells, normals_of(corner, cells))[0, 2].round(3).tolist()
    [-0.707, -0.707]
    """
    d = cells.shape[1]
    out = np.zeros((len(cells), 2**d, d))
    out[:, -1] = normals
    if d == 3:
        number = _ridges(cells, len(points))[0]
        out[:, RIDGES[3]] = _summed(number, np.repeat(normals[:, None], 3, axis=1))
    out[:, CORNERS[d]] = _summed(cells, _angles(points[cells])[..., None] * normals[:, None])
    return out


def smooth_normals(points: Array, cells: IntArray, normals: Array) -> Array:
    """Unit normals (f, d, d) at the corners of the facets (f, d); exact where all vertices lie on a sphere.

    Parameters
    ----------
    points, cells, normals
        (n, d) vertices [m]; (f, d) facets and their unit normals.

    Reference: N. Max, Weights for computing vertex normals from facet normals, J. Graphics Tools 4 (1999) 1-6.

    Examples
    --------
    >>> angle = np.array([0.1, 0.5, 1.5])
    >>> circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    >>> cells = np.array([[0, 1], [1, 2]])
    >>> bool(np.allclose(smooth_normals(circle, cells, normals_of(circle, cells))[0, 1], circle[1]))
    True
    """
    corners = points[cells]
    to, fro = (np.roll(corners, k, axis=1) - corners for k in (-1, 1))
    square = np.einsum("fki,fki->fk", to, to)
    if cells.shape[1] == 2:
        return _summed(cells, normals[:, None] / np.sqrt(square)[..., None])
    weights = 1.0 / (square * np.einsum("fki,fki->fk", fro, fro))
    return _summed(cells, weights[..., None] * np.cross(to, fro))


def rim_of(cells: IntArray, rim: BoolArray) -> BoolArray:
    """True for the vertices, edges and faces (f, 2^d) of the facets on the rim, given the ridges (f, d) on the rim."""
    d = cells.shape[1]
    at = np.zeros(int(cells.max()) + 1, dtype=bool)
    at[cells[rim]] = True
    if d == 3:
        at[np.roll(cells, -1, axis=1)[rim]] = True
    out = np.zeros((len(cells), 2**d), dtype=bool)
    out[:, RIDGES[d]] = rim
    out[:, CORNERS[d]] = at[cells]
    return out


def _ridges(cells: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Number (f, d) of each ridge, and its sense (f, d): 1 or -1, opposite for two facets of the same orientation."""
    if cells.shape[1] == 2:
        return cells, np.broadcast_to(np.array([-1, 1]), cells.shape)
    after = np.roll(cells, -1, axis=1)
    key = np.minimum(cells, after) * n + np.maximum(cells, after)
    number = np.unique(key, return_inverse=True)[1].reshape(cells.shape)
    return number, np.where(cells < after, 1, -1)


def _refuse(points: Array, cells: IntArray, wrong: BoolArray, problem: str, remedy: str) -> None:
    """Raise an error if a ridge (f, d) of some facets is wrong."""
    found = np.flatnonzero(wrong.any(axis=1))
    if len(found):
        place = ", ".join(f"{value:.6g}" for value in points[cells[found[0]]].mean(axis=0))
        raise InputError("", f"{problem}, at ({place}) m and at {len(found) - 1} other facets", remedy)


def _refuse_hollow(points: Array, cells: IntArray) -> None:
    """Raise an error if a closed surface encloses no volume or faces inward."""
    size = np.ptp(points, axis=0)
    parts = np.linalg.det((points - points.mean(axis=0))[cells])
    volume = float(parts.sum()) / (2 if cells.shape[1] == 2 else 6)
    if abs(volume) <= RESOLUTION * float(np.abs(points).max()) * float(size.max()) ** (cells.shape[1] - 1):
        raise InputError("", f"the {len(cells)} facets enclose no volume, a wall of no thickness", WALL)
    if volume < 0.0:
        remedy = "turn all facets around; for a body inside the surface, use a Cavity of it"
        raise InputError("", f"the closed surface is inside out: its {len(cells)} facets face inward", remedy)


def _angles(corners: Array) -> Array:
    """Angles (f, d) at the corners (f, d, d) of triangles; ones at the ends of segments."""
    if corners.shape[1] == 2:
        return np.ones(corners.shape[:2])
    to, fro = (unit_vectors(np.roll(corners, k, axis=1) - corners) for k in (-1, 1))
    return np.asarray(2.0 * np.arctan2(np.linalg.norm(to - fro, axis=-1), np.linalg.norm(to + fro, axis=-1)))


def _summed(number: IntArray, values: Array) -> Array:
    """Unit vectors (f, k, d) along the sums of the values (f, k, d) with the same number (f, k)."""
    total = np.zeros((int(number.max()) + 1, values.shape[-1]))
    np.add.at(total, number, values)
    return unit_vectors(total)[number]
