"""Checks of a rigid obstacle."""

from typing import Protocol

import numpy as np

from softway.arrays import Array
from softway.testing.verdict import close, require


class Obstacle(Protocol):
    """Members that the shape of an obstacle must have."""

    @property
    def dim(self) -> int:
        """Dimension d of space."""
        ...

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m], positive outside."""
        ...

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        ...


def check_obstacle(shape: Obstacle, points: Array, *, tolerance: float = 1e-6) -> None:
    """Check an obstacle at given points; raise ``AssertionError`` with the first error found.

    Checked: array shapes, unit normals, the normal as gradient of the gap (the gap grows outward by one metre per
    metre), and the closest point (the point moved by the gap against the normal) lies on the surface.

    Parameters
    ----------
    shape
        Obstacle with ``dim``, ``gap`` (...,) and ``normal_at`` (..., d) at points (..., d).
    points
        (p, d) [m], away from edges of the surface and from points equally far from two parts of it.
    tolerance
        Greatest error of a derivative, and of a distance relative to the extent of the points.

    Examples
    --------
    >>> from softway.obstacles.primitives import Sphere
    >>> check_obstacle(Sphere(centre=(0.0, 0.0), radius=1.0), np.array([[2.0, 0.0], [0.3, 0.4]]))
    """
    x = np.array(points, dtype=float)
    size = float(np.linalg.norm(np.ptp(x, axis=0))) or float(np.abs(x).max()) or 1.0
    require(x.ndim == 2 and x.shape[1] == shape.dim, shape, f"points of shape {x.shape} for {shape.dim} dimensions")
    _shapes(shape, x)
    gap, normal = shape.gap(x), shape.normal_at(x)
    close(np.linalg.norm(normal, axis=-1), np.ones(len(x)), 1e-12, shape, "a normal is not a unit vector")
    step = 1e-4 * size
    arms = step * np.eye(shape.dim)
    near = [(shape.gap(x + k * arm) - shape.gap(x - k * arm)) / (2.0 * k * step) for arm in arms for k in (1.0, 2.0)]
    slope = np.stack([(4.0 * one - two) / 3.0 for one, two in zip(near[::2], near[1::2], strict=True)], axis=-1)
    close(
        np.linalg.norm(slope, axis=-1),
        np.ones(len(x)),
        tolerance,
        shape,
        "the gradient of the gap does not have length 1",
    )
    close(normal, slope, tolerance, shape, "the normal is not the gradient of the gap", 1.0)
    foot = shape.gap(x - gap[:, None] * normal)
    close(
        foot,
        np.zeros(len(x)),
        tolerance,
        shape,
        "the point moved by the gap against the normal is not on the surface",
        size,
    )


def _shapes(shape: Obstacle, x: Array) -> None:
    """Check the shapes of the results, and that one point gives the same result as many."""
    kept, twice = x.copy(), np.stack([x, x])
    for name, answer in (("gap", shape.gap), ("normal_at", shape.normal_at)):
        many = answer(x)
        wanted = x.shape[:1] if name == "gap" else x.shape
        require(np.shape(many) == wanted, shape, f"{name} of points {x.shape} has shape {np.shape(many)}")
        require(bool(np.isfinite(many).all()), shape, f"{name} is not finite")
        close(answer(x[0]), many[0], 1e-12, shape, f"{name} of one point differs from {name} of an array", 1.0)
        close(answer(twice), np.stack([many, many]), 1e-12, shape, f"{name} of points (2, p, d) differs", 1.0)
    require(np.array_equal(x, kept), shape, "the array of points was changed")
