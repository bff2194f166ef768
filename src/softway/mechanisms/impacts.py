"""March of a mechanism with stops: touches at instants inside a slab (time step), impacts, rest, release, friction.

A gap that closes inside a slab ends a part of the slab at that instant, and the impact follows there.  The impulses of
closed stops obey the laws of contact on places over the slab, and with those at its end on velocities
(docs/theory/mechanisms.md).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError, NumericsError
from softway.kernels.multibody.contact import book_slab, collide, solve_contact_slab
from softway.kernels.multibody.energy import close_energy, kinetic_energy
from softway.kernels.multibody.slab import refactor, row_velocities, take_motion, tell_joints
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
SLIP = 1e-9
"""Friction, relative to its limit, that is rounding below it."""
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
    rows
        (s, d) rows of the stops in the table of the joints: the normal one, and the tangential ones if there is
        friction.
    restitution, friction
        (s,) coefficients.
    names
        Names of the stops.
    law
        Law of impacts at several stops at once.
    held
        (g,) groups that the ground holds by joints.
    closed, sliding
        (s,) stops that are closed, and those whose places of contact slide.
    touched
        (s,) instants of the last touches [s].
    """

    it: Arrays
    room: Space
    rows: IntArray
    restitution: Array
    friction: Array
    names: tuple[str, ...]
    law: Impacts
    held: IntArray
    closed: BoolArray
    sliding: BoolArray
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
            used = self._tried(span, extent)
            iterations += used
            if used:
                break
            span *= 0.5
        else:
            raise NumericsError(f"a slab of {span:.3g} s has no solution", time, "a shorter step")
        if (self._gaps()[~self.closed] < -TOUCH * extent).any():
            found = self._first_touch(span, extent)
            if found is None:
                return 0.0, ~self.closed & (self._at_state() <= NEAR * extent), iterations
            span, used = found
            iterations += used
        touching = ~self.closed & (np.abs(self._gaps()) <= NEAR * extent) if span < left else none
        closed = self._taken(span, extent, told)
        for k in np.flatnonzero(self.closed & ~closed):
            events.append(StopEvent(time=float(time), stop=self.names[k], kind="release"))
        self.closed[:] = closed
        self._hold(self.it.bodies.supported)
        return span, touching, iterations

    def _tried(self, span: float, extent: float) -> int:
        """Solve a slab with the closed stops, without taking it; the number of iterations, 0 if it has no solution."""
        rows, friction = self._closed_rows()
        self.it.motion.impulse[self.rows[~self.closed].ravel()] = 0.0
        used: int = solve_contact_slab(*self._tables, rows, friction, span, extent)
        return used

    def _taken(self, span: float, extent: float, told: Array) -> BoolArray:
        """Take the slab that was tried; stops (s,) that are closed at its end.

        The energy that joints and stops took from the velocities at the end is given back, but not that of stops that
        slide or begin to stick.
        """
        it, (rows, friction) = self.it, self._closed_rows()
        book_slab(it.bodies, it.joints, it.motion, self.room, rows, span)
        take_motion(*self._tables, span)
        through = it.motion.impulse[rows]
        normal, tangential = self._split(through)
        sticks = ~self.sliding[self.closed] & (tangential < (1.0 - SLIP) * friction * normal)
        steady = bool(((normal > 0.0) & ((friction == 0.0) | sticks)).all())
        if not steady:
            told[2] = max(told[2], close_energy(it.bodies, it.springs, it.motion, self.room))
        total, energy = through.copy(), self._energy()
        if len(rows):
            collide(it.bodies, it.joints, it.motion, self.room, rows, friction, through, 0.0 * friction, total)
        if steady:
            told[2] = max(told[2], close_energy(it.bodies, it.springs, it.motion, self.room))
        else:
            self._lose(energy - self._energy())
        tell_joints(it.joints, it.motion, self.room, told)
        closed, speed = self.closed.copy(), self._speeds()
        self._see_sliding()
        closed[self.closed] = (self._split(total)[0] > 0.0) | (
            (self._gaps()[self.closed] <= NEAR * extent)
            & (speed[self.closed] <= STILL * float(np.abs(it.motion.velocity).max()))
        )
        return closed

    def _first_touch(self, span: float, extent: float) -> tuple[float, int] | None:
        """Length at which the first gap closes, with its solution in the work space; None if none opens before."""
        kept, counted = self.it.motion.impulse / span, [0]

        def least(length: float) -> float:
            self.it.motion.impulse[:] = kept * length
            used = self._tried(length, extent)
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
        before, energy = self._speeds(), self._energy()
        hits = touching & (before < 0.0)
        resting = hits & (time - self.touched < SHORT * h) & (self.restitution < 1.0)
        ratio = np.where(resting, 0.0, self.restitution)
        impulse = np.zeros(len(self.rows))
        if self.law == "simultaneous":
            solved = self._collide(self.closed | touching, np.where(hits, ratio, 0.0), impulse)
        else:
            solved = self._sequential(touching, ratio, impulse)
        if not solved:
            names = ", ".join(self.names[k] for k in np.flatnonzero(self.closed | touching))
            raise NumericsError(f"the impact of {names} has no solution", time, "less friction, or sequential impacts")
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
        self._lose(energy - self._energy())
        self._see_sliding()
        self.it.motion.impulse[self.rows.ravel()] = 0.0
        self._hold(self.it.bodies.supported)

    def _collide(self, these: BoolArray, ratio: Array, impulse: Array) -> bool:
        """Impact at some stops (s,) at once with ratios of their velocities; their normal impulses are added.

        False if it has no solution.
        """
        rows = self.rows[these].ravel()
        found = np.zeros(len(rows))
        solved = collide(
            self.it.bodies,
            self.it.joints,
            self.it.motion,
            self.room,
            rows,
            self.friction[these],
            np.zeros(len(rows)),
            ratio[these],
            found,
        )
        impulse[these] += self._split(found)[0]
        return bool(solved)

    def _sequential(self, touching: BoolArray, ratio: Array, impulse: Array) -> bool:
        """One stop after the other, each time that with the greatest velocity of approach."""
        near, scale = self.closed | touching, float(np.abs(self._speeds()).max())
        for _ in range(BLOWS):
            speed = np.where(near, self._speeds(), 0.0)
            k = int(np.argmin(speed))
            if speed[k] >= -STILL * scale:
                return True
            if not self._collide(np.arange(len(self.rows)) == k, ratio, impulse):
                return False
        return False

    @property
    def _tables(self) -> tuple[object, ...]:
        return self.it.bodies, self.it.joints, self.it.springs, self.it.motion, self.room

    def _closed_rows(self) -> tuple[IntArray, Array]:
        """Rows (m,) of the closed stops, and their coefficients of friction."""
        return self.rows[self.closed].ravel(), self.friction[self.closed]

    def _split(self, impulse: Array) -> tuple[Array, Array]:
        """Normal impulses of stops, and magnitudes of the tangential ones."""
        table = impulse.reshape(-1, self.rows.shape[1])
        return table[:, 0], np.linalg.norm(table[:, 1:], axis=1)

    def _hold(self, supported: IntArray) -> None:
        """Groups that the ground holds by joints or closed stops."""
        joints, ground = self.it.joints, len(self.it.names)
        supported[:] = self.held
        for row in self.rows[self.closed, 0]:
            a, b = int(joints.a[row]), int(joints.b[row])
            if ground in (a, b):
                supported[self.it.bodies.group[min(a, b)]] = 1

    def _gaps(self) -> Array:
        """Gaps (s,) at the end of the part that was tried [m]."""
        return self.room.g[self.rows[:, 0]]

    def _at_state(self) -> Array:
        """Gaps (s,) at the present state [m]."""
        refactor(self.it.bodies, self.it.joints, self.it.motion, self.room)
        return self._gaps()

    def _speeds(self) -> Array:
        """Velocities (s,) of the gaps [m/s]."""
        return self._velocities()[:, 0]

    def _velocities(self) -> Array:
        """Velocities (s, d) of the gaps and of the sliding [m/s]."""
        out = np.zeros(len(self.room.g))
        row_velocities(self.it.joints, self.it.motion, self.room, out)
        return out[self.rows]

    def _see_sliding(self) -> None:
        """Note which stops slide."""
        speed = np.linalg.norm(self._velocities()[:, 1:], axis=1)
        self.sliding[:] = speed > STILL * float(np.abs(self.it.motion.velocity).max())

    def _energy(self) -> Array:
        """Kinetic energies (g,) of the groups [J]."""
        out = np.zeros(len(self.it.bodies.jointed))
        kinetic_energy(self.it.bodies, self.it.motion, out)
        return out

    def _lose(self, lost: Array) -> None:
        """Book energies (g,) of the groups that stops dissipated [J]."""
        self.it.motion.work[1] += float(lost.sum())
        self.it.motion.energy[:] -= lost
