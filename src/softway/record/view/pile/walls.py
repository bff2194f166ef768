"""Parts of the walls of a pile that a picture shows."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.mechanisms.members.rows import across


def shown_walls(walls: Sequence[Mapping[str, Any]], low: Array, high: Array) -> list[tuple[Array, Array]]:
    """Corners (k, d) of the part of each wall within a box and in front of the other walls, and its unit normal (d,).

    Examples
    --------
    >>> floor = {"point": [0.0, 0.0], "normal": [0.0, 1.0]}
    >>> corners, _ = shown_walls([floor], np.array([-1.0, -1.0]), np.array([1.0, 1.0]))[0]
    >>> np.unique(corners.round(3) + 0.0, axis=0).tolist()
    [[-1.0, 0.0], [1.0, 0.0]]
    """
    dim = len(low)
    slack = 1e-6 * float(np.linalg.norm(high - low))
    halves = [(np.asarray(w["point"], float), _unit(w["normal"])) for w in walls]
    sides = [(low, one) for one in np.eye(dim)] + [(high, -one) for one in np.eye(dim)]
    found = []
    for point, normal in halves:
        corners = _sheet(point, normal, low, high)
        for at, inwards in (*sides, *halves):
            if not (at is point and inwards is normal):
                corners = _cut(corners, at - slack * inwards, inwards)
        if len(corners) >= dim:
            found.append((corners, normal))
    return found


def _unit(normal: Sequence[float]) -> Array:
    vector = np.asarray(normal, float)
    return np.asarray(vector / np.linalg.norm(vector))


def _sheet(point: Array, normal: Array, low: Array, high: Array) -> Array:
    """Corners of a part of a plane that is larger than its part in a box: two in the plane, four in space."""
    middle, dim = 0.5 * (low + high), len(point)
    foot, size = middle - ((middle - point) @ normal) * normal, 2.0 * float(np.linalg.norm(high - low))
    if dim == 2:
        along = np.array([-normal[1], normal[0]])
        return np.array([foot - size * along, foot + size * along])
    one, other = across(normal)
    return np.array([foot + size * (a * one + b * other) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def _cut(corners: Array, at: Array, inwards: Array) -> Array:
    """Part of a polygon in front of a plane."""
    kept = []
    for one, other in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        a, b = (one - at) @ inwards, (other - at) @ inwards
        if a >= 0.0:
            kept.append(one)
        if a * b < 0.0:
            kept.append(one + a / (a - b) * (other - one))
    return np.array(kept).reshape(-1, len(at))
