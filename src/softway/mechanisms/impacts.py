"""March of a mechanism with stops: touches at instants inside a slab (time step), impacts, rest, and release.

A gap that closes inside a slab ends a part of the slab at that instant, and the impact follows there.  Without friction
the impulses of closed stops do no work (docs/theory/mechanisms.md).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError, NumericsError
from softway.kernels.multibody.energy import kinetic_energy
from softway.kernels.multibody.slab import end_slab, push_rows, refactor, row_velocities, try_slab
from softway.kernels.multibody.tables import Space
from softway.mechanisms.arrays import Arrays
from softway.mechanisms.members.stops import Impacts, StopEvent

TOUCH = 1e-14
"""Gap relative to the extent that is rounding."""
NEAR = 1e-10
"""Gap relative to the extent at which a stop takes part in an impact."""
STILL = 1e-9
"""Velocity relative to the greatest at which a stop is closed after an impact."""
SHORT = 1e-4
"""Flight between two touches of a stop, relative to the slab, below which it comes to rest."""
PULL = 1e-13
"""Pull of a stop, relative to the greatest impulse or momentum, that is rounding."""
ROUNDING = 4e-15
"""Rounding error of a place relative to the extent, over half a slab."""
EXCHANGES = 50
"""Greatest number of exchanges of active stops in a slab or an impact."""
BLOWS = 10_000
"""Greatest number of blows of a sequential impact, and of touches in a slab."""
HALVINGS = 50
"""Halvings of a length in the search for one at which no gap is negative, or that can be solved."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StopMarch:
    """March of a mechanism with stops from one state to the next.

    Parameters
    ----------
    it, room
        Arrays of the mechanism, and work space.
    rows, sign, restitution
        (s,) rows of the stops in the table of the joints, signs of their gaps, and coefficients of restitution.
    names
        Names of the stops.
    law
        Law of impacts at several stops at once.
    held
        (g,) groups that the ground holds by joints.
    closed
        (s,) stops that are closed.
    touched
        (s,) instants of the last touches [s].
    """

    it: Arrays
    room: Space
    rows: IntArray
    sign: Array
    restitution: Array
    names: tuple[str, ...]
    law: Impacts
    held: IntArray
    closed: BoolArray
    touched: Array

    def start(self, h: float, extent: float) -> list[StopEvent]:
        """Close the stops that are touched at the start, with an impact if bodies approach there; its events."""
        gaps, events = self._at_state(), list[StopEvent]()
        for k in np.flatnonzero(gaps < -NEAR * extent):
            problem = f"is overlapped by {-gaps[k]:.3g} m at the start"
            raise InputError(f"stops.{self.names[k]}", problem, "places with a gap of zero or more")
        touching = gaps <= NEAR * extent
        if touching.any():
            self._impact(0.0, h, touching, extent, events)
        return events

    def slab(self, time: float, h: float, extent: float, told: Array) -> tuple[list[StopEvent], int]:
        """March a slab of length h: its events, and the number of iterations."""
        events: list[StopEvent] = []
        left, iterations = h, 0
        for _ in range(BLOWS):
            span, touching, used = self._flown(time + h - left, left, extent, told, events)
            left, iterations = left - span, iterations + used
            if touching.any():
                self._impact(time + h - left, h, touching, extent, events)
            if left <= 1e-14 * h:
                return events, iterations
        raise NumericsError(
            f"more than {BLOWS} touches in a slab of {h:.3g} s", time, "less restitution, or a shorter step"
        )

    def _flown(
        self, time: float, left: float, extent: float, told: Array, events: list[StopEvent]
    ) -> tuple[float, BoolArray, int]:
        """Take a part of the slab up to the next touch: its length, the touching stops, and the iterations."""
        span, iterations, none = left, 0, np.zeros(len(self.rows), bool)
        for _ in range(HALVINGS):
            closed, used = self._closed_in(span, extent)
            iterations += used
            if closed is not None:
                break
            span *= 0.5
        else:
            raise NumericsError(f"a slab of {span:.3g} s has no solution", time, "a shorter step")
        tolerance = TOUCH * extent
        if (self._gaps()[~self.closed] < -tolerance).any():
            found = self._first_touch(span, extent)
            if found is None:
                return 0.0, ~self.closed & (self._at_state() <= NEAR * extent), iterations
            span, used = found
            iterations += used
        touching = ~self.closed & (np.abs(self._gaps()) <= NEAR * extent) if span < left else none
        end_slab(self.it.bodies, self.it.joints, self.it.springs, self.it.motion, self.room, span, told)
        for k in np.flatnonzero(self.closed & ~closed):
            events.append(StopEvent(time=float(time), stop=self.names[k], kind="release"))
        self.closed[:] = closed
        self._hold(self.it.bodies.supported)
        return span, touching, iterations

    def _closed_in(self, span: float, extent: float) -> tuple[BoolArray | None, int]:
        """Closed stops that push in a slab, of those that are closed at its start; None if it has no solution."""
        closed, iterations = self.closed.copy(), 0
        for _ in range(EXCHANGES):
            self._activate(closed)
            used = try_slab(*self._tables, span, extent)
            iterations += used
            if not used:
                return None, iterations
            push, gap = self.sign * self.it.motion.impulse[self.rows], self._gaps()
            under = self.closed & ~closed & (gap < -TOUCH * extent)
            pulled = closed & (push < -max(PULL * float(np.abs(push).max()), self._rounding(span, extent)))
            if pulled.any():
                closed[np.argmin(np.where(pulled, push, np.inf))] = False
            elif under.any():
                closed = closed | under
            else:
                return closed, iterations
        return None, iterations

    def _first_touch(self, span: float, extent: float) -> tuple[float, int] | None:
        """Length at which the first gap closes, with its solution in the work space; None if none opens before."""
        kept, counted = self.it.motion.impulse / span, [0]

        def least(length: float) -> float:
            self.it.motion.impulse[:] = kept * length
            used = try_slab(*self._tables, length, extent)
            counted[0] += used
            return float(self._gaps()[~self.closed].min()) if used else -np.inf

        low, high = 0.5 * span, span
        for _ in range(HALVINGS):
            if least(low) > 0.0:
                break
            low, high = 0.5 * low, low
        else:
            return None
        length = float(brentq(least, low, high, xtol=1e-15 * high, rtol=1e-15))
        least(length)
        return length, counted[0]

    def _impact(self, time: float, h: float, touching: BoolArray, extent: float, events: list[StopEvent]) -> None:
        """Impact of the touching stops, with those that are closed."""
        motion, bodies = self.it.motion, self.it.bodies
        before, energy = self._speeds(), self._energy()
        hits = touching & (before < 0.0)
        resting = hits & (time - self.touched < SHORT * h) & (self.restitution < 1.0)
        ratio = np.where(resting, 0.0, self.restitution)
        if self.law == "simultaneous":
            impulse = self._simultaneous(hits, before, ratio)
        else:
            impulse = self._sequential(touching, ratio)
        after, scale = self._speeds(), float(np.abs(before).max())
        for k in np.flatnonzero(hits):
            end = (time - self.touched[k]) * self.restitution[k] / (1.0 - self.restitution[k]) if resting[k] else 0.0
            kind: Literal["touch", "rest"] = "rest" if resting[k] else "touch"
            told = {
                "velocity_before": float(before[k]),
                "velocity_after": float(after[k]),
                "impulse": float(impulse[k]),
            }
            events.append(StopEvent(time=float(time + end), stop=self.names[k], kind=kind, **told))
            self.touched[k] = time
        self.closed[:] = (self.closed | touching) & (np.abs(after) <= STILL * scale)
        lost = energy - self._energy()
        motion.work[1] += float(lost.sum())
        motion.energy[:] -= lost
        motion.impulse[self.rows] = 0.0
        self._hold(bodies.supported)

    def _simultaneous(self, hits: BoolArray, before: Array, ratio: Array) -> Array:
        """All stops that push take part at once: each ends with the velocity of its restitution; impulses (s,)."""
        motion = self.it.motion
        velocity, spin, active = motion.velocity.copy(), motion.spin.copy(), self.closed | hits
        for _ in range(EXCHANGES):
            motion.velocity[:], motion.spin[:] = velocity, spin
            self._activate(active)
            wanted = np.zeros(len(self.room.g))
            wanted[self.rows] = np.where(hits, -(1.0 + ratio) * before, -before) * self.sign
            impulse = self._pushed(wanted)
            pulled = active & (impulse < -PULL * float(np.abs(impulse).max()))
            missed = (
                (self.closed | hits)
                & ~active
                & (self._speeds() < -ratio * before - STILL * float(np.abs(before).max()))
            )
            if pulled.any():
                active[np.argmin(np.where(pulled, impulse, np.inf))] = False
            elif missed.any():
                active = active | missed
            else:
                break
        return np.where(active, impulse, 0.0)

    def _sequential(self, touching: BoolArray, ratio: Array) -> Array:
        """One stop after the other, each time that with the greatest velocity of approach; impulses (s,)."""
        total, near = np.zeros(len(self.rows)), self.closed | touching
        scale = float(np.abs(self._speeds()).max())
        for _ in range(BLOWS):
            speed = np.where(near, self._speeds(), 0.0)
            k = int(np.argmin(speed))
            if speed[k] >= -STILL * scale:
                break
            only = np.arange(len(self.rows)) == k
            self._activate(only)
            wanted = np.zeros(len(self.room.g))
            wanted[self.rows[k]] = -(1.0 + ratio[k]) * speed[k] * self.sign[k]
            total += np.where(only, self._pushed(wanted), 0.0)
        return total

    @property
    def _tables(self) -> tuple[object, ...]:
        return self.it.bodies, self.it.joints, self.it.springs, self.it.motion, self.room

    def _pushed(self, wanted: Array) -> Array:
        """Impulses (s,) of the stops after the velocities of the active rows were changed by ``wanted`` (r,)."""
        push_rows(self.it.joints, self.it.motion, self.room, wanted)
        return self.sign * wanted[self.rows]

    def _activate(self, closed: BoolArray) -> None:
        """Let these stops take part, and the joints."""
        self.room.active[self.rows] = closed
        self.it.motion.impulse[self.rows[~closed]] = 0.0
        refactor(self.it.bodies, self.it.joints, self.it.motion, self.room)

    def _hold(self, supported: IntArray) -> None:
        """Groups that the ground holds by joints or closed stops."""
        joints, ground = self.it.joints, len(self.it.names)
        supported[:] = self.held
        for row in self.rows[self.closed]:
            a, b = int(joints.a[row]), int(joints.b[row])
            if ground in (a, b):
                supported[self.it.bodies.group[min(a, b)]] = 1

    def _gaps(self) -> Array:
        """Gaps (s,) at the end of the part that was tried [m]."""
        return self.sign * self.room.g[self.rows]

    def _at_state(self) -> Array:
        """Gaps (s,) at the present state [m]."""
        refactor(self.it.bodies, self.it.joints, self.it.motion, self.room)
        return self._gaps()

    def _speeds(self) -> Array:
        """Velocities (s,) of the gaps [m/s]."""
        out = np.zeros(len(self.room.g))
        row_velocities(self.it.joints, self.it.motion, self.room, out)
        return self.sign * out[self.rows]

    def _rounding(self, span: float, extent: float) -> float:
        """Rounding error of an impulse [kg m/s]: of the momenta, and of the places divided by half the slab."""
        mass, speed = self.it.bodies.mass, np.linalg.norm(self.it.motion.velocity, axis=1)
        return PULL * float((mass * speed).max()) + ROUNDING * float(mass.max()) * extent / span

    def _energy(self) -> Array:
        """Kinetic energies (g,) of the groups [J]."""
        out = np.zeros(len(self.it.bodies.jointed))
        kinetic_energy(self.it.bodies, self.it.motion, out)
        return out
