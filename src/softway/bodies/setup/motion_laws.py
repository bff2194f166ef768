"""Laws of motion: the travel or the angle of a driven support, a tool or a motor as a smooth function of time.

Every law is a row of pieces with closed forms of its value and its rate, so that a slab has the exact change of the
value.  The motion is the change of the value since t = 0.
"""

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.units import PerSecond, Radian, Second

LONG_AGO = -1e300
"""Time from which a law rests before its first instant [s]."""
SINE = slice(7, 10)
"""Columns of the sine in :func:`pieces`."""


def pieces(times: Array, powers: Array) -> Array:
    """Pieces (q, 10) of a polynomial law: the time [s] from which a piece counts, six coefficients of the powers of
    the time since then, and amplitude, angular frequency [rad/s] and phase of a sine in it, which is zero there.

    Parameters
    ----------
    times
        (q,) times.
    powers
        (q, k) coefficients of the powers 0, 1, ... of the time since then.
    """
    out = np.zeros((len(times), 10))
    out[:, 0] = times
    out[:, 1 : 1 + powers.shape[1]] = powers
    return out


def value_and_rate(law: Array, time: float) -> tuple[float, float]:
    """Value and rate of a law of these pieces (q, 10) at a time [s].

    Examples
    --------
    >>> value_and_rate(pieces(np.array([1.0]), np.array([[2.0, 3.0]])), 2.0)
    (5.0, 3.0)
    """
    piece = law[max(int(np.searchsorted(law[:, 0], time, side="right")) - 1, 0)]
    since, value, rate = time - piece[0], 0.0, 0.0
    for coefficient in piece[6:0:-1]:
        rate = rate * since + value
        value = value * since + coefficient
    size, often, phase = piece[SINE]
    value += size * (np.sin(often * since + phase) - np.sin(phase))
    return float(value), float(rate + size * often * np.cos(often * since + phase))


