"""Progress of a run, reported to a callback after each time step (slab)."""

import time as clock
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from softway.heat.march import HeatStep
from softway.marching.results.step import Step
from softway.marching.results.trying import Trying
from softway.marching.slab.step_group import StepGroup
from softway.mechanisms.step import MechanismStep
from softway.piles.march import PileStep

RECENT = 30.0
"""Wall-clock window over which the pace is measured [s]: slabs in contact take longer than slabs in free flight."""

BEAT = 5.0
"""Wall-clock time inside one attempt at a slab after which a line tells what is being tried [s]."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Progress:
    """Progress of a run after a recorded slab.

    Parameters
    ----------
    step
        The recorded slab.
    until
        End of the march [s].
    slabs
        Number of accepted slabs since the start of the march, including those before an interruption.
    wall
        Wall-clock time since this call of ``run`` or ``resume`` began to march [s].
    pace
        Recent simulated time per wall-clock time.
    """

    step: Step
    until: float
    slabs: int
    wall: float
    pace: float

    @property
    def time(self) -> float:
        """Time at the end of the slab [s]."""
        return self.step.slab.end

    @property
    def fraction(self) -> float:
        """Completed fraction of the simulated time, 0 to 1."""
        return _fraction(self.time, self.until)

    @property
    def left(self) -> float:
        """Estimated wall-clock time until the end at the present pace [s]; infinite while the pace is unknown."""
        return _left(self.time, self.until, self.pace)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MechanismProgress:
    """Progress of the run of a mechanism, a pile or conductors after a recorded step, as :class:`Progress`.

    Parameters
    ----------
    step
        The recorded step of some slabs (time steps).
    until, slabs, wall, pace
        As in :class:`Progress`.
    """

    step: MechanismStep | PileStep | HeatStep
    until: float
    slabs: int
    wall: float
    pace: float

    @property
    def time(self) -> float:
        """Time of the step [s]."""
        return self.step.time

    @property
    def fraction(self) -> float:
        """Completed fraction of the simulated time, 0 to 1."""
        return _fraction(self.time, self.until)

    @property
    def left(self) -> float:
        """Estimated wall-clock time until the end at the present pace [s]; infinite while the pace is unknown."""
        return _left(self.time, self.until, self.pace)


def _fraction(time: float, until: float) -> float:
    return min(1.0, time / until)


def _left(time: float, until: float, pace: float) -> float:
    return max(0.0, until - time) / pace if pace > 0.0 else inf


Watch = Callable[[Progress], None]
"""Callback after every slab, in the thread of the run; an exception that it raises ends the run and propagates."""
MechanismWatch = Callable[[MechanismProgress], None]
"""Callback after every recorded step of a mechanism or a pile, as :data:`Watch`."""


@dataclass(frozen=True, slots=True, eq=False)
class Occasional:
    """Watch that is called once for slabs that were compiled together, after the last of them: a step of each would
    take longer than the slab.
    """

    watch: Callable[[Progress | MechanismProgress], None]

    def __call__(self, progress: Progress | MechanismProgress) -> None:
        """Pass the progress on."""
        self.watch(progress)


Tell = Callable[[str], None]
"""Function that shows a line."""


class Heartbeat:
    """Heartbeat of a run: a line after ``BEAT`` seconds inside one attempt at a slab, and again after as many.

    It is shown beforehand if what begins will take as long by its estimate.  The clock decides what is shown and
    nothing else.

    Parameters
    ----------
    tell
        Function that shows a line.
    now
        Function that returns the present time [s]; by default the clock of the process.

    Examples
    --------
    >>> times = iter([0.0, 4.0, 5.5, 6.0, 11.0, 11.5])
    >>> beat = Heartbeat(print, lambda: next(times))
    >>> for k in (0, 1, 2, 3, 4, 0):
    ...     beat(Trying(slab=3, time=0.25, span=0.125, iteration=k, change=0.5, active=12))
    after 6 s: slab 3 at t = 0.25 s, h = 0.125 s: iteration 2, relative change 5.0e-01, 12 active rows
    after 11 s: slab 3 at t = 0.25 s, h = 0.125 s: iteration 4, relative change 5.0e-01, 12 active rows
    """

    __slots__ = ("_begun", "_now", "_shown", "_tell")

    def __init__(self, tell: Tell, now: Callable[[], float] | None = None) -> None:
        self._tell, self._now = tell, now or clock.perf_counter
        self._begun = self._shown = 0.0

    def __call__(self, trying: Trying) -> None:
        """Take the state of an attempt; show it if the last line is old, or will be before the next one."""
        now = self._now()
        if trying.iteration == 0 and not trying.doing:
            self._begun = self._shown = now
        elif now - self._shown + trying.seconds >= BEAT:
            self._shown = now
            self._tell(f"after {now - self._begun:.0f} s: {trying}")


class Pace:
    """Pace of a march: simulated time per wall-clock time of the last ``RECENT`` seconds.

    Parameters
    ----------
    start
        Time at which the march starts or continues [s].
    """

    __slots__ = ("_begun", "_marks")

    def __init__(self, start: float) -> None:
        self._begun = clock.perf_counter()
        self._marks = deque([(0.0, start)])

    def at(self, time: float) -> tuple[float, float]:
        """Wall-clock time since the start [s], and the recent pace, when the march has reached a time [s]."""
        now = clock.perf_counter() - self._begun
        while len(self._marks) > 1 and self._marks[1][0] <= now - RECENT:
            self._marks.popleft()
        since, before = self._marks[0]
        if now - self._marks[-1][0] > 1e-2 * RECENT:
            self._marks.append((now, time))
        return now, (time - before) / (now - since) if now > since else 0.0


class Meter:
    """Meter of the progress of a run, which calls a watch after each slab.

    Parameters
    ----------
    watch
        Callback that receives the progress.
    until
        End of the march [s].
    start
        Time at which the march starts or continues [s].
    slabs
        Number of slabs accepted before that time.
    """

    __slots__ = ("_pace", "_slabs", "_until", "_watch")

    def __init__(self, watch: Watch, until: float, start: float, slabs: int = 0) -> None:
        self._watch, self._until, self._slabs, self._pace = watch, until, slabs, Pace(start)

    def took(self, one: Step | StepGroup) -> None:
        """Take a recorded slab, or group of slabs, and report the progress after it."""
        if isinstance(one, StepGroup):
            self._slabs, step = self._slabs + len(one), one.step(len(one) - 1)
        else:
            self._slabs, step = self._slabs + 1, one
        now, pace = self._pace.at(step.slab.end)
        self._watch(Progress(step=step, until=self._until, slabs=self._slabs, wall=now, pace=pace))
