"""Prescribed motion of rigid tools: pose of a shape at any time, and displacement of its material points.

A pose maps the points y of a shape into space, ``x = R y + s``.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.obstacles.primitives import Cavity, Shape
from softway.obstacles.triangulated import Facets, Surface
from softway.units import Metre, MetrePerSecond, Pure, RadianPerSecond, Second


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


@dataclass(frozen=True, slots=True, kw_only=True)
class Still:
    """Tool at rest.

    Examples
    --------
    >>> float(Still().at(3.0).shift)
    0.0
    """

    @property
    def dim(self) -> None:
        """None: a tool of any dimension can be at rest."""

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        return Pose(rotation=np.array(1.0), shift=np.array(0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Translation:
    """Uniform translation from the place of the shape at t = 0.

    Parameters
    ----------
    velocity
        Velocity [m/s]; a number in one dimension.

    Examples
    --------
    >>> Translation(velocity=(0.0, -2.0)).at(0.5).shift.tolist()
    [0.0, -1.0]
    """

    velocity: tuple[MetrePerSecond, ...] | MetrePerSecond

    def __post_init__(self) -> None:
        _vector("velocity", self.velocity)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return np.size(self.velocity)

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        return Pose(rotation=np.array(1.0), shift=time * _vector("velocity", self.velocity))


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Translation that is linear between given instants, constant before the first and after the last.

    Parameters
    ----------
    times
        Increasing instants [s].
    displacements
        Displacement at each instant [m]: vectors, or numbers in one dimension.

    Examples
    --------
    >>> press = Table(times=(0.0, 1.0, 3.0), displacements=((0.0, 0.0), (0.0, -2.0), (0.0, 0.0)))
    >>> [press.at(t).shift[1].tolist() for t in (-1.0, 0.5, 2.0, 9.0)]
    [0.0, -1.0, -1.0, 0.0]
    """

    times: tuple[Second, ...]
    displacements: tuple[Metre, ...] | tuple[tuple[Metre, ...], ...]

    def __post_init__(self) -> None:
        if not self.times or not np.isfinite(self.times).all() or not (np.diff(self.times) > 0.0).all():
            raise InputError("times", f"{list(self.times)} do not increase", "increasing instants")
        if len(self.displacements) != len(self.times):
            problem = f"{len(self.displacements)} displacements for {len(self.times)} times"
            raise InputError("displacements", problem, "one for each instant")
        rows: Sequence[tuple[float, ...] | float] = self.displacements
        sizes = {len(_vector(f"displacements[{k}]", row)) for k, row in enumerate(rows)}
        if len(sizes) > 1:
            raise InputError("displacements", f"vectors of {sorted(sizes)} components", "vectors of equal length")

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return np.size(self.displacements[0])

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        knots = np.reshape(np.asarray(self.displacements, float), (len(self.times), self.dim))
        after = min(bisect_right(self.times, time), len(self.times) - 1)
        before = max(after - 1, 0)
        share = np.interp(time, (self.times[before], self.times[after]), (0.0, 1.0)) if after > before else 0.0
        return Pose(rotation=np.array(1.0), shift=(1.0 - share) * knots[before] + share * knots[after])


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """Uniform rotation about a fixed axis from the place of the shape at t = 0.

    Parameters
    ----------
    point
        Point on the axis [m].
    axis
        Direction of the axis, right-hand rule; empty in 2D, where a positive rate turns x to y.
    rate
        Angular velocity [rad/s].

    Examples
    --------
    >>> turn = Turning(point=(1.0, 0.0), rate=np.pi / 2)
    >>> turn.at(1.0).place(np.array([2.0, 0.0])).round(12).tolist()
    [1.0, 1.0]
    """

    point: tuple[Metre, ...]
    rate: RadianPerSecond
    axis: tuple[Pure, ...] = ()

    def __post_init__(self) -> None:
        if not np.isfinite(self.rate):
            raise InputError("rate", f"{self.rate:g} rad/s is not finite", "an angular velocity")
        if len(_vector("point", self.point)) == 1:
            raise InputError("point", "there is no rotation in one dimension", "a point in 2D or 3D")
        if len(self.axis) != {2: 0, 3: 3}[self.dim] or (self.axis and not np.linalg.norm(self.axis) > 0.0):
            remedy = "three numbers such as [0, 0, 1]" if self.dim == 3 else "none in 2D"
            raise InputError("axis", f"{list(self.axis)} is not an axis in {self.dim}D", remedy)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.point)

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        axis = np.asarray(self.axis or (0.0, 0.0, 1.0), float)
        x, y, z = axis / np.linalg.norm(axis)
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        angle, point = self.rate * time, np.asarray(self.point, float)
        turn = np.eye(3) + np.sin(angle) * cross + 2.0 * np.sin(0.5 * angle) ** 2 * (cross @ cross)
        rotation = turn[: self.dim, : self.dim]
        return Pose(rotation=rotation, shift=point - rotation @ point)


Motion = Still | Translation | Table | Turning


class Posed(Protocol):
    """Motion of a rigid shape."""

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PlacedShape:
    """Shape in a pose, with its distances and normals in space.

    Examples
    --------
    >>> from softway.obstacles.primitives import Sphere
    >>> ball = PlacedShape(shape=Sphere(centre=(0.0, 0.0), radius=1.0), pose=Translation(velocity=(2.0, 0.0)).at(1.0))
    >>> float(ball.gap(np.array([5.0, 4.0])).round(12)), ball.normal_at(np.array([5.0, 4.0])).round(12).tolist()
    (4.0, [0.6, 0.8])
    """

    shape: Shape
    pose: Pose

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return self.shape.dim

    def gap(self, x: Array) -> Array:
        """Distance (...,) of points (..., d) [m]; negative inside."""
        return self.shape.gap(self.pose.back(x))

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        return self.pose.turn(self.shape.normal_at(self.pose.back(x)))

    def gap_and_normal(self, x: Array) -> tuple[Array, Array]:
        """:meth:`gap` (...,) [m] and :meth:`normal_at` (..., d), with a single search on surfaces of facets."""
        gap, normal = _both(self.shape, self.pose.back(x))
        return gap, self.pose.turn(normal)


def carried_tool(motion: Posed, start: float, end: float, x: Array) -> Array:
    """Displacement (p, d) [m] between two times [s] of the material points of a tool that are at x (p, d) at the end.

    Examples
    --------
    >>> carried_tool(Turning(point=(0.0, 0.0), rate=np.pi / 2), 0.0, 1.0, np.array([[0.0, 1.0]])).round(12).tolist()
    [[-1.0, 1.0]]
    """
    before, after = motion.at(start), motion.at(end)
    turned = np.dot(after.back(x), (after.rotation - before.rotation).T)
    return np.asarray(turned + (after.shift - before.shift))


def _both(shape: Shape, x: Array) -> tuple[Array, Array]:
    """Gap (...,) and normal (..., d) at points (..., d)."""
    match shape:
        case Cavity():
            gap, normal = _both(shape.of, x)
            return -gap, -normal
        case Surface():
            return shape.facets.gap_and_normal(x)
        case Facets():
            return shape.gap_and_normal(x)
        case _:
            return shape.gap(x), shape.normal_at(x)


def _vector(where: str, value: tuple[float, ...] | float) -> Array:
    """Vector (d,) of one to three finite components."""
    vector = np.atleast_1d(np.asarray(value, float))
    if vector.ndim != 1 or not 1 <= len(vector) <= 3 or not np.isfinite(vector).all():
        raise InputError(where, f"{value!r} is not a vector", "1, 2 or 3 finite components")
    return vector
