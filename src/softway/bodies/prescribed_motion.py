"""Prescribed motion of rigid tools: pose of a shape at any time, and displacement of its material points."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.arrays import Array
from softway.bodies.setup.pose import Pose as Pose
from softway.bodies.setup.pose import require_axis, turned_about, vector
from softway.bodies.setup.smooth_motions import Sliding as Sliding
from softway.bodies.setup.smooth_motions import Swinging as Swinging
from softway.errors import InputError
from softway.obstacles.primitives import Cavity, Shape
from softway.obstacles.triangulated import Facets, Surface
from softway.units import Metre, MetrePerSecond, Pure, RadianPerSecond, Second


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
        vector("velocity", self.velocity)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return np.size(self.velocity)

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        return Pose(rotation=np.array(1.0), shift=time * vector("velocity", self.velocity))


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
        sizes = {len(vector(f"displacements[{k}]", row)) for k, row in enumerate(rows)}
        if len(sizes) > 1:
            raise InputError("displacements", f"vectors of {sorted(sizes)} components", "vectors of equal length")

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return np.size(self.displacements[0])

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        after = min(bisect_right(self.times, time), len(self.times) - 1)
        before = max(after - 1, 0)
        first, last = (np.atleast_1d(np.asarray(self.displacements[k], float)) for k in (before, after))
        share = np.interp(time, (self.times[before], self.times[after]), (0.0, 1.0)) if after > before else 0.0
        return Pose(rotation=np.array(1.0), shift=(1.0 - share) * first + share * last)


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
        require_axis(self.point, self.axis)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return len(self.point)

    def at(self, time: float) -> Pose:
        """Pose at a time [s]."""
        return turned_about(self.point, self.axis, self.rate * time)


Motion = Still | Translation | Table | Turning | Sliding | Swinging


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
