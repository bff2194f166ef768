"""Rigid obstacle given by a signed distance function of the user."""

import importlib
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.obstacles.half_space import check_length, unit_vectors
from softway.units import Metre

Function = Callable[[Array], Array]


@dataclass(frozen=True, slots=True, kw_only=True)
class SignedDistance:
    """Shape given by a function of points (p, d) with the gaps (p,) as values, positive outside.

    :func:`softway.testing.check_obstacle` checks that the function is a distance and agrees with its gradient.

    Parameters
    ----------
    function
        Signed distance [m]: a callable, or ``module:name`` of a callable that can be imported.
    dim
        Dimension d of space.
    gradient
        Gradient (p, d) of the distance at points (p, d), given likewise; by default from central differences.
    step
        Step of the central differences [m].

    Examples
    --------
    >>> ball = SignedDistance(function=lambda x: np.hypot(x[:, 0], x[:, 1]) - 1.0, dim=2)
    >>> float(ball.gap(np.array([3.0, 4.0]))), ball.normal_at(np.array([3.0, 4.0])).round(9)
    (4.0, array([0.6, 0.8]))
    """

    function: str | Function
    dim: int
    gradient: str | Function | None = None
    step: Metre = 1e-6
    distance: Function = field(init=False, repr=False, compare=False)
    slope: Function | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.dim not in (1, 2, 3):
            raise InputError("dim", f"{self.dim!r} is not a dimension of space", "1, 2 or 3")
        check_length("step", self.step)
        slope = None if self.gradient is None else _called(self.gradient, "gradient")
        object.__setattr__(self, "distance", _called(self.function, "function"))
        object.__setattr__(self, "slope", slope)

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative inside."""
        if x.shape[-1] != self.dim:
            raise InputError("dim", f"{self.dim} for a body in {x.shape[-1]} dimensions", f"{x.shape[-1]}")
        points = x.reshape(-1, self.dim)
        return _answer(self.distance, points, (len(points),), "function").reshape(x.shape[:-1])

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        if self.slope is None:
            arms = self.step * np.eye(self.dim)
            slope = np.stack([self.gap(x + arm) - self.gap(x - arm) for arm in arms], axis=-1)
        else:
            points = x.reshape(-1, self.dim)
            slope = _answer(self.slope, points, points.shape, "gradient").reshape(x.shape)
        return unit_vectors(slope)


def _called(given: str | Function, where: str) -> Function:
    """Function that is given directly or as ``module:name``."""
    if not isinstance(given, str):
        if not callable(given):
            raise InputError(where, f"{given!r} is not a function", "a function of points (p, d), or its module:name")
        return given
    module, _, name = given.partition(":")
    try:
        found: Function = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise InputError(where, f"{given!r}: {error}", "package.module:name of a function") from error
    return _called(found, where)


def _answer(function: Function, points: Array, shape: tuple[int, ...], where: str) -> Array:
    """Values of the function at the points, after a check of their shape."""
    answer = np.asarray(function(points), dtype=float)
    if answer.shape != shape:
        raise InputError(where, f"returns shape {answer.shape} for points {points.shape}", f"shape {shape}")
    return answer
