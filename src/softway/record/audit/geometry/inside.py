"""Points inside of cells: inversion of the map of a cell by Newton's method."""

import numpy as np

from softway.arrays import Array, BoolArray
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.element import tabulate

STEPS = 20
"""Greatest number of Newton steps; cells that are nearly parallelepipeds need three."""
CLOSE = 1e-9
"""Newton step, in reference coordinates, after which the error of the next iterate is its square: rounding."""
REACH = 0.6
"""Reference coordinates beyond the cell, in its sides, at which an iterate is held."""


def local_coordinates(cell: str, corners: Array, points: Array) -> tuple[Array, BoolArray]:
    """Reference coordinates (k, r) of points in cells, and (k,) whether the points lie inside.

    Parameters
    ----------
    cell
        Name of the cell.
    corners
        (k, a, d) positions of the nodes of a cell for each point [m], d = r.
    points
        (k, d) points [m].

    Examples
    --------
    >>> square = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]])
    >>> where, found = local_coordinates("quad4", square, np.array([[0.5, 0.5]]))
    >>> where.round(12).tolist(), found.tolist()
    ([[0.25, 0.5]], [True])
    """
    where = np.broadcast_to(CELLS[cell].nodes[: CELLS[cell].corners].mean(axis=0), points.shape).copy()
    moving = np.arange(len(points))
    found = np.zeros(len(points), dtype=bool)
    for _ in range(STEPS):
        N, dN = tabulate(cell, where[moving])
        nodes = corners[moving]
        rest = points[moving] - np.einsum("ka,kad->kd", N, nodes)
        slope = np.einsum("kad,kar->kdr", nodes, dN)
        step = _solved(slope, rest)
        new = np.clip(where[moving] + step, -REACH, 1.0 + REACH)
        change = np.abs(new - where[moving]).max(axis=1)
        where[moving] = new
        done = change <= CLOSE
        found[moving[done]] = np.abs(step[done]).max(axis=1, initial=0.0) <= 2.0 * CLOSE
        moving = moving[~done]
        if not len(moving):
            break
    return where, found & (depths(cell, where).min(axis=1) >= 0.0)


def depths(cell: str, where: Array) -> Array:
    """Depth (k, faces) of the reference points (k, r) behind each face of a cell, in the order of ``FACETS``.

    Examples
    --------
    >>> depths("tri3", np.array([[0.25, 0.25]])).tolist()
    [[0.25, 0.5, 0.25]]
    """
    return np.stack([(where - origin) @ normal for origin, normal in _faces(cell)], axis=1)


def slopes(cell: str, corners: Array, where: Array) -> Array:
    """Lengths (k, faces) of the gradients in space of the depths behind the faces [1/m]."""
    _, dN = tabulate(cell, where)
    jacobian = np.einsum("kad,kar->kdr", corners, dN)
    normals = np.array([normal for _, normal in _faces(cell)])
    inverse = np.linalg.pinv(jacobian)
    return np.asarray(np.linalg.norm(np.einsum("fr,krd->kfd", normals, inverse), axis=2))


def _faces(cell: str) -> list[tuple[Array, Array]]:
    """Corner (r,) and inward normal (r,) of each face of a reference cell, in the order of ``FACETS``."""
    nodes = CELLS[cell].nodes
    inner = nodes[: CELLS[cell].corners].mean(axis=0)
    corners = [nodes[list(local)[: CELLS[facet].corners]] for facet, local in FACETS[cell]]
    return [(ends[0], _normal(ends, inner)) for ends in corners]


def _normal(corners: Array, inner: Array) -> Array:
    """Inward normal (r,) of a face with ``corners``, scaled so that the depth of simplices and cubes ends at one."""
    dim = len(inner)
    if dim == 1:
        return np.sign(inner - corners[0])
    if dim == 2:
        tangent = corners[1] - corners[0]
        normal = np.array([-tangent[1], tangent[0]])
    else:
        normal = np.cross(corners[1] - corners[0], corners[-1] - corners[0])
    normal = normal / np.abs(normal).max()
    return np.asarray(normal * np.sign((inner - corners[0]) @ normal))


def _solved(slope: Array, rest: Array) -> Array:
    """Newton steps (k, r); zero where a cell is singular at its iterate."""
    det = np.linalg.det(slope)
    size = np.prod(np.linalg.norm(slope, axis=1), axis=1)
    good = np.abs(det) > 1e-12 * size
    out = np.full(rest.shape, REACH)
    out[good] = np.linalg.solve(slope[good], rest[good][:, :, None])[:, :, 0]
    return out
