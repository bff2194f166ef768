"""How far a run is: what whoever waits for it is told after each slab."""

import time as clock
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from softway.march.step import Step

RECENT = 30.0
"""Seconds on the clock over which the pace is judged: slabs in contact take longer than those in flight."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Progress:
    """How far a run is after a slab that has been recorded.

    Parameters
    ----------
    step
        The slab.
    until
        End of the march [s].
    slabs
        Accepted since the start of the march, before an interruption too.
    wall
        Time on the clock since this call of ``run`` or ``resume`` began to march [s].
    pace
        Time of the march per time on the clock, of late.
    """

    step: Step
    until: float
    slabs: int
    wall: float
    pace: float

    @property
    def time(self) -> float:
        """End of the slab [s]."""
        return self.step.after.time

    @property
    def fraction(self) -> float:
        """Share of the time of the march that is done, 0 to 1."""
        return min(1.0, self.time / self.until)

    @property
    def left(self) -> float:
        """Time on the clock until the end [s] if it goes on at this pace; infinite while nothing is known."""
        return max(0.0, self.until - self.time) / self.pace if self.pace > 0.0 else inf


Watch = Callable[[Progress], None]
"""Is told of every slab, in the thread of the run; what it raises ends the run and comes out as it is."""


class Meter:
    """Tells a watch how far a run is.

    Parameters
    ----------
    watch
        Who is told.
    until
        End of the march [s].
    start
        Where the march begins or goes on [s].
    slabs
        Accepted before that.
    """

    __slots__ = ("_begun", "_marks", "_slabs", "_until", "_watch")

    def __init__(self, watch: Watch, until: float, start: float, slabs: int = 0) -> None:
        self._watch, self._until, self._slabs = watch, until, slabs
        self._begun = clock.perf_counter()
        self._marks = deque([(0.0, start)])

    def took(self, step: Step) -> None:
        """Note a slab that has been recorded, and tell of it."""
        now, time = clock.perf_counter() - self._begun, step.after.time
        while len(self._marks) > 1 and self._marks[1][0] <= now - RECENT:
            self._marks.popleft()
        since, before = self._marks[0]
        if now - self._marks[-1][0] > 1e-2 * RECENT:
            self._marks.append((now, time))
        self._slabs += 1
        pace = (time - before) / (now - since) if now > since else 0.0
        self._watch(Progress(step=step, until=self._until, slabs=self._slabs, wall=now, pace=pace))
