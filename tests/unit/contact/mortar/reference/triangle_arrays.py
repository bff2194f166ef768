"""NumPy reference: overlap of pairs of triangles in space, projected along the normals of the slave triangles."""

import numpy as np
from clip_arrays import clip
from overlap_arrays import Overlap

from softway.arrays import Array, IntArray

EDGE_ON = 1e-10
"""Area over the square of the edges, below which the projected master triangle is degenerate."""


def overlap(slave: Array, master: Array, i: IntArray, j: IntArray) -> Overlap:
    """Overlap of pairs of triangles.

    The master triangle is projected onto the plane of the slave triangle and cut by its edges (Puso and Laursen, 2004),
    in barycentric coordinates of the slave triangle: these are the distances from its edges.

    Parameters
    ----------
    slave, master
        (3, 3, p) coordinates of the corners of the triangles [m]; as seen from the slave, the masters turn the other
        way round.
    i, j
        (s,) numbers of the slave and of the master triangle of each pair.

    Examples
    --------
    >>> slave = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).T[:, :, None]
    >>> master = np.array([[0.0, 0.0, 0.1], [0.0, 0.5, 0.1], [2.0, 0.0, 0.1]]).T[:, :, None]
    >>> overlap(slave, master, np.array([0]), np.array([0])).measure.round(12).tolist()
    [0.333333333333]
    """
    seen, area = _seen(slave, master, i, j)
    outward, turn = _from_master(seen[1:])
    pair = np.flatnonzero((turn < 0.0) & (seen.max(axis=1) > 0.0).all(axis=0) & (outward.min(axis=1) < 0.0).all(axis=0))
    polygon, count = np.take(seen[1:], pair, axis=2), np.full(len(pair), 3)
    for side in range(3):
        distance = polygon[side] if side < 2 else 1.0 - polygon[0] - polygon[1]
        polygon, count = clip(polygon, distance, count)
    left = np.flatnonzero(count > 2)
    pair = pair[left]
    own = area[i[pair]] * _moments(np.take(polygon, left, axis=2), count[left])
    back = np.roll(np.take(outward, pair, axis=2), 2, axis=0) / turn[pair]  # coordinates on the master of slave corners
    return Overlap(pair=pair, own=own, cross=np.einsum("acs,bcs->abs", own, back))


def _seen(slave: Array, master: Array, i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Barycentric coordinates (3, 3, s) of the master corners on the slave triangle, and twice the slave areas (p,)."""
    edges = slave[:, 1:] - slave[:, :1]
    normal = np.cross(edges[:, 0], edges[:, 1], axis=0)
    square = np.sum(normal**2, axis=0)
    toward = np.stack([np.cross(edges[:, 1], normal, axis=0), np.cross(normal, edges[:, 0], axis=0)]) / square
    away = np.take(master, j, axis=2) - np.take(slave[:, :1], i, axis=2)
    two = np.einsum("gds,dcs->gcs", np.take(toward, i, axis=2), away)
    seen = np.concatenate([1.0 - two.sum(axis=0, keepdims=True), two])
    return seen, np.sqrt(square)


def _from_master(corners: Array) -> tuple[Array, Array]:
    """Outward distances (3, 3, s) of the slave corners from the edges of the master triangles, times the edge lengths.

    ``corners`` (2, 3, s) are the last two coordinates of the master on the slave.  Also returns twice the area (s,) of
    the master relative to that of the slave: negative where the two face each other, zero for a degenerate projection.
    """
    run = np.roll(corners, -1, axis=1) - corners
    to_first = run[1] * corners[0] - run[0] * corners[1]
    outward = np.stack([to_first, to_first - run[1], to_first + run[0]], axis=1)
    turn = run[0, 0] * run[1, 1] - run[1, 0] * run[0, 1]
    return outward, np.where(-turn > EDGE_ON * np.sum(run**2, axis=(0, 1)), turn, 0.0)


def _moments(polygon: Array, count: IntArray) -> Array:
    """Integrals (3, 3, s) of products of barycentric coordinates over polygons (2, v, s), for a triangle of area 1/2.

    The polygons turn clockwise and are fanned into triangles about their first corner.
    """
    first = np.concatenate([1.0 - polygon[0, :1] - polygon[1, :1], polygon[:, 0]])
    z = polygon[:, 1:] - polygon[:, :1]
    z = np.where(np.arange(1, polygon.shape[1])[:, None] < count, z, 0.0)
    (x, y), (u, v) = z[:, :-1], z[:, 1:]
    turn = np.maximum(u * y - x * v, 0.0)
    area = 0.5 * turn.sum(axis=0)
    xx, xy, yy = (
        np.sum(turn * (a * b + c * d + 0.5 * (a * d + b * c)), axis=0) / 12.0
        for a, b, c, d in ((x, x, u, u), (x, y, u, v), (y, y, v, v))
    )
    mean = np.stack([np.sum(turn * sums, axis=0) / 6.0 for sums in (-x - u - y - v, x + u, y + v)])
    second = np.stack([xx + 2.0 * xy + yy, -xx - xy, -xy - yy, -xx - xy, xx, xy, -xy - yy, xy, yy]).reshape(3, 3, -1)
    linear = first[:, None] * (0.5 * area * first + mean)
    return np.asarray(np.maximum(linear + np.swapaxes(linear, 0, 1) + second, 0.0))
