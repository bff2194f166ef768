"""NumPy reference: overlap of pairs of segments in the plane, projected along the continuous field of slave normals."""

import numpy as np
from overlap_arrays import Overlap

from softway.arrays import Array, IntArray

BEYOND = 0.5
"""Distance beyond the ends of the master, in its lengths, at which a slave point may face its continuation."""


def overlap(slave: Array, normal: Array, master: Array, i: IntArray, j: IntArray) -> Overlap:
    """Overlap of pairs of segments.

    The ends of the master segment are projected onto the slave segment along ``n(xi) = (1 - xi) n_0 + xi n_1`` (Yang,
    Laursen and Meng, 2005): this is their overlap.  Within it a point of the slave faces the point of the master, or
    of its continuation, that lies in front of it along the normal of the slave segment.

    Parameters
    ----------
    slave, master
        (2, 2, p) coordinates of the ends of the segments [m]; the masters run the other way round.
    normal
        (2, 2, p) outward nodal normals at the ends of the slave segments.
    i, j
        (s,) numbers of the slave and of the master segment of each pair.

    Examples
    --------
    >>> slave, master = (np.array([[a, b], [y, y]])[:, :, None] for a, b, y in ((1.0, 0.0, 0.0), (0.5, 4.5, 0.1)))
    >>> up = np.array([[0.0, 0.0], [1.0, 1.0]])[:, :, None]
    >>> common = overlap(slave, up, master, np.array([0]), np.array([0]))
    >>> common.measure.round(12).tolist(), common.cross.sum(axis=0)[:, 0].round(12).tolist()
    ([0.5], [0.46875, 0.03125])
    """
    start, tangent = slave[:, 0, i], (slave[:, 1] - slave[:, 0])[:, i]
    first, turn = normal[:, 0, i], (normal[:, 1] - normal[:, 0])[:, i]
    begin = _seen_at(start - master[:, 1, j], tangent, first, turn)
    end = _seen_at(start - master[:, 0, j], tangent, first, turn)
    pair = np.flatnonzero(end > begin)
    at = np.stack([begin, end])[:, pair]
    away = start[:, None, pair] + at * tangent[:, None, pair] - master[:, :1, j[pair]]
    ray = first[:, None, pair] + at * turn[:, None, pair]
    run = (master[:, 1] - master[:, 0])[:, None, j[pair]]
    across, square = _cross(run, ray), -np.sum(run * tangent[:, None, pair], axis=0)
    there = np.clip(
        -np.sum(away * tangent[:, None, pair], axis=0) / np.where(square > 0.0, square, np.inf), -BEYOND, 1.0 + BEYOND
    )
    length = np.sqrt(np.sum(tangent[:, pair] ** 2, axis=0)) * (at[1] - at[0])
    own, other = np.stack([1.0 - at, at], axis=1), np.stack([1.0 - there, there], axis=1)
    measure = np.where((across > 0.0).all(axis=0), length, 0.0)
    return Overlap(pair=pair, own=_products(own, own, measure), cross=_products(own, other, measure))


def _seen_at(away: Array, tangent: Array, first: Array, turn: Array) -> Array:
    """Coordinate xi (s,) in [0, 1] at which the normal passes through a point; 0 or 1 if it lies beyond.

    It is the root of ``(away + xi tangent) x (first + xi turn) = k0 + k1 xi + k2 xi^2`` with a change from plus to
    minus.
    """
    k0, k1, k2 = _cross(away, first), _cross(tangent, first) + _cross(away, turn), _cross(tangent, turn)
    root = np.sqrt(np.maximum(k1 * k1 - 4.0 * k2 * k0, 0.0))
    inside = (k0 > 0.0) & (k0 + k1 + k2 < 0.0)
    xi = -2.0 * k0 / np.where(inside, k1 - root, -1.0)
    return np.where(inside, np.clip(xi, 0.0, 1.0), np.where(k0 > 0.0, 1.0, 0.0))


def _products(one: Array, other: Array, length: Array) -> Array:
    """Integrals (2, 2, s) over segments of the products of linear functions with values (end, 2, s)."""
    ends = np.einsum("eas,ebs->abs", one, other) + one.sum(axis=0)[:, None] * other.sum(axis=0)
    return np.asarray(ends * (length / 6.0))


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[0] * b[1] - a[1] * b[0])
