"""Supports of deformable solids: fixed, driven, guided, and carried by rigid bodies."""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from softway.bodies.setup.motion_laws import Travel, value_and_rate
from softway.errors import InputError
from softway.units import MetrePerSecond, Pure, Second

STRAIGHT = 1e-12
"""Change of the slope of a prescribed velocity over a slab, relative to the velocity, that is rounding."""

Direction = tuple[Pure, ...] | Literal["normal"]
"""Direction of a support; empty for components."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixed:
    """Support that keeps displacement components of the nodes of a tag at zero.

    Parameters
    ----------
    on
        Tag of the nodes.
    components
        Letters out of ``x``, ``y``, ``z``; or ``all``.
    direction
        Direction of any length along which the nodes are held, in place of components; they are free perpendicular to
        it.  ``normal``: that of the side, which the tag is of, at each node of the undeformed body.

    Examples
    --------
    A symmetry plane at 45 degrees to the axes:

    >>> Fixed(on="cut", direction=(1.0, -1.0)).components
    'all'
    """

    on: str
    components: str = "all"
    direction: Direction = ()

    def __post_init__(self) -> None:
        _check_direction(self.components, self.direction)


@dataclass(frozen=True, slots=True, kw_only=True)
class Driven:
    """Support that moves displacement components of the nodes of a tag with a given velocity.

    Parameters
    ----------
    on
        Tag of the nodes.
    components
        Letters out of ``x``, ``y``, ``z``; or ``all``.
    direction
        Direction of any length along which the nodes are moved, in place of components; they are free perpendicular to
        it.  ``normal``: that of the side, which the tag is of, at each node of the undeformed body.
    velocity
        Velocity of each of the components, or along the direction [m/s]; with ``times`` its values at these instants,
        linear in between and constant outside.
    times
        Increasing instants [s].

    Examples
    --------
    >>> ram = Driven(on="top", components="y", velocity=(0.0, -2.0), times=(0.0, 1.0))
    >>> ram.at(0.5)
    -1.0
    """

    on: str
    components: str = "all"
    velocity: tuple[MetrePerSecond, ...] | MetrePerSecond
    times: tuple[Second, ...] = ()
    direction: Direction = ()

    def __post_init__(self) -> None:
        _check_direction(self.components, self.direction)
        values = np.atleast_1d(np.asarray(self.velocity, float))
        times = np.asarray(self.times, float)
        if len(values) != max(len(times), 1) or not np.isfinite(values).all():
            raise InputError("velocity", f"{len(values)} values at {len(times)} times", "one for each of the times")
        if not (np.diff(times) > 0.0).all():
            raise InputError("times", f"{list(self.times)} do not increase", "increasing instants")

    @property
    def greatest_speed(self) -> float:
        """Greatest speed of a component at any time [m/s]."""
        return float(np.abs(self.velocity).max())

    def at(self, time: float) -> float:
        """Velocity at a time [m/s]."""
        if not isinstance(self.velocity, tuple) or not self.times:
            return float(np.ravel(self.velocity)[0])
        after = min(bisect_right(self.times, time), len(self.times) - 1)
        near = slice(max(after - 1, 0), after + 1)
        return float(np.interp(time, self.times[near], self.velocity[near]))

    def bends(self, start: float, end: float) -> tuple[tuple[float, float], ...]:
        """Bends of the velocity inside a slab: instants tau in (0, 1), and changes of its slope [m/s per slab].

        Examples
        --------
        >>> Driven(on="left", velocity=(0.0, 1.0, 0.0), times=(0.0, 0.5, 1.0)).bends(0.25, 0.75)
        ((0.5, -2.0),)
        """
        first, last = bisect_right(self.times, start), bisect_left(self.times, end)
        if first >= last:
            return ()
        tau = np.array([0.0, *((t - start) / (end - start) for t in self.times[first:last]), 1.0])
        values = np.array([self.at(start), *(self.at(t) for t in self.times[first:last]), self.at(end)])
        changes = np.diff(np.diff(values) / np.diff(tau))
        real = np.abs(changes) > STRAIGHT * np.abs(values).max()
        return tuple((float(t), float(c)) for t, c, bent in zip(tau[1:-1], changes, real, strict=True) if bent)


@dataclass(frozen=True, slots=True, kw_only=True)
class Guided:
    """Support that moves displacement components of the nodes of a tag by a smooth travel.

    Parameters
    ----------
    on
        Tag of the nodes.
    components
        Letters out of ``x``, ``y``, ``z``; or ``all``.
    direction
        Direction of any length along which the nodes are moved, in place of components; they are free perpendicular to
        it.  ``normal``: that of the side, which the tag is of, at each node of the undeformed body.
    travel
        Displacement of each of the components, or along the direction, since t = 0 [m] as a function of time.

    Examples
    --------
    >>> from softway.bodies.setup.motion_laws import SmoothSteps
    >>> ram = Guided(on="top", components="y", travel=SmoothSteps(times=(0.0, 2.0), points=(0.0, -1.0)))
    >>> ram.at(1.0), ram.greatest_speed
    (-0.9375, 0.9375)
    """

    on: str
    components: str = "all"
    travel: Travel
    direction: Direction = ()

    def __post_init__(self) -> None:
        _check_direction(self.components, self.direction)

    @property
    def greatest_speed(self) -> float:
        """Greatest speed of a component at any time [m/s]."""
        return self.travel.greatest_rate

    def at(self, time: float) -> float:
        """Velocity at a time [m/s]."""
        return value_and_rate(self.travel.pieces, time)[1]

    def bends(self, start: float, end: float) -> tuple[tuple[float, float], ...]:
        """Bend in the middle of a slab by which the integral of the velocity is the travel, see :meth:`Driven.bends`;
        none where the velocity is linear up to rounding.
        """
        (u0, v0), (u1, v1) = (value_and_rate(self.travel.pieces, t) for t in (start, end))
        mean = (u1 - u0) / (end - start)
        change = 4.0 * (v0 + v1) - 8.0 * mean
        return ((0.5, change),) if abs(change) > STRAIGHT * max(abs(v0), abs(v1), abs(mean)) else ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Carried:
    """Support that holds the nodes of a tag on a rigid body, which carries them: a weld of a solid to the body.

    Parameters
    ----------
    on
        Tag of the nodes.
    by
        Name of the rigid body.

    Examples
    --------
    >>> Carried(on="left", by="crank").components
    'all'
    """

    on: str
    by: str
    components: ClassVar[str] = "all"


def _check_direction(components: str, direction: Direction) -> None:
    """Refuse a direction without length, or besides components.

    Raises
    ------
    InputError
        With the key.
    """
    if not direction:
        return
    if components != "all":
        raise InputError("direction", f"a direction besides components = {components!r}", "one of the two")
    if direction != "normal" and not 0.0 < np.linalg.norm(np.asarray(direction, float)) < np.inf:
        raise InputError("direction", f"{list(direction)} is not a direction", "numbers that are not all zero")


Support = Fixed | Driven | Guided | Carried
