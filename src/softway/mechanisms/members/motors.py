"""Motors that prescribe the motion of a joint as a function of time."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.setup.motion_laws import MotionLaw, pieces
from softway.errors import InputError
from softway.units import Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Steady:
    """Motion at a constant rate.

    Parameters
    ----------
    rate
        Angular velocity of a hinge [rad/s] or velocity of a slider [m/s].

    Examples
    --------
    >>> Steady(rate=10.0).pieces[0, :3].tolist()
    [0.0, 0.0, 10.0]
    """

    rate: float

    def __post_init__(self) -> None:
        if not np.isfinite(self.rate):
            raise InputError("rate", f"{self.rate:g} is not finite", "radians or metres per second")

    @property
    def pieces(self) -> Array:
        """Pieces (q, 10) of the motion, see :func:`~softway.bodies.setup.motion_laws.pieces`."""
        return pieces(np.zeros(1), np.array([[0.0, self.rate]]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Polyline:
    """Motion through given values, linear in time between them; it stays at the last one.

    Parameters
    ----------
    times
        Increasing times [s], the first zero or less.
    values
        Angles [rad] or travels [m] at these times; the motion is their change since the start.

    Raises
    ------
    InputError
        If the tables do not fit.

    Examples
    --------
    >>> Polyline(times=(0.0, 2.0), values=(1.0, 4.0)).pieces[:, :3].tolist()
    [[0.0, 1.0, 1.5], [2.0, 4.0, 0.0]]
    """

    times: tuple[Second, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        _require_table(self.times, self.values, "values")

    @property
    def pieces(self) -> Array:
        """Pieces (q, 10) of the motion, see :func:`~softway.bodies.setup.motion_laws.pieces`."""
        time, value = np.array(self.times, float), np.array(self.values, float)
        rate = np.append(np.diff(value) / np.diff(time), 0.0)
        return pieces(time, np.stack([value, rate], axis=1))


Prescribed = Steady | Polyline | MotionLaw


@dataclass(frozen=True, slots=True, kw_only=True)
class Motor:
    """Motor with a prescribed motion: the angle of a hinge or the travel of a slider, from the start.

    Its torque or force is what the motion needs; its work is booked as work.

    Parameters
    ----------
    joint
        Name of a joint that turns about an axis or slides along one, but not both: the motion is that of its second
        body against the first, positive by the right-hand rule about the axis, or along it.
    motion
        Angle [rad] or travel [m] as a function of time: :class:`Steady`, :class:`Polyline`,
        :class:`~softway.bodies.RatePolyline`, or one of the smooth laws :class:`~softway.bodies.Sine`,
        :class:`~softway.bodies.Spline`, :class:`~softway.bodies.SmoothSteps` and :class:`~softway.bodies.Haversine`.

    Examples
    --------
    >>> Motor(joint="axle", motion=Steady(rate=10.0)).joint
    'axle'
    """

    joint: str
    motion: Prescribed


def _require_table(times: tuple[float, ...], values: tuple[float, ...], name: str) -> None:
    """Refuse a table without order, or whose columns differ in length."""
    if len(times) < 2 or len(values) != len(times):
        raise InputError(name, f"{len(values)} {name} at {len(times)} times", "as many as times, two or more")
    if not (np.isfinite(times).all() and np.isfinite(values).all()):
        raise InputError(name, "some are not finite", "finite numbers")
    if not (np.diff(times) > 0.0).all() or times[0] > 0.0:
        raise InputError("times", f"{times[:5]} do not increase from zero or before", "increasing times, the first 0")
