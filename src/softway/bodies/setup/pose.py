"""Pose of a rigid shape in space: maps the points y of the shape to ``x = R y + s``."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pose:
    """Pose of a rigid shape in space: ``x = R y + s``.

    Parameters
    ----------
    rotation
        R (d, d); the number 1 (shape ()) for no rotation.
    shift
        s (d,) [m]; the number 0 (shape ()) for no translation.

    Examples
    --------
    >>> quarter = Pose(rotation=np.array([[0.0, -1.0], [1.0, 0.0]]), shift=np.array([5.0, 0.0]))
    >>> quarter.place(np.array([1.0, 0.0])).tolist(), quarter.back(np.array([5.0, 1.0])).tolist()
    ([5.0, 1.0], [1.0, 0.0])
    """

    rotation: Array
    shift: Array

    def place(self, y: Array) -> Array:
        """Points in space (..., d) of the points y (..., d) of the shape."""
        return self.turn(y) + self.shift

    def back(self, x: Array) -> Array:
        """Points in the coordinates of the shape (..., d) of the points x (..., d) in space."""
        return np.asarray(np.dot(x - self.shift, self.rotation))

    def turn(self, vectors: Array) -> Array:
        """Rotated vectors (..., d) of the shape."""
        return np.asarray(np.dot(vectors, self.rotation.T))


def require_axis(point: tuple[float, ...], axis: tuple[float, ...]) -> None:
    """Refuse a rotation about what is no axis in the space of the point."""
    dim = len(vector("point", point))
    if dim == 1:
        raise InputError("point", "there is no rotation in one dimension", "a point in 2D or 3D")
    if len(axis) != {2: 0, 3: 3}[dim] or (axis and not np.linalg.norm(axis) > 0.0):
        remedy = "three numbers such as [0, 0, 1]" if dim == 3 else "none in 2D"
        raise InputError("axis", f"{list(axis)} is not an axis in {dim}D", remedy)


def turned_about(point: tuple[float, ...], axis: tuple[float, ...], angle: float) -> Pose:
    """Pose after a rotation by an angle about an axis through a point."""
    x, y, z = np.asarray(axis or (0.0, 0.0, 1.0), float) / np.linalg.norm(axis or (0.0, 0.0, 1.0))
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + np.sin(angle) * cross + 2.0 * np.sin(0.5 * angle) ** 2 * (cross @ cross)
    fixed = np.asarray(point, float)
    rotation = turn[: len(fixed), : len(fixed)]
    return Pose(rotation=rotation, shift=fixed - rotation @ fixed)


def vector(where: str, value: tuple[float, ...] | float) -> Array:
    """Vector (d,) of one to three finite components."""
    vector = np.atleast_1d(np.asarray(value, float))
    if vector.ndim != 1 or not 1 <= len(vector) <= 3 or not np.isfinite(vector).all():
        raise InputError(where, f"{value!r} is not a vector", "1, 2 or 3 finite components")
    return vector
