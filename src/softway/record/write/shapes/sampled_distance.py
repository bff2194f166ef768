"""Signed distance of a shape on a regular grid of points: plain data, for records and pictures."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.obstacles.half_space import unit_vectors
from softway.obstacles.primitives import Shape
from softway.units import Metre

POINTS = {1: 1025, 2: 257, 3: 41}
"""Points of the grid along each direction, for 1, 2 and 3 dimensions."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SampledDistance:
    """Shape whose gap is interpolated between grid points.

    Outside of the grid the distance from the grid is added, so that far places stay far.

    Parameters
    ----------
    low, high
        Opposite corners (d,) of the grid [m].
    values
        Gaps (k, ..., k) at the grid points [m].

    Examples
    --------
    >>> from softway.obstacles import Sphere
    >>> ball = sampled(Sphere(centre=(0.0, 0.0), radius=1.0), np.array([[-2.0, -2.0], [2.0, 2.0]]))
    >>> round(float(ball.gap(np.array([1.5, 0.0]))), 3)
    0.5
    """

    low: tuple[Metre, ...]
    high: tuple[Metre, ...]
    values: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", np.asarray(self.values, dtype=float))

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.low)

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative inside."""
        low, high = np.asarray(self.low), np.asarray(self.high)
        inside = np.clip(x, low, high)
        place = (inside - low) / (high - low) * (np.array(self.values.shape) - 1.0)
        places = place.reshape(-1, self.dim).T
        from scipy.ndimage import map_coordinates  # slow to load

        found = map_coordinates(self.values, places, order=1, mode="nearest").reshape(x.shape[:-1])
        return np.asarray(found + np.linalg.norm(x - inside, axis=-1))

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d), from differences over a grid spacing."""
        step = (np.asarray(self.high) - np.asarray(self.low)) / (np.array(self.values.shape) - 1.0)
        arms = zip(0.5 * np.diag(step), step, strict=True)
        slope = [(self.gap(x + arm) - self.gap(x - arm)) / width for arm, width in arms]
        return unit_vectors(np.stack(slope, axis=-1))


def sampled(shape: Shape, region: Array) -> SampledDistance:
    """Sample a shape in the ``region`` (2, d) between two opposite corners."""
    low, high = region
    axes = [np.linspace(a, b, POINTS[len(low)]) for a, b in zip(low, high, strict=True)]
    values = shape.gap(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
    return SampledDistance(low=tuple(low.tolist()), high=tuple(high.tolist()), values=values)
