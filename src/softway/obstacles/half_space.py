"""Half-space as a rigid obstacle, and checks for the shapes of obstacles."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, real
from softway.units import Metre, Pure

UNIT = 1e-15
"""A vector whose length differs from 1 by less than this is a unit vector and remains unchanged."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfSpace:
    """Half-space behind a plane (in 1D a point, in 2D a line).

    Parameters
    ----------
    point
        Point of the plane [m]; a number in one dimension.
    normal
        Normal from the obstacle into free space, of any length; stored as a unit vector.

    Examples
    --------
    >>> floor = HalfSpace(point=(0.0, 0.0, 0.1), normal=(0.0, 0.0, 2.0))
    >>> floor.normal, float(floor.gap(np.array([5.0, 5.0, 0.3])).round(12))
    ((0.0, 0.0, 1.0), 0.2)
    """

    point: tuple[Metre, ...] | Metre
    normal: tuple[Pure, ...] | Pure

    def __post_init__(self) -> None:
        for name in ("point", "normal"):
            for number in np.ravel(np.asarray(getattr(self, name), dtype=object)):
                real(number, name)
        point, normal = (
            np.atleast_1d(np.array(self.point, dtype=float)),
            np.atleast_1d(np.array(self.normal, dtype=float)),
        )
        if point.ndim != 1 or not 1 <= len(point) <= 3 or not np.isfinite(point).all():
            raise InputError("point", f"{self.point!r} is not a point", "1, 2 or 3 finite coordinates")
        if normal.shape != point.shape or not np.isfinite(normal).all():
            raise InputError(
                "normal",
                f"{self.normal!r} does not match the point {self.point!r}",
                f"{len(point)} finite components",
            )
        length = float(np.linalg.norm(normal))
        if length == 0.0:
            raise InputError(
                "normal", f"{self.normal!r} has length zero", "a vector out of the obstacle into free space"
            )
        unit = tuple(float(value) for value in (normal if abs(length - 1.0) <= UNIT else normal / length))
        scalar = np.ndim(self.point) == 0
        object.__setattr__(self, "point", float(point[0]) if scalar else tuple(float(value) for value in point))
        object.__setattr__(self, "normal", unit[0] if scalar else unit)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return np.size(self.point)

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) from the obstacle [m]; negative inside."""
        self._check(x)
        return np.asarray((x - np.atleast_1d(self.point)) @ np.atleast_1d(self.normal), dtype=float)

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        self._check(x)
        return np.broadcast_to(np.atleast_1d(self.normal), x.shape).copy()

    def _check(self, x: Array) -> None:
        if x.shape[-1] != self.dim:
            raise InputError(
                "point", f"{self.dim} coordinates for a body in {x.shape[-1]} dimensions", f"{x.shape[-1]} coordinates"
            )


def unit_vectors(v: Array) -> Array:
    """Unit vectors along vectors (..., d); the first axis for vectors of length zero.

    Examples
    --------
    >>> unit_vectors(np.array([[0.0, 2.0], [0.0, 0.0]])).tolist()
    [[0.0, 1.0], [1.0, 0.0]]
    """
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    first = np.zeros(v.shape[-1])
    first[0] = 1.0
    return np.where(length > 0.0, v / np.where(length > 0.0, length, 1.0), first)


def in_space_of(point: Sequence[float], x: Array) -> Array:
    """Convert a point to an array, after a check that it has the dimension of x (..., d)."""
    if x.shape[-1] != len(point):
        raise InputError(
            "", f"{len(point)} coordinates for a body in {x.shape[-1]} dimensions", "a shape of that dimension"
        )
    return np.asarray(point, float)


def check_length(where: str, value: float) -> None:
    """Raise an error for a length that is not positive."""
    if not 0.0 < value < np.inf:
        raise InputError(where, f"{value:g} m is not positive", "a positive length")


def check_direction(where: str, vector: Sequence[float]) -> None:
    """Raise an error for a vector of length zero."""
    if not np.linalg.norm(vector) > 0.0:
        raise InputError(where, f"{list(vector)} is not a direction", "a vector such as [0, 0, 1]")
