"""Exact motion of a uniform elastic bar whose tip hits a rigid stop, by the method of characteristics.

The bar occupies 0 <= s <= L, with s measured from the tip. The displacement u(s, t) is positive towards the stop, which
the tip reaches at u = gap:

    u_tt = c^2 u_ss + g,     c^2 = E / rho.

In the uniformly accelerated frame, v = p + q and c u_s = p - q, where the wave p travels to the tip and the wave q
leaves it. With Z = rho c A:

- far end: q returns as p = k q, with k = +1 (free) or -1 (fixed); p at the tip repeats q after the round trip 2L/c;
- open tip: no force, q = p;
- closed tip: no velocity, q = -p - g t, and the stop pushes with N = Z (p - q) = Z (2 p + g t), which must stay >= 0.

The wave p(t) that arrives at the tip is therefore the whole solution: the state of the bar at time t is p on [t, t +
2L/c]. If the initial data are piecewise linear, p is piecewise linear too. On each piece the displacement of the tip is
quadratic and the force linear, so touch and release are roots of polynomials of degree two and one.
"""

from collections import deque
from dataclasses import dataclass
from math import inf, nan, sqrt

import numpy as np

from softway.apps.verify.exact.pieces import Piece, Profile, Same, cut, on
from softway.apps.verify.exact.waves import Wave, joined
from softway.arrays import Array

ROUND = 1e-11  # rounding tolerance, relative to the round trip, its displacement, or the largest force


