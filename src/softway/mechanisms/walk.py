"""Slabs (time steps) of a mechanism in groups: compiled ones, and those in which something happens."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NumericsError
from softway.kernels.multibody.slab import begin
from softway.kernels.multibody.tables import Space, space
from softway.kernels.multibody.velocities import project_velocities
from softway.kernels.rigid_course.course import ITERATIONS, Course, course, march_rows, note_state
from softway.mechanisms.arrays import Arrays, MechanismState, arrays, captured, changing, restore
from softway.mechanisms.contacts.impacts import StopMarch
from softway.mechanisms.contacts.stop_start import stop_march
from softway.mechanisms.driven import require_free_motions
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.stops import StopEvent
from softway.mechanisms.newton import hard_slab
from softway.mechanisms.step import MechanismGroup
from softway.mechanisms.welds import Welded, parts_of, welded

Changing = Mapping[str, Array | IntArray | BoolArray]
"""Arrays that a march changes, by name."""
TOGETHER = 256
"""Number of slabs of a group; those who wait for its states wait for no more slabs."""
COMPILED = 5000
"""Number of slabs of a march from which loops over slabs with stops pay: they take as long to compile as 10^5 single
slabs, which have the same bits.
"""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Stretch:
    """Slabs from ``begin`` on, up to a ``total``, of which the ``first`` are over; they fill the rows of the course."""

    begin: int
    first: int
    total: int
    course: Course
    events: list[list[StopEvent]]

    def full(self, reached: int) -> int:
        """Number of rows that are complete after a number of slabs."""
        return len(self.events) if reached == self.total else reached // self.course.every

    def slabs(self, rows: int) -> IntArray:
        """Numbers of slabs since the start of the march, after each of the first ``rows``."""
        return self.begin + np.minimum(self.course.every * np.arange(1, rows + 1), self.total)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Walk:
    """March of a mechanism from one state to the next.

    Parameters
    ----------
    mechanism, joined
        The mechanism, and that without its welds.
    it, room
        Arrays, and work space.
    stops
        March of its stops, if it has any.
    tables
        Arrays that change, by name.
    until, h
        End, and length of a slab [s].
    slabs, every
        Number of slabs, and those between two states that are told.
    state
        State from which the march goes on, if it does.
    """

    mechanism: Mechanism
    joined: Welded
    it: Arrays
    room: Space
    stops: StopMarch | None
    tables: Changing
    until: float
    h: float
    slabs: int
    every: int
    state: MechanismState | None

    def groups(self) -> Iterator[MechanismGroup]:
        """States of the march."""
        if self.state is None:
            start = self._start()
            initial, done = start.initial, 0
            yield start
        else:
            initial, done = self.state.energy, self.state.slabs
        stretch, kept = self._stretch(done), self._kept()
        while stretch.begin + stretch.first < self.slabs:
            reached, error = self._flown(stretch)
            if rows := stretch.full(reached):
                yield self._told(stretch, rows, partial(self._again, kept, stretch, initial), initial)
            if error is not None:
                raise error
            happens, stretch = reached < stretch.total, self._after(stretch, reached)
            if happens:
                self._slab(stretch)
            kept, over = self._kept(), stretch.first + int(happens)
            if happens and stretch.full(over):
                yield self._told(stretch, 1, partial(self._now, kept, stretch.slabs(1), initial), initial)
            stretch = self._after(stretch, over) if happens else stretch

    def _start(self) -> MechanismGroup:
        """State at the start, with velocities that the joints allow."""
        it, room, stretch = self.it, self.room, self._stretch(0, 1)
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        require_free_motions(it, room)
        project_velocities(it.bodies, it.joints, it.motion, room)
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        initial = float(it.motion.energy.sum())
        if self.stops is not None:
            stretch.events[0] += self.stops.start(self.h, it.reach(self.h))
        self._note(stretch.course)
        group = self._told(stretch, 1, partial(self._now, self._kept(), np.zeros(1, np.int64), initial), initial)
        return replace(group, slabs=np.zeros(1, np.int64), time=np.zeros(1))

    def _kept(self) -> Changing:
        """Copies of the arrays that change."""
        return {name: array.copy() for name, array in self.tables.items()}

    def _stretch(self, start: int, rows: int = TOGETHER) -> _Stretch:
        """Slabs from a number on, at most so many rows and slabs."""
        left = self.slabs - start
        rows = min(rows, max(TOGETHER // self.every, 1), -(-left // self.every))
        whole, arms = parts_of(self.mechanism, self.joined, self.it.names)
        stops = 0 if self.stops is None else len(self.stops.stops.rows)
        table = course(rows, self.every, whole, arms, len(self.room.drive), stops)
        total = min(rows * self.every, left)
        return _Stretch(begin=start, first=0, total=total, course=table, events=[[] for _ in range(rows)])

    def _after(self, stretch: _Stretch, reached: int) -> _Stretch:
        """Slabs from the number ``reached`` of a stretch on; a row that is not complete goes on."""
        row = stretch.full(reached)
        first = reached - row * self.every if reached < stretch.total else 0
        found = self._stretch(stretch.begin + reached - first, 1 if reached < stretch.total else TOGETHER)
        if first:
            found.course.told[0] = stretch.course.told[row]
            found.course.counts[0] = stretch.course.counts[row]
            found.events[0] += stretch.events[row]
        return replace(found, first=first)

    def _flown(self, stretch: _Stretch) -> tuple[int, NumericsError | None]:
        """March compiled slabs: the number of those of the stretch that are over, and what the next one raises."""
        it, (first, total) = self.it, (stretch.first, stretch.total)
        if self.stops is not None:
            if self.slabs < COMPILED:
                return first, None
            return self.stops.flown(stretch.course, self.h, stretch.begin, first, total, stretch.events)
        tables = it.bodies, it.joints, it.springs, it.motion, self.room, stretch.course
        return int(march_rows(*tables, it.extent, self.h, first, total)), None

    def _slab(self, stretch: _Stretch) -> None:
        """March a slab in which something happens, in the first row of a stretch."""
        time, told = (stretch.begin + stretch.first) * self.h, stretch.course.told[0]
        if self.stops is None:
            used = hard_slab(self.it, self.room, time, self.h, told)
        else:
            events, used = self.stops.slab(time, self.h, self.it.reach(self.h), told)
            stretch.events[0] += events
        stretch.course.counts[0, ITERATIONS] += used
        if stretch.full(stretch.first + 1):
            self._note(stretch.course)

    def _note(self, table: Course) -> None:
        """Set the first row to the present state."""
        it = self.it
        note_state(it.bodies, it.joints, it.springs, it.motion, self.room, table, 0)
        if self.stops is not None:
            table.closed[0] = self.stops.stops.closed

    def _told(
        self, stretch: _Stretch, rows: int, reached: Callable[[int], MechanismState], initial: float
    ) -> MechanismGroup:
        """Group of the first ``rows`` of a stretch."""
        slabs = stretch.slabs(rows)
        table = stretch.course
        if rows < len(table.sums):  # the others are not kept
            first: tuple[Any, ...] = tuple(array[:rows].copy() for array in table[3:])
            table = Course(*table[:3], *first)
        return MechanismGroup(
            course=table,
            time=np.where(slabs == self.slabs, self.until, slabs * self.h),
            slabs=slabs,
            initial=initial,
            dim=self.mechanism.dim,
            names=tuple(self.mechanism.bodies),
            stops=() if self.stops is None else self.stops.stops.names,
            motors=tuple(self.it.joint_of[k] for k in self.it.joints.drives.row),
            events=stretch.events[:rows],
            reached=reached,
        )

    def _now(self, kept: Changing, slabs: IntArray, initial: float, k: int) -> MechanismState:
        """State of the march after a slab that was not compiled."""
        return captured(kept, int(slabs[k]), self._time(int(slabs[k])), self.h, initial)

    def _time(self, slabs: int) -> float:
        return self.until if slabs == self.slabs else slabs * self.h

    def _again(self, kept: Changing, stretch: _Stretch, initial: float, k: int) -> MechanismState:
        """State after the k-th row of a stretch, by a march from the arrays that were ``kept`` at its start."""
        now, slabs = self._kept(), int(stretch.slabs(k + 1)[k])
        for name, array in self.tables.items():
            array[:] = kept[name]
        again = self._stretch(stretch.begin)
        self._flown(replace(again, first=stretch.first, total=slabs - stretch.begin))
        found = self._now(self._kept(), np.array([slabs]), initial, 0)
        for name, array in self.tables.items():
            array[:] = now[name]
        return found


def walk_of(mechanism: Mechanism, until: float, step: float, every: int, state: MechanismState | None) -> Walk:
    """March of a mechanism from its start, or from a state.

    Raises
    ------
    InputError
        For wrong input, or the state of another march.
    """
    joined, slabs = welded(mechanism), int(np.ceil(until / step * (1.0 - 1e-12)))
    it = arrays(joined.mechanism)
    room, stops = space(it.joints, len(it.names), len(it.bodies.jointed)), None
    if joined.mechanism.stops:
        stops = stop_march(it, room, joined.mechanism)
    tables = changing(it, room, {} if stops is None else stops.changing)
    if state is not None:
        restore(tables, state, until / slabs)
    return Walk(
        mechanism=mechanism,
        joined=joined,
        it=it,
        room=room,
        stops=stops,
        tables=tables,
        until=until,
        h=until / slabs,
        slabs=slabs,
        every=every,
        state=state,
    )