@dataclass(frozen=True, slots=True, kw_only=True)
class Spline:
    """Cubic spline through given points, at rest before the first and after the last.

    Parameters
    ----------
    times
        Increasing instants [s], two or more.
    points
        Travel [m] or angle [rad] at each instant.
    monotone
        False for continuous accelerations between the first and the last instant; the spline may overshoot them.
        True for no overshoot: between two points the motion never turns, and only the velocity is continuous.

    References
    ----------
    Fritsch, Butland (1984), A method for constructing local monotone piecewise cubic interpolants, SIAM J. Sci. Stat.
    Comput. 5, 300-304.

    Examples
    --------
    >>> press = Spline(times=(0.0, 1.0, 2.0), points=(0.0, -0.5, -1.0))
    >>> [value_and_rate(press.pieces, t)[0] for t in (-1.0, 1.0, 9.0)]
    [0.0, -0.5, -1.0]
    """

    times: tuple[Second, ...]
    points: tuple[float, ...]
    monotone: bool = False
    pieces: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        from scipy.interpolate import CubicHermiteSpline, CubicSpline, PchipInterpolator  # slow to load

        time, value = _points(self.times, self.points)
        if self.monotone:
            slope = PchipInterpolator(time, value).derivative()(time)
            slope[[0, -1]] = 0.0
            found = CubicHermiteSpline(time, value, slope)
        else:
            found = CubicSpline(time, value, bc_type="clamped")
        object.__setattr__(self, "pieces", _between_rests(time, value, np.asarray(found.c)[::-1].T))

    @property
    def greatest_rate(self) -> float:
        """Greatest magnitude of the rate."""
        inner, ends = self.pieces[1:-1], self.pieces[2:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = inner[:, 0] - inner[:, 3] / (3.0 * inner[:, 4])
        inside = np.where((turn > inner[:, 0]) & (turn < ends), turn, inner[:, 0])
        return max(abs(value_and_rate(self.pieces, float(t))[1]) for t in (*inner[:, 0], *inside))


@dataclass(frozen=True, slots=True, kw_only=True)
class SmoothSteps:
    """Smooth steps from point to point, with velocity and acceleration zero at each: ``s^3 (10 - 15 s + 6 s^2)``.

    Parameters
    ----------
    times
        Increasing instants [s], two or more; at rest before the first and after the last.
    points
        Travel [m] or angle [rad] at each instant.

    Examples
    --------
    >>> value_and_rate(SmoothSteps(times=(0.0, 2.0), points=(0.0, 1.0)).pieces, 1.0)
    (0.5, 0.9375)
    """

    times: tuple[Second, ...]
    points: tuple[float, ...]
    pieces: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        time, value = _points(self.times, self.points)
        rise, length, rest = np.diff(value), np.diff(time), np.zeros(len(time) - 1)
        powers = [value[:-1], rest, rest, 10.0 * rise / length**3, -15.0 * rise / length**4, 6.0 * rise / length**5]
        object.__setattr__(self, "pieces", _between_rests(time, value, np.stack(powers, axis=1)))

    @property
    def greatest_rate(self) -> float:
        """Greatest magnitude of the rate: 15/8 of the mean rate of a step."""
        return 1.875 * float(np.abs(np.diff(self.points) / np.diff(self.times)).max())


@dataclass(frozen=True, slots=True, kw_only=True)
class Sine:
    """Motion ``amplitude (sin(2 pi frequency t + phase) - sin(phase))``.

    Parameters
    ----------
    amplitude
        Amplitude of the travel [m] or the angle [rad].
    frequency
        Periods per second [1/s].
    phase
        Phase at the start [rad].

    Examples
    --------
    >>> round(value_and_rate(Sine(amplitude=0.1, frequency=2.0).pieces, 0.0)[1], 4)
    1.2566
    """

    amplitude: float
    frequency: PerSecond
    phase: Radian = 0.0
    pieces: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name in ("amplitude", "frequency", "phase"):
            if not np.isfinite(getattr(self, name)):
                raise InputError(name, f"{getattr(self, name):g} is not finite", "a finite number")
        law = pieces(np.zeros(1), np.zeros((1, 1)))
        law[0, SINE] = self.amplitude, 2.0 * np.pi * self.frequency, self.phase
        object.__setattr__(self, "pieces", law)

    @property
    def greatest_rate(self) -> float:
        """Greatest magnitude of the rate."""
        return abs(2.0 * np.pi * self.frequency * self.amplitude)


@dataclass(frozen=True, slots=True, kw_only=True)
class Haversine:
    """Pulse up and back: ``height (1 - cos(2 pi (t - start) / duration)) / 2``, at rest before and after it.

    Parameters
    ----------
    height
        Travel [m] or angle [rad] in the middle of the pulse.
    duration
        Length of the pulse [s].
    start
        Its start [s].

    Examples
    --------
    >>> pulse = Haversine(height=2.0, duration=1.0)
    >>> [round(value_and_rate(pulse.pieces, t)[0], 12) for t in (0.25, 0.5, 3.0)]
    [1.0, 2.0, 0.0]
    """

    height: float
    duration: Second
    start: Second = 0.0
    pieces: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not np.isfinite([self.height, self.start]).all():
            raise InputError("height", f"{self.height:g} at {self.start:g} s", "finite numbers")
        if not 0.0 < self.duration < np.inf:
            raise InputError("duration", f"{self.duration:g} s", "a positive time")
        law = pieces(np.array([LONG_AGO, self.start, self.start + self.duration]), np.zeros((3, 1)))
        law[1, SINE] = 0.5 * self.height, 2.0 * np.pi / self.duration, -0.5 * np.pi
        object.__setattr__(self, "pieces", law)

    @property
    def greatest_rate(self) -> float:
        """Greatest magnitude of the rate."""
        return float(np.pi * abs(self.height) / self.duration)


@dataclass(frozen=True, slots=True, kw_only=True)
class RatePolyline:
    """Motion with given rates, linear in time between them; the last rate stays.

    Parameters
    ----------
    times
        Increasing times [s], the first zero or less.
    rates
        Velocities [m/s] or angular velocities [rad/s] at these times.

    Raises
    ------
    InputError
        If the tables do not fit.

    Examples
    --------
    >>> RatePolyline(times=(0.0, 2.0), rates=(0.0, 4.0)).pieces[:, :4].tolist()
    [[0.0, 0.0, 0.0, 1.0], [2.0, 4.0, 4.0, 0.0]]
    """

    times: tuple[Second, ...]
    rates: tuple[Annotated[float, "*/s"], ...]
    pieces: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        time, rate = _points(self.times, self.rates, "rates")
        if time[0] > 0.0:
            raise InputError("times", f"{list(time)[:5]} do not increase from zero or before", "the first 0")
        length = np.diff(time)
        slope = np.append(np.diff(rate) / length, 0.0)
        value = np.append(0.0, np.cumsum(0.5 * length * (rate[1:] + rate[:-1])))
        object.__setattr__(self, "pieces", pieces(time, np.stack([value, rate, 0.5 * slope], axis=1)))

    @property
    def greatest_rate(self) -> float:
        """Greatest magnitude of the rate."""
        return float(np.abs(self.rates).max())


MotionLaw = Spline | SmoothSteps | Sine | Haversine | RatePolyline
Travel = Annotated[MotionLaw, "m"]
Turn = Annotated[MotionLaw, "rad"]


def _points(times: tuple[float, ...], points: tuple[float, ...], name: str = "points") -> tuple[Array, Array]:
    """Times and values (k,) as arrays.

    Raises
    ------
    InputError
        If they are less than two, differ in number, are not finite, or the times do not increase.
    """
    time, value = np.asarray(times, float), np.asarray(points, float)
    if len(time) < 2 or len(value) != len(time):
        raise InputError(name, f"{len(value)} {name} at {len(time)} times", "as many as times, two or more")
    if not (np.isfinite(time).all() and np.isfinite(value).all()):
        raise InputError(name, f"some {name} are not finite", "finite numbers")
    if not (np.diff(time) > 0.0).all():
        raise InputError("times", f"{list(times)[:5]} do not increase", "increasing instants")
    return time, value


def _between_rests(time: Array, value: Array, powers: Array) -> Array:
    """Pieces (k + 1, 10) with these powers (k - 1, p) between the points (k,), and rest before and after them."""
    out = pieces(np.array([LONG_AGO, *time]), np.zeros((len(time) + 1, 1)))
    out[0, 1], out[-1, 1] = value[0], value[-1]
    out[1:-1, 1 : 1 + powers.shape[1]] = powers
    return out
