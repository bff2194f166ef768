"""March of a mechanism with stops: touches at instants inside a slab (time step), impacts, rest, release, friction.

A gap that closes inside a slab ends a part of the slab at that instant, and the impact follows there.  The impulses of
closed stops obey the laws of contact on places over the slab, and with those at its end on velocities
(docs/theory/mechanisms.md).
"""

import itertools
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError, NumericsError
from softway.kernels.rigid_contact.closed_stops import NEAR, NOISE, STILL
from softway.kernels.rigid_course.course import Course
from softway.kernels.rigid_course.stops import CHANGED, LOST, TOUCH, fly_rows
from softway.mechanisms.contacts.slipping import jammed, next_change, tell_sliding
from softway.mechanisms.contacts.stop_rows import Stops, lost_velocities
from softway.mechanisms.members.stops import Impacts, Restitution, StopEvent

ROUNDED = 1e-15
"""Velocity relative to that of the extent in a slab that is rounding."""
SHORT = 1e-4
"""Flight between two touches of a stop, relative to the slab, below which it comes to rest."""
BLOWS = 10_000
"""Greatest number of blows of a sequential impact."""
LOCATED = 128
"""Number of touches in a slab that are located; further ones act at its end."""
HALVINGS = 50
"""Halvings of a length in the search for one at which no gap is negative, or that can be solved."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StopMarch:
    """March of a mechanism with stops from one state to the next.

    Parameters
    ----------
    stops
        The stops in the present state.
    law
        Law of impacts at several stops at once.
    restitution
        What the coefficients of restitution are ratios of.
    touched
        (s,) instants of the last touches [s].
    """

    stops: Stops
    law: Impacts
    restitution: Restitution
    touched: Array

    @property
    def closed(self) -> tuple[str, ...]:
        """Names of the closed stops."""
        return tuple(name for name, shut in zip(self.stops.names, self.stops.closed, strict=True) if shut)

    @property
    def changing(self) -> dict[str, Array | IntArray | BoolArray]:
        """Arrays that the march changes, by name."""
        flags = {name: getattr(self.stops, name) for name in ("closed", "sliding", "turning", "told")}
        return {**flags, "touched": self.touched}

    def start(self, h: float, extent: float, impacts: bool = True) -> list[StopEvent]:
        """Close the stops that are touched at the start, with an impact if bodies approach there; its events.

        Without ``impacts`` such stops stay open, and are struck in the slab that follows.
        """
        gaps, events = self.stops.at_state(), list[StopEvent]()
        for k in np.flatnonzero(gaps < -NEAR * extent):
            problem = f"is overlapped by {-gaps[k]:.3g} m at the start"
            raise InputError(f"stops.{self.stops.names[k]}", problem, "places with a gap of zero or more")
        touching = gaps <= NEAR * extent
        if not impacts:
            touching &= self.stops.speeds() >= -NOISE * extent / h
        if touching.any():
            self._impact(0.0, h, touching, extent, events)
        self.stops.see_sliding(NOISE * extent / h)
        tell_sliding(self.stops, 0.0, events)
        return events

    def flown(
        self, table: Course, h: float, begin: int, first: int, total: int, events: list[list[StopEvent]]
    ) -> tuple[int, NumericsError | None]:
        """March slabs without touches, into the rows of a table and ``events``: the first left, and what it raises."""
        stops, end = self.stops, CHANGED
        while end == CHANGED and first < total:
            closed = stops.closed.copy()
            first, end = fly_rows(*stops.tables, stops.table, table, stops.it.extent, h, first, total)
            for k in np.flatnonzero(closed & ~stops.closed):
                one = StopEvent(time=(begin + first - 1) * h, stop=stops.names[k], kind="release")
                events[(first - 1) // table.every].append(one)
        return first, lost_velocities((begin + first) * h) if end == LOST else None

    def slab(self, time: float, h: float, extent: float, told: Array) -> tuple[list[StopEvent], int]:
        """March a slab of length h: its events, and the number of iterations."""
        events: list[StopEvent] = []
        self.stops.spent[:] = self.stops.shut[:] = 0.0
        left, iterations = h, 0
        for touches in itertools.count():
            if touches < LOCATED:
                span, touching, used = self._flown(time + h - left, left, h, extent, told, events)
            else:
                span, used = self._through(time + h - left, left, extent, told, events)
                touching = np.zeros(len(self.stops.rows), bool)
            left, iterations = left - span, iterations + used
            if touching.any():
                self._impact(time + h - left, h, touching, extent, events)
            if left <= 1e-14 * h:
                break
        return events, iterations

    def _flown(
        self, time: float, left: float, h: float, extent: float, told: Array, events: list[StopEvent]
    ) -> tuple[float, BoolArray, int]:
        """Take a part of the slab up to the next touch: its length, the touching stops, and the iterations."""
        stops, iterations, change = self.stops, 0, None
        jamming, begun = jammed(stops), np.zeros(len(stops.rows), bool)
        before = stops.slips() if stops.located.any() else np.zeros(0)
        while True:
            span, used = self._up_to_touch(time, left, extent)
            iterations += used
            if span == 0.0:
                return 0.0, ~stops.closed & (stops.at_state() <= NEAR * extent), iterations
            if not (stops.located & stops.closed).any():
                break
            change = next_change(stops, before, begun, span, h, extent)
            iterations += change.iterations
            if change.span > 0.0:
                span = change.span
                break
        tell_sliding(stops, time, events)
        touching = ~stops.closed & (np.abs(stops.gaps()) <= NEAR * extent) & (span < left)
        closed = stops.taken(time, span, extent, told, np.zeros(len(stops.rows)))
        if change is not None:
            stops.sliding[change.ending], stops.sliding[change.starting] = False, True
        for k in jamming[~stops.sliding[jamming]]:
            events.append(StopEvent(time=float(time), stop=stops.names[k], kind="jam"))
        self._close(closed, time, events)
        return span, touching, iterations

    def _up_to_touch(self, time: float, left: float, extent: float) -> tuple[float, int]:
        """Solve a part of the slab up to the next touch: its length, zero if that is at once, and the iterations."""
        span, iterations = left, 0
        for _ in range(HALVINGS):
            used = self.stops.tried(span, extent)
            iterations += used
            if used:
                break
            span *= 0.5
        else:
            raise NumericsError(f"a slab of {span:.3g} s has no solution", time, "a shorter step")
        if not (self.stops.gaps()[~self.stops.closed] < -TOUCH * extent).any():
            return span, iterations
        found = self._first_touch(span, extent)
        return (0.0, iterations) if found is None else (found[0], iterations + found[1])

    def _close(self, closed: BoolArray, time: float, events: list[StopEvent]) -> None:
        """Close these stops (s,), and release the others."""
        for k in np.flatnonzero(self.stops.closed & ~closed):
            events.append(StopEvent(time=float(time), stop=self.stops.names[k], kind="release"))
        self.stops.closed[:] = closed
        self.stops.hold()

    def _first_touch(self, span: float, extent: float) -> tuple[float, int] | None:
        """Length at which the first gap closes, with its solution in the work space; None if none opens before."""
        kept, counted = self.stops.it.motion.impulse / span, [0]

        def least(length: float) -> float:
            self.stops.it.motion.impulse[:] = kept * length
            used = self.stops.tried(length, extent)
            counted[0] += used
            return float(self.stops.gaps()[~self.stops.closed].min()) if used else -np.inf

        from scipy.optimize import brentq  # slow to load

        low, high = 0.5 * span, span
        for _ in range(HALVINGS):
            if least(low) > 0.0:
                break
            low, high = 0.5 * low, low
        else:
            return None
        if least(high) >= 0.0:
            return high, counted[0]
        # where friction is not unique, gaps may jump by rounding: then any length between is as good
        length = float(brentq(least, low, high, xtol=1e-15 * high, rtol=1e-15, disp=False))
        least(length)
        return length, counted[0]

    def _through(
        self, time: float, left: float, extent: float, told: Array, events: list[StopEvent]
    ) -> tuple[float, int]:
        """Take a part of the slab with touches that are not located: they act on its end; its length, and iterations.

        They have no friction within it, since their impulse is up to twice that of the touch.
        """
        gaps, span, iterations = self.stops.at_state(), left, 0
        before = self.stops.speeds()
        closed = self.stops.closed.copy()
        for _ in range(HALVINGS):
            self.stops.closed[:] = closed
            used = self.stops.tried(span, extent)
            iterations += used
            free = 2.0 * (self.stops.gaps() - gaps) / span - before
            while used and (more := ~self.stops.closed & (self.stops.gaps() < -TOUCH * extent)).any():
                self.stops.closed[:] |= more
                used = self.stops.tried(span, extent, smooth=self.stops.closed & ~closed)
                iterations += used
            if used:
                break
            span *= 0.5
        else:
            raise NumericsError(f"a slab of {span:.3g} s has no solution", time, "a shorter step")
        hits = self.stops.closed & ~closed
        self.stops.sliding[hits] = True  # what they take is dissipated
        speed = np.sqrt(np.maximum(before**2 + 2.0 * gaps * (before - free) / span, 0.0))
        rebound = np.where(
            hits & (self.stops.restitution * speed > 0.5 * (before - free)), self.stops.restitution * speed, 0.0
        )
        after = self.stops.taken(time, span, extent, told, rebound)
        for k in np.flatnonzero(hits):
            one = StopEvent(time=float(time + span), stop=self.stops.names[k], kind="touch", located=False)
            events.append(replace(one, velocity_before=-float(speed[k]), velocity_after=float(rebound[k])))
        self.stops.closed[:] = after
        self.stops.hold()
        return span, iterations

    def _impact(self, time: float, h: float, touching: BoolArray, extent: float, events: list[StopEvent]) -> None:
        """Impact of the touching stops, with those that are closed."""
        before, excess = self.stops.speeds(), self.stops.excess()
        hits = touching & (before < 0.0)
        resting = hits & (time - self.touched < SHORT * h) & (self.stops.restitution < 1.0)
        ratio = np.where(resting, 0.0, self.stops.restitution)
        impulse = np.zeros(len(self.stops.rows))
        if not self._struck(touching, hits, ratio, extent / h, impulse):
            names = ", ".join(self.stops.names[k] for k in np.flatnonzero(self.stops.closed | touching))
            raise NumericsError(f"the impact of {names} has no solution", time, "less friction, or sequential impacts")
        after = self.stops.speeds()
        for k in np.flatnonzero(hits):
            e = self.stops.restitution[k]
            end = (time - self.touched[k]) * e / (1.0 - e) if resting[k] else 0.0
            kind: Literal["touch", "rest"] = "rest" if resting[k] else "touch"
            one = StopEvent(time=float(time + end), stop=self.stops.names[k], kind=kind, impulse=float(impulse[k]))
            events.append(replace(one, velocity_before=float(before[k]), velocity_after=float(after[k])))
            self.touched[k] = time
        self._close((self.stops.closed | touching) & (np.abs(after) <= _still(before, extent / h)), time, events)
        self.stops.lose(excess - self.stops.excess(), impulse)
        self.stops.see_sliding(NOISE * extent / h)
        self.stops.it.motion.impulse[self.stops.rows.ravel()] = 0.0

    def _struck(self, touching: BoolArray, hits: BoolArray, ratio: Array, rounding: float, impulse: Array) -> bool:
        """Impact by the law of the mechanism; False if it has no solution.

        Closed stops at rest that do not stay so have the friction of sliding ones.
        """
        stops, motion, before = self.stops, self.stops.it.motion, self.stops.speeds()
        changed = (motion.velocity, motion.spin, motion.energy, motion.work)
        kept = [array.copy() for array in changed]
        for _ in range(len(stops.rows) + 1):
            if self.law == "simultaneous":
                near = stops.closed | touching
                solved = self._blow(near, np.where(hits, ratio, 0.0), before, rounding, impulse)
            else:
                solved = self._sequential(touching, ratio, rounding, impulse)
            slipping = np.linalg.norm(stops.slips(), axis=1) > NOISE * rounding
            slipping &= stops.located & stops.closed & ~stops.sliding
            if not slipping.any():
                break
            stops.sliding[slipping], impulse[:] = True, 0.0
            for array, old in zip(changed, kept, strict=True):
                array[:] = old
        return solved

    def _blow(self, these: BoolArray, ratio: Array, before: Array, rounding: float, impulse: Array) -> bool:
        """Impact at some stops (s,) at once with the velocities ``before`` (s,); False if it has no solution."""
        if self.restitution == "Poisson":
            return self.stops.compress_and_expand(these, ratio, rounding, impulse)
        return self.stops.collide(these, -ratio * before, 0.0 * ratio, rounding, impulse)

    def _sequential(self, touching: BoolArray, ratio: Array, rounding: float, impulse: Array) -> bool:
        """One stop after the other, each time that with the greatest velocity of approach."""
        near, still = self.stops.closed | touching, _still(self.stops.speeds(), rounding)
        for _ in range(BLOWS):
            speed = np.where(near, self.stops.speeds(), 0.0)
            k = int(np.argmin(speed))
            if speed[k] >= -still:
                return True
            if not self._blow(np.arange(len(self.stops.rows)) == k, ratio, speed, rounding, impulse):
                return False
        return False


def _still(speed: Array, rounding: float) -> float:
    """Velocity [m/s] that is none, beside velocities (s,) and the one that rounds places."""
    return max(STILL * float(np.abs(speed).max()), ROUNDED * rounding)
