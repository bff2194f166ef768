"""Rotations of many bodies as unit quaternions, scalar first."""

import numpy as np

from softway.arrays import Array


def turned(turn: Array, vector: Array) -> Array:
    """Quaternions (n, 4) turned by Cayley's map of rotation vectors (n, 3), of magnitude ``2 tan(angle / 2)``.

    Examples
    --------
    >>> turned(np.array([[1.0, 0.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 2.0]])).round(4).tolist()
    [[0.7071, 0.0, 0.0, 0.7071]]
    """
    half, scalar, rest = 0.5 * vector, turn[:, :1], turn[:, 1:]
    new = np.concatenate(
        [scalar - (half * rest).sum(axis=1, keepdims=True), rest + scalar * half + np.cross(half, rest)], axis=1
    )
    return np.asarray(new / np.linalg.norm(new, axis=1, keepdims=True))
