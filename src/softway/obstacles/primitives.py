"""Rigid obstacles with curved surfaces or sharp edges: signed distance, positive outside, and its gradient."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.obstacles.half_space import HalfSpace, check_direction, check_length, in_space_of, unit_vectors
from softway.obstacles.signed_distance import SignedDistance
from softway.obstacles.triangulated import Facets, Surface
from softway.units import Metre, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Sphere:
    """Ball; in 2D a disc.

    Parameters
    ----------
    centre
        Centre [m].
    radius
        Radius [m].

    Examples
    --------
    >>> float(Sphere(centre=(0.0, 0.0, 0.0), radius=1.0).gap(np.array([0.0, 3.0, 4.0])))
    4.0
    """

    centre: tuple[Metre, ...]
    radius: Metre

    def __post_init__(self) -> None:
        check_length("radius", self.radius)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.centre)

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative inside."""
        return np.linalg.norm(x - in_space_of(self.centre, x), axis=-1) - self.radius

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        return unit_vectors(x - in_space_of(self.centre, x))


@dataclass(frozen=True, slots=True, kw_only=True)
class Roller:
    """Infinite cylinder in 3D.

    Parameters
    ----------
    point
        Point of the axis [m].
    axis
        Direction of the axis.
    radius
        Radius [m].

    Examples
    --------
    >>> roll = Roller(point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 2.0), radius=1.0)
    >>> float(roll.gap(np.array([3.0, 4.0, 7.0])).round(12)), roll.normal_at(np.array([3.0, 4.0, 7.0]))
    (4.0, array([0.6, 0.8, 0. ]))
    """

    point: tuple[Metre, Metre, Metre]
    axis: tuple[Pure, Pure, Pure]
    radius: Metre

    def __post_init__(self) -> None:
        check_length("radius", self.radius)
        check_direction("axis", self.axis)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return 3

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., 3) [m]; negative inside."""
        return np.linalg.norm(self._across(x), axis=-1) - self.radius

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., 3) at points (..., 3)."""
        return unit_vectors(self._across(x))

    def _across(self, x: Array) -> Array:
        axis = unit_vectors(np.asarray(self.axis, float))
        arm = x - in_space_of(self.point, x)
        return np.asarray(arm - (arm @ axis)[..., None] * axis)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinder:
    """Solid cylinder with flat ends and sharp rims, in 3D.

    Parameters
    ----------
    start, end
        Centres of the two ends [m].
    radius
        Radius [m].

    Examples
    --------
    >>> punch = Cylinder(start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 2.0), radius=1.0)
    >>> punch.gap(np.array([[0.0, 0.0, 2.5], [4.0, 0.0, 6.0], [0.9, 0.0, 1.0]])).round(12)
    array([ 0.5,  5. , -0.1])
    """

    start: tuple[Metre, Metre, Metre]
    end: tuple[Metre, Metre, Metre]
    radius: Metre

    def __post_init__(self) -> None:
        check_length("radius", self.radius)
        if not np.linalg.norm(np.subtract(self.end, self.start)) > 0.0:
            raise InputError("end", f"{list(self.end)} is the same point as start", "another point")

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return 3

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., 3) [m]; negative inside."""
        return _from_sides(self._depth(x)[0])

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., 3) at points (..., 3); inside, the normal of the nearest face."""
        depth, directions = self._depth(x)
        return unit_vectors((_shares(depth)[..., None] * directions).sum(axis=-2))

    def _depth(self, x: Array) -> tuple[Array, Array]:
        """Signed distances (..., 2) from the lateral surface and the nearer end, and both normals (..., 2, 3)."""
        start, end = in_space_of(self.start, x), np.asarray(self.end, float)
        axis, arm = unit_vectors(end - start), x - 0.5 * (start + end)
        height = arm @ axis
        across = arm - height[..., None] * axis
        half = 0.5 * np.linalg.norm(end - start)
        depth = np.stack([np.linalg.norm(across, axis=-1) - self.radius, np.abs(height) - half], axis=-1)
        return depth, np.stack([unit_vectors(across), np.where(height[..., None] >= 0.0, axis, -axis)], axis=-2)


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """Box along the axes, with sharp edges; in 2D a rectangle.

    Outside, the gap is the distance from the closest point: the normal turns continuously around an edge.

    Parameters
    ----------
    low
        Corner with the lowest coordinates [m].
    high
        Corner with the highest coordinates [m].

    Examples
    --------
    >>> step = Block(low=(0.0, 0.0), high=(2.0, 1.0))
    >>> step.gap(np.array([[1.0, 1.5], [5.0, 5.0], [1.0, 0.9]])).round(12)
    array([ 0.5,  5. , -0.1])
    """

    low: tuple[Metre, ...]
    high: tuple[Metre, ...]

    def __post_init__(self) -> None:
        if len(self.low) != len(self.high) or not all(a < b for a, b in zip(self.low, self.high, strict=True)):
            raise InputError("high", f"{self.high} is not above {self.low} in every direction", "low < high")

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.low)

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative inside."""
        return _from_sides(self._depth(x))

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d); inside, the normal of the nearest face."""
        side = np.where(x >= 0.5 * (np.asarray(self.low) + np.asarray(self.high)), 1.0, -1.0)
        return side * _shares(self._depth(x))

    def _depth(self, x: Array) -> Array:
        """Signed distance (..., d) from the two faces across each axis."""
        return np.asarray(np.maximum(in_space_of(self.low, x) - x, x - in_space_of(self.high, x)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Torus:
    """Ring with a circular section, in 3D.

    Parameters
    ----------
    centre
        Centre [m].
    axis
        Direction of the axis.
    radius
        Radius of the centre line [m].
    tube
        Radius of the section [m], less than ``radius``.

    Examples
    --------
    >>> ring = Torus(centre=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), radius=2.0, tube=0.5)
    >>> float(ring.gap(np.array([0.0, 0.0, 0.0])))
    1.5
    """

    centre: tuple[Metre, Metre, Metre]
    axis: tuple[Pure, Pure, Pure]
    radius: Metre
    tube: Metre

    def __post_init__(self) -> None:
        check_length("tube", self.tube)
        check_direction("axis", self.axis)
        if not self.radius > self.tube:
            raise InputError(
                "radius", f"{self.radius:g} m is not greater than the tube {self.tube:g} m", "a greater radius"
            )

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return 3

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., 3) [m]; negative inside."""
        return np.linalg.norm(self._arm(x), axis=-1) - self.tube

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., 3) at points (..., 3)."""
        return unit_vectors(self._arm(x))

    def _arm(self, x: Array) -> Array:
        """Vectors (..., 3) from the nearest points of the centre line."""
        axis = unit_vectors(np.asarray(self.axis, float))
        arm = x - in_space_of(self.centre, x)
        across = arm - (arm @ axis)[..., None] * axis
        return np.asarray(arm - self.radius * unit_vectors(across))


@dataclass(frozen=True, slots=True, kw_only=True)
class Cavity:
    """Obstacle around a hollow shape, such as the wall of a bowl, a tube or a box.

    Parameters
    ----------
    of
        Shape of the hollow.

    Examples
    --------
    >>> bowl = Cavity(of=Sphere(centre=(0.0, 0.0), radius=2.0))
    >>> float(bowl.gap(np.zeros(2) + 1e-300)), bowl.normal_at(np.array([1.0, 0.0]))
    (2.0, array([-1., -0.]))
    """

    of: Sphere | Roller | Cylinder | Block | Torus | Surface | Facets | SignedDistance

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return self.of.dim

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative in the wall."""
        return -self.of.gap(x)

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d), into the hollow."""
        return -self.of.normal_at(x)


Shape = HalfSpace | Sphere | Roller | Cylinder | Block | Torus | Surface | Facets | SignedDistance | Cavity


def _from_sides(depth: Array) -> Array:
    """Signed distance (...,) from a body, from the distances (..., k) to its sides, which meet at right angles."""
    outside = np.linalg.norm(np.maximum(depth, 0.0), axis=-1)
    return np.asarray(outside + np.minimum(depth.max(axis=-1), 0.0))


def _shares(depth: Array) -> Array:
    """Components (..., k) of the unit normal along the normals of the sides; inside, one for the nearest side."""
    nearest = np.arange(depth.shape[-1]) == depth.argmax(axis=-1)[..., None]
    inside = depth.max(axis=-1, keepdims=True) <= 0.0
    return unit_vectors(np.where(inside, nearest, np.maximum(depth, 0.0)))