@dataclass(frozen=True, slots=True, kw_only=True)
class Bar:
    """Bar with its initial state.

    Parameters
    ----------
    length, youngs, density, area
        L [m], E [Pa], rho [kg/m^3], A [m^2].
    gap
        Distance from the reference position of the tip to the stop [m].
    far
        Condition at the far end: ``free`` or ``fixed``.
    acceleration
        Uniform body acceleration g towards the stop [m/s^2]; only with a free far end.
    velocity, strain
        Initial v(s) [m/s] and u_s(s) as (s0, s1, value at s0, value at s1), which cover [0, L].
    tip
        Initial displacement of the tip [m].
    """

    length: float = 1.0
    youngs: float = 1.0
    density: float = 1.0
    area: float = 1.0
    gap: float = inf
    far: str = "free"
    acceleration: float = 0.0
    velocity: Profile = ((0.0, 1.0, 0.0, 0.0),)
    strain: Profile = ((0.0, 1.0, 0.0, 0.0),)
    tip: float = 0.0

    def __post_init__(self) -> None:
        if self.far not in ("free", "fixed") or (self.far == "fixed" and self.acceleration != 0.0):
            raise ValueError("the far end must be free or fixed, and an acceleration needs a free end")

    @property
    def speed(self) -> float:
        """Wave speed c [m/s]."""
        return sqrt(self.youngs / self.density)

    @property
    def impedance(self) -> float:
        """Z = rho c A [kg/s]."""
        return self.density * self.speed * self.area

    @property
    def trip(self) -> float:
        """Round trip 2L/c [s]."""
        return 2.0 * self.length / self.speed

    @property
    def echo(self) -> float:
        """Reflection factor k at the far end."""
        return 1.0 if self.far == "free" else -1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Touch:
    """Interval of contact; ``release`` is nan if it has not ended.

    ``speed`` is the velocity that the tip would have just after the touch without the stop [m/s].
    """

    start: float
    release: float
    speed: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Solution of :func:`solve`: the wave arriving at the tip, the wave leaving it, and the contacts."""

    bar: Bar
    arriving: Wave
    leaving: Wave
    touches: tuple[Touch, ...]
    until: float

    def tip(self, t: float | Array) -> Array:
        """Displacement of the tip [m]."""
        return self.displacement(0.0, t)

    def displacement(self, s: float | Array, t: float | Array) -> Array:
        """Displacement of the point s [m]."""
        b, t, d = self.bar, np.asarray(t, float), np.asarray(s, float) / self.bar.speed
        here = self.arriving.integral(t + d) - self.arriving.integral(d)
        return _start(b, s) + 0.5 * b.acceleration * t**2 + here + self._left(t - d) - self._left(-d)

    def _left(self, t: Array) -> Array:
        """Integral of the wave leaving the tip; before t = 0, of the initial wave, which arrives later as an echo."""
        trip, heard = self.bar.trip, self.arriving.integral
        initial = self.bar.echo * (heard(trip + np.minimum(t, 0.0)) - heard(trip))
        return np.where(t < 0.0, initial, self.leaving.integral(np.maximum(t, 0.0)))

    def velocity(self, s: float | Array, t: float) -> Array:
        """Velocity of the point s, limit from the right [m/s]."""
        p, q = self._pair(s, t)
        return p + q + self.bar.acceleration * t

    def strain(self, s: float | Array, t: float) -> Array:
        """Strain u_s of the point s, positive in compression, limit from the right."""
        p, q = self._pair(s, t)
        return (p - q) / self.bar.speed

    def _pair(self, s: float | Array, t: float) -> tuple[Array, Array]:
        d = np.asarray(s, float) / self.bar.speed
        initial = self.bar.echo * self.arriving(np.minimum(t - d, 0.0) + self.bar.trip)
        return self.arriving(t + d), np.where(t < d, initial, self.leaving(np.maximum(t - d, 0.0)))

    def force(self, t: float, side: int = +1) -> float:
        """Force of the stop on the tip, >= 0 [N]; limit from the right (+1) or from the left (-1)."""
        for touch in self.touches:
            end = self.until if np.isnan(touch.release) else touch.release
            if touch.start <= t < end or (side < 0 and touch.start < t <= end):
                return self.bar.impedance * float(2.0 * self.arriving(t, side) + self.bar.acceleration * t)
        return 0.0

    def impulse(self, t: float) -> float:
        """Impulse of the stop up to time t [N s]."""
        total = 0.0
        for touch in self.touches:
            a, b = touch.start, min(t, self.until if np.isnan(touch.release) else touch.release)
            if b > a:
                wave = 2.0 * float(self.arriving.integral(b) - self.arriving.integral(a))
                total += self.bar.impedance * (wave + 0.5 * self.bar.acceleration * (b**2 - a**2))
        return total

    def momentum(self, t: float) -> float:
        """Momentum towards the stop [kg m/s], from the waves in a bar with a free far end."""
        b = self.bar
        waves = b.impedance * float(self.arriving.integral(t + b.trip) - self.arriving.integral(t))
        return waves + b.density * b.area * b.length * b.acceleration * t

    def centre(self, t: float) -> float:
        """Displacement of the centre of mass since the start [m], with a free far end."""
        b, twice = self.bar, self.arriving.double
        waves = float(twice(t + b.trip) - twice(b.trip) - twice(t))
        return b.impedance * waves / _mass(b) + 0.5 * b.acceleration * t**2

    def energy(self, t: float) -> float:
        """Kinetic and strain energy minus the work of the body acceleration since the start [J]."""
        b, drift = self.bar, self.bar.acceleration * t
        waves = b.impedance * self.arriving.square(t, t + b.trip)
        if b.acceleration == 0.0:
            return waves
        carried = drift * (self.momentum(t) - 0.5 * _mass(b) * drift)
        return waves + carried - _mass(b) * b.acceleration * self.centre(t)


def solve(bar: Bar, until: float) -> Motion:
    """Follow the wave arriving at the tip, piece by piece, up to the time ``until``.

    >>> thrown = solve(Bar(velocity=((0.0, 1.0, 1.0, 1.0),), gap=0.3), until=4.0)
    >>> [(round(x.start, 12), round(x.release, 12), x.speed) for x in thrown.touches]
    [(0.3, 2.3, 1.0)]
    """
    queue = deque(_initial(bar))
    heard, left = list(queue), list[Piece]()
    touches: list[Touch] = []
    t, u, closed, largest = 0.0, bar.tip, False, max(max(abs(p0), abs(p1)) for _, _, p0, p1 in heard)
    while t < until:
        piece = queue.popleft()
        largest = max(largest, abs(piece[2]), abs(piece[3]), abs(bar.acceleration) * piece[1])
        same = Same(time=ROUND * bar.trip, velocity=ROUND * largest, displacement=ROUND * largest * bar.trip)
        if _switches(bar, piece, u, closed, same):
            closed = not closed
            u = bar.gap
            touches = (
                [*touches, Touch(start=t, release=nan, speed=_motion(bar, piece)[0])]
                if closed
                else _released(touches, t)
            )
        x = _root(bar, piece, u, closed, same)
        if x is not None and x <= same.time:
            u = bar.gap
            queue.appendleft(piece)
            continue
        used, rest = cut(piece, x, same)
        if rest is not None:
            queue.appendleft(rest)
        v, dv = _motion(bar, used)
        t, span = used[1], used[1] - used[0]
        meets = not closed and x is not None and x <= span + same.time
        u = bar.gap if closed or meets else u + v * span + 0.5 * dv * span**2
        out = _reflected(bar, used, closed)
        left.append(out)
        echo = (out[0] + bar.trip, out[1] + bar.trip, bar.echo * out[2], bar.echo * out[3])
        queue.append(echo)
        heard.append(echo)
    return Motion(bar=bar, arriving=joined(heard), leaving=joined(left), touches=tuple(touches), until=until)


def _initial(bar: Bar) -> list[Piece]:
    """Waves of the initial data, in the order of their arrival at the tip."""
    c, k, length = bar.speed, bar.echo, bar.length
    knots = sorted({s for profile in (bar.velocity, bar.strain) for part in profile for s in part[:2]})
    direct, echoed = list[Piece](), list[Piece]()
    for a, b in zip(knots[:-1], knots[1:], strict=True):
        (va, vb), (ea, eb) = on(bar.velocity, a, b), on(bar.strain, a, b)
        direct.append((a / c, b / c, 0.5 * (va + c * ea), 0.5 * (vb + c * eb)))
        echoed.insert(0, ((2 * length - b) / c, (2 * length - a) / c, 0.5 * k * (vb - c * eb), 0.5 * k * (va - c * ea)))
    return direct + echoed


def _start(bar: Bar, s: float | Array) -> Array:
    """Initial displacement of the point s [m]."""
    total = np.full(np.shape(s), bar.tip)
    for s0, s1, f0, f1 in bar.strain:
        x = np.clip(s, s0, s1) - s0
        total = total + f0 * x + 0.5 * (f1 - f0) / (s1 - s0) * x**2
    return total


def _motion(bar: Bar, piece: Piece) -> tuple[float, float]:
    """2 p + g t at the start of a piece, and its slope: velocity of an open tip, or force / Z on a closed tip."""
    a, b, p0, p1 = piece
    return 2.0 * p0 + bar.acceleration * a, 2.0 * (p1 - p0) / (b - a) + bar.acceleration


def _switches(bar: Bar, piece: Piece, u: float, closed: bool, same: Same) -> bool:
    """True if the contact changes at the start of a piece: an open tip closes, or a closed tip would be pulled."""
    v, dv = _motion(bar, piece)
    change = dv * (piece[1] - piece[0])
    if closed:
        return v < -same.velocity or (v <= same.velocity and change < -same.velocity)
    comes = v > same.velocity or (v >= -same.velocity and change > same.velocity)
    return comes and u >= bar.gap - same.displacement


def _root(bar: Bar, piece: Piece, u: float, closed: bool, same: Same) -> float | None:
    """Time since the start of a piece when an open tip reaches the stop, or the force on a closed tip ends."""
    v, dv = _motion(bar, piece)
    if closed:
        return -v / dv if dv < 0.0 and v > same.velocity else None
    way = max(bar.gap - u, 0.0)
    square = v**2 + 2.0 * dv * way
    if square <= 0.0 or way == inf:
        return None
    if v > 0.0:
        return 2.0 * way / (v + sqrt(square))
    return (sqrt(square) - v) / dv if dv > 0.0 else None


def _reflected(bar: Bar, piece: Piece, closed: bool) -> Piece:
    """Wave that leaves the tip while a piece arrives."""
    a, b, p0, p1 = piece
    g = bar.acceleration
    return (a, b, -p0 - g * a, -p1 - g * b) if closed else piece


def _released(touches: list[Touch], t: float) -> list[Touch]:
    last = touches[-1]
    return [*touches[:-1], Touch(start=last.start, release=t, speed=last.speed)]


def _mass(bar: Bar) -> float:
    return bar.density * bar.area * bar.length
