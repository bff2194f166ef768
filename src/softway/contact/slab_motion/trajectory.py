"""Motion of all nodes inside a slab, with extra time nodes at touches and releases.

Without events the velocity is linear, ``v(tau) = v0 (1 - tau) + q tau`` with the unknown ``q = v1``, and

    u(tau) = u0 + h (v0 tau + (q - v0) tau^2 / 2),        u1 = base + (h/2) q.

A massless node moves at the constant rate ``q / 2``; the same formula for ``u1`` holds with ``base = u0``.
A touch at ``tau_c`` fixes the normal component on the obstacle; a release at ``tau_r`` frees it again from rest:

    n . (u1 - u0) = -gap0 + (1 - tau_r) (h/2) n . q.

A velocity jump ``J`` of every node at ``tau_c`` (the Impulse rule) adds ``h J (1/2 - tau_c)`` to ``u1``.

A prescribed velocity whose slope changes by ``s`` at ``tau_b`` adds ``s ((tau - tau_b)_+ - tau (1 - tau_b))`` to the
linear velocity, and ``-h s tau_b (1 - tau_b) / 2`` to ``u1``, the integral of the velocity (docs/theory/time/time.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactEvents:
    """Contact events of each row in a slab.

    Parameters
    ----------
    closed
        (m,) rows whose normal velocity is eliminated up to the end of the slab.
    touch
        (m,) instants tau_c; nan without a touch in this slab.
    speed, slope
        (m,) normal velocity at t0 [m/s] and its change over the slab [m/s], before the touch.
    release
        (m,) instants tau_r; nan without a release in this slab.
    """

    closed: BoolArray
    touch: Array
    speed: Array
    slope: Array
    release: Array

    @property
    def kinked(self) -> BoolArray:
        """Rows (m,) whose normal motion is not smooth."""
        return self.closed | np.isfinite(self.touch) | np.isfinite(self.release)

    @property
    def freedom(self) -> Array:
        """Fraction (m,) of the slab at its end in which a kinked row moves freely."""
        return np.where(np.isfinite(self.release) & ~self.closed, 1.0 - self.release, 0.0)

    @property
    def approach(self) -> Array:
        """Normal velocity (m,) just before the touch; zero without one [m/s]."""
        return np.where(np.isfinite(self.touch), self.speed + np.nan_to_num(self.touch) * self.slope, 0.0)


def contact_events(closed: BoolArray) -> ContactEvents:
    """Contact events of a slab without touch or release: closed rows stay closed, open rows stay open."""
    m = len(closed)
    none = np.full(m, np.nan)
    return ContactEvents(closed=closed, touch=none, speed=np.zeros(m), slope=np.zeros(m), release=none)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Trajectory:
    """Positions inside the slab as a function of the unknown q (n, d).

    Parameters
    ----------
    span
        h [s].
    start, velocity
        (n, d) displacement and velocity at t0.
    massive, free
        (n,) nodes with inertia; (n, d) components without support.
    rows, events
        Contact rows and their events.
    jumps
        Pairs (tau, J (n, d)) of velocity jumps of the field.
    bends
        Pairs (tau, s (n, d)) of bends of the prescribed velocities: changes of their slope [m/s per slab].
    """

    span: float
    start: Array
    velocity: Array
    massive: BoolArray
    free: BoolArray
    rows: ContactRows
    events: ContactEvents
    jumps: tuple[tuple[float, Array], ...] = ()
    bends: tuple[tuple[float, Array], ...] = ()

    def end(self, q: Array) -> Array:
        """Displacement (n, d) at the end of the slab."""
        return self.at(1.0, q)

    def at(self, tau: float, q: Array) -> Array:
        """Displacement (n, d) at ``tau``; the contact rows are those at the slab's end."""
        h, v, light = self.span, self.velocity, np.flatnonzero(~self.massive)
        rate = tau * v + 0.5 * tau**2 * (q - v) if tau != 1.0 else 0.5 * (v + q)
        rate[light] = 0.5 * tau * q[light]
        for instant, jump in self.jumps:
            rate += (max(tau - instant, 0.0) - 0.5 * tau**2) * jump
        for instant, slope in self.bends:
            rate += _bent(tau, instant) * slope
        rate *= h
        rate += self.start
        return self._kinked(rate, self._normal_motion(tau, q)) if self.events.kinked.any() else rate

    def mean(self, q: Array) -> Array:
        """Average displacement (n, d) over the slab, exact for every kink."""
        h, v = self.span, self.velocity
        rate = np.where(self.massive[:, None], v / 2.0 + (q - v) / 6.0, 0.25 * q)
        for instant, jump in self.jumps:
            rate = rate + (0.5 * (1.0 - instant) ** 2 - 1.0 / 6.0) * jump
        for instant, slope in self.bends:
            rate = rate + ((1.0 - instant) ** 3 - (1.0 - instant)) / 6.0 * slope
        smooth = self.start + h * rate
        return self._kinked(smooth, self._normal_mean(q)) if self.events.kinked.any() else smooth

    def _normal_motion(self, tau: float, q: Array) -> Array:
        """Normal motion n . (u(tau) - u0) of the kinked rows (m,)."""
        h, events = self.span, self.events
        gap = np.where(self.rows.near, self.rows.gap(self.start), 0.0)
        touch = np.where(np.isfinite(events.touch), events.touch, 0.0)
        before = h * (events.speed * tau + 0.5 * events.slope * tau**2)
        run = np.maximum(tau - np.nan_to_num(events.release, nan=1.0), 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            after = np.where(events.freedom > 0.0, 0.5 * h * self._leaving(q) * run**2 / events.freedom, 0.0)
        return np.where(tau < touch, before, -gap - self.rows.tool_motion * (1.0 - tau) + after)

    def _normal_mean(self, q: Array) -> Array:
        """Integral over tau of the normal motion (m,)."""
        h, events = self.span, self.events
        gap = np.where(self.rows.near, self.rows.gap(self.start), 0.0)
        c = np.where(np.isfinite(events.touch), events.touch, 0.0)
        return (
            h * (events.speed * c**2 / 2.0 + events.slope * c**3 / 6.0)
            - gap * (1.0 - c)
            - self.rows.tool_motion * 0.5 * (1.0 - c) ** 2
            + h * self._leaving(q) * events.freedom**2 / 6.0
        )

    def _leaving(self, q: Array) -> Array:
        """Normal velocity (m,) at the end, relative to a driven opponent [m/s]."""
        return self.rows.normal_component(q) - self.rows.tool_motion / self.span

    def _kinked(self, smooth: Array, normal: Array) -> Array:
        """Smooth motion with the normal components of the kinked rows replaced."""
        wanted = normal - self.rows.normal_component(smooth - self.start)
        return smooth + self.rows.motion(wanted, self.events.kinked, self.free)


def bent(bends: tuple[tuple[float, Array], ...], span: float) -> Array | float:
    """Displacement (n, d) in a slab of length ``span`` [s] beyond that of linear velocities [m]; zero without bends."""
    return span * sum((_bent(1.0, tau) * slope for tau, slope in bends), 0.0)


def _bent(tau: float, instant: float) -> float:
    """Integral up to ``tau`` of the velocity beyond the linear one, by a unit change of slope at ``instant``."""
    return 0.5 * (max(tau - instant, 0.0) ** 2 - tau**2 * (1.0 - instant))
