"""Simple shapes as points (n, 3) and triangles (t, 3)."""

from collections.abc import Iterable

import numpy as np

from softway.arrays import Array, IntArray
from softway.mechanisms.members.rows import across

RINGS = 16
"""Rings of a ball; around it are twice as many points."""


def bar(start: Array, end: Array, thick: float) -> tuple[Array, IntArray]:
    """Square bar between two points (3,).

    Examples
    --------
    >>> points, triangles = bar(np.zeros(3), np.array([1.0, 0.0, 0.0]), 0.1)
    >>> points.shape, triangles.shape, float(points[:, 0].max())
    ((8, 3), (12, 3), 1.0)
    """
    way = end - start
    one, other = across(way / float(np.linalg.norm(way)))
    corners = 0.5 * thick * np.array([-one - other, one - other, one + other, other - one])
    points = np.vstack([start + corners, end + corners])
    sides = [t for k in range(4) for t in ((k, (k + 1) % 4, k + 4), ((k + 1) % 4, (k + 1) % 4 + 4, k + 4))]
    return points, np.array([(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), *sides])


def ball(centre: Array, radius: float) -> tuple[Array, IntArray]:
    """Ball around a point (3,).

    Examples
    --------
    >>> points, _ = ball(np.array([1.0, 0.0, 0.0]), 0.5)
    >>> bool(np.allclose(np.linalg.norm(points - [1.0, 0.0, 0.0], axis=1), 0.5))
    True
    """
    high, round_ = np.meshgrid(np.linspace(0.0, np.pi, RINGS + 1), np.arange(2 * RINGS) * np.pi / RINGS, indexing="ij")
    points = np.stack([np.sin(high) * np.cos(round_), np.sin(high) * np.sin(round_), np.cos(high)], axis=-1)
    k, m = (grid.ravel() for grid in np.meshgrid(np.arange(RINGS), np.arange(2 * RINGS), indexing="ij"))
    n, after = 2 * RINGS, (m + 1) % (2 * RINGS)
    lower = np.stack([k * n + m, (k + 1) * n + m, (k + 1) * n + after], axis=1)
    upper = np.stack([k * n + m, (k + 1) * n + after, k * n + after], axis=1)
    return centre + radius * points.reshape(-1, 3), np.vstack([lower, upper])


def plate(corners: Array, normal: Array, margin: float) -> tuple[Array, IntArray]:
    """Rectangle of a plane around points (n, 3) of it, with a margin."""
    axes = np.array(across(normal / float(np.linalg.norm(normal))))
    middle = corners.mean(axis=0)
    reach = np.abs((corners - middle) @ axes.T).max(axis=0) + margin
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return middle + (signs * reach) @ axes, np.array([(0, 1, 2), (0, 2, 3)])


def merged(shapes: Iterable[tuple[Array, IntArray]]) -> tuple[Array, IntArray]:
    """One shape of several.

    Examples
    --------
    >>> merged([ball(np.zeros(3), 1.0), bar(np.zeros(3), np.ones(3), 0.1)])[1].max()
    np.int64(551)
    """
    points, triangles, count = [], [], 0
    for more, corners in shapes:
        points.append(more)
        triangles.append(corners + count)
        count += len(more)
    return np.vstack(points), np.vstack(triangles)
