"""Rigid obstacles: shapes without a mesh."""

from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.typing import Array
from softway.units import Metre, Pure

UNIT = 1e-15
"""A length that differs less from 1 is that of a unit vector, and is left as it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfSpace:
    """Everything behind a plane (in 1D a point, in 2D a line).

    Parameters
    ----------
    point
        A point of the plane [m]; a number in one dimension.
    normal
        Points out of the obstacle into free space; any length, kept as a unit vector.

    Examples
    --------
    >>> floor = HalfSpace(point=(0.0, 0.0, 0.1), normal=(0.0, 0.0, 2.0))
    >>> floor.normal, float(floor.gap(np.array([5.0, 5.0, 0.3])).round(12))
    ((0.0, 0.0, 1.0), 0.2)
    """

    point: tuple[Metre, ...] | Metre
    normal: tuple[Pure, ...] | Pure

    def __post_init__(self) -> None:
        point, normal = (
            np.atleast_1d(np.array(self.point, dtype=float)),
            np.atleast_1d(np.array(self.normal, dtype=float)),
        )
        if point.ndim != 1 or not 1 <= len(point) <= 3 or not np.isfinite(point).all():
            raise InputError("point", f"{self.point!r} is not a point", "1, 2 or 3 finite coordinates")
        if normal.shape != point.shape or not np.isfinite(normal).all():
            raise InputError(
                "normal",
                f"{self.normal!r} does not go with the point {self.point!r}",
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
        """Distance of points (..., d) from the obstacle [m], (...,); negative inside."""
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
