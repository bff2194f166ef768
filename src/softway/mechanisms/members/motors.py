"""Motors that prescribe the motion of a joint as a function of time."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.units import Pure, Radian, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Steady:
    """Motion at a constant rate.

    Parameters
    ----------
    rate
        Angular velocity of a hinge [rad/s] or velocity of a slider [m/s].

    Examples
    --------
    >>> Steady(rate=10.0).knots().tolist()
    [[0.0, 0.0, 10.0, 0.0]]
    """

    rate: float

    def __post_init__(self) -> None:
        if not np.isfinite(self.rate):
            raise InputError("rate", f"{self.rate:g} is not finite", "radians or metres per second")

    def knots(self) -> Array:
        """Times, values, rates and accelerations (q, 4) from each time on."""
        return np.array([[0.0, 0.0, self.rate, 0.0]])


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
    >>> Polyline(times=(0.0, 2.0), values=(1.0, 4.0)).knots().tolist()
    [[0.0, 0.0, 1.5, 0.0], [2.0, 3.0, 0.0, 0.0]]
    """

    times: tuple[Second, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        _require_table(self.times, self.values, "values")

    def knots(self) -> Array:
        """Times, values, rates and accelerations (q, 4) from each time on."""
        time, value = np.array(self.times, float), np.array(self.values, float)
        rate = np.append(np.diff(value) / np.diff(time), 0.0)
        return np.stack([time, value - np.interp(0.0, time, value), rate, np.zeros(len(time))], axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class RatePolyline:
    """Motion with given rates, linear in time between them; the last rate stays.

    Parameters
    ----------
    times
        Increasing times [s], the first zero or less.
    rates
        Angular velocities [rad/s] or velocities [m/s] at these times.

    Raises
    ------
    InputError
        If the tables do not fit.

    Examples
    --------
    >>> RatePolyline(times=(0.0, 2.0), rates=(0.0, 4.0)).knots().tolist()
    [[0.0, 0.0, 0.0, 2.0], [2.0, 4.0, 4.0, 0.0]]
    """

    times: tuple[Second, ...]
    rates: tuple[float, ...]

    def __post_init__(self) -> None:
        _require_table(self.times, self.rates, "rates")

    def knots(self) -> Array:
        """Times, values, rates and accelerations (q, 4) from each time on."""
        time, rate = np.array(self.times, float), np.array(self.rates, float)
        length = np.diff(time)
        slope = np.append(np.diff(rate) / length, 0.0)
        value = np.append(0.0, np.cumsum(0.5 * length * (rate[1:] + rate[:-1])))
        k = int(np.searchsorted(time, 0.0, side="right")) - 1
        value -= value[k] - time[k] * (rate[k] - 0.5 * slope[k] * time[k])
        return np.stack([time, value, rate, slope], axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sine:
    """Motion ``amplitude (sin(2 pi frequency t + phase) - sin(phase))``.

    Parameters
    ----------
    amplitude
        Amplitude of the angle [rad] or the travel [m].
    frequency
        Periods per second [1/s].
    phase
        Phase at the start [rad].

    Examples
    --------
    >>> Sine(amplitude=0.1, frequency=2.0).wave()[1].round(4).item()
    12.5664
    """

    amplitude: float
    frequency: Pure
    phase: Radian = 0.0

    def __post_init__(self) -> None:
        for name in ("amplitude", "frequency", "phase"):
            if not np.isfinite(getattr(self, name)):
                raise InputError(name, f"{getattr(self, name):g} is not finite", "a finite number")

    def knots(self) -> Array:
        """Times, values, rates and accelerations (q, 4) of the rest of the motion: none."""
        return np.zeros((1, 4))

    def wave(self) -> Array:
        """Amplitude, angular frequency [rad/s] and phase."""
        return np.array([self.amplitude, 2.0 * np.pi * self.frequency, self.phase])


Prescribed = Steady | Polyline | RatePolyline | Sine


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
        Angle [rad] or travel [m] as a function of time: :class:`Steady`, :class:`Polyline`, :class:`RatePolyline` or
        :class:`Sine`.

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
