"""Distance of points from the flat pieces of a boundary."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.record.audit.geometry.solids import Solids


def distance(solids: Solids, x: Array, points: Array, body: IntArray, centre: Array, rest: Array) -> Array:
    """Distance (k,) of points from the boundary of the bodies that they are in [m].

    A point of the same body has its own piece of the boundary at distance zero. It counts only pieces that lie, at
    rest, nearer to the cell that the point is in than to the point itself.

    Parameters
    ----------
    solids
        Bodies.
    x
        (n, d) positions of their nodes [m].
    points
        (k, d) points [m].
    body
        (k,) number of the body that each point is in.
    centre
        (k, d) centre at rest of the cell that each point is in [m].
    rest
        (k, d) position of each point at rest, infinite if it is of another body [m].
    """
    out = np.full(len(points), np.inf)
    owner = solids.owner[solids.flat[:, 0]]
    middle = solids.reference[solids.flat].mean(axis=1)
    for k, point in enumerate(points):
        mine = owner == body[k]
        if np.isfinite(rest[k]).all():
            mine &= ((middle - centre[k]) ** 2).sum(axis=1) < ((middle - rest[k]) ** 2).sum(axis=1)
        if mine.any():
            out[k] = _nearest(point, x[solids.flat[mine]])
    return out


def _nearest(point: Array, pieces: Array) -> float:
    """Distance of a point (d,) from the nearest of the pieces (k, d, d): ends, segments or triangles [m]."""
    corners = pieces.shape[1]
    best = np.linalg.norm(pieces - point, axis=2).min()
    for a, b in ((0, 1), (1, 2), (2, 0))[: 0 if corners == 1 else 1 if corners == 2 else 3]:
        side = pieces[:, b] - pieces[:, a]
        share = np.clip(((point - pieces[:, a]) * side).sum(axis=1) / (side**2).sum(axis=1), 0.0, 1.0)
        best = min(best, np.linalg.norm(pieces[:, a] + share[:, None] * side - point, axis=1).min())
    if corners == 3:
        first, second, off = pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0], point - pieces[:, 0]
        gram = np.stack([(first * first).sum(1), (first * second).sum(1), (second * second).sum(1)], axis=1)
        right = np.stack([(first * off).sum(1), (second * off).sum(1)], axis=1)
        det = gram[:, 0] * gram[:, 2] - gram[:, 1] ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            u = (gram[:, 2] * right[:, 0] - gram[:, 1] * right[:, 1]) / det
            v = (gram[:, 0] * right[:, 1] - gram[:, 1] * right[:, 0]) / det
        over = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
        foot = u[over][:, None] * first[over] + v[over][:, None] * second[over]
        best = min(best, np.linalg.norm(foot - off[over], axis=1).min(initial=np.inf))
    return float(best)
