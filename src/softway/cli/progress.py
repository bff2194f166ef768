"""Progress of a run on a terminal: time left, error of the energy balance, closed contact nodes."""

import time as clock
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta

from rich.console import Console
from rich.progress import BarColumn, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Display

from softway.record.progress import Progress
from softway.scenario.check import Checked

PATIENCE = 1.0
"""Seconds after which a run is long enough to be watched."""
COLUMNS = (
    BarColumn(bar_width=16),
    TaskProgressColumn(),
    TextColumn("ETA {task.fields[left]}"),
    TextColumn("energy error {task.fields[error]}"),
    TextColumn("contacts {task.fields[closed]}"),
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Watch:
    """Shows how far a run is."""

    display: Display
    task: TaskID

    def __call__(self, progress: Progress) -> None:
        """Show one step."""
        if progress.wall < PATIENCE:
            return
        if not self.display.live.is_started:
            self.display.start()
        ledger = progress.step.ledger
        self.display.update(
            self.task,
            completed=progress.time,
            left=_clock(progress.left),
            error=f"{ledger.energy_error:.1e} J",
            closed=sum(c.count for c in ledger.contacts.values()),
        )


@contextmanager
def progress_of(checked: Checked, console: Console) -> Iterator[Watch | None]:
    """What to call with each step; ``None`` where nobody watches."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    display = Display(*COLUMNS, console=console, transient=True)
    task = display.add_task("", total=checked.scenario.time.end, left="-", error="-", closed=0)
    try:
        yield Watch(display=display, task=task)
    finally:
        display.stop()


def _clock(seconds: float) -> str:
    """A time on the clock as hours, minutes and seconds; so long that nobody waits for it: -.

    Examples
    --------
    >>> _clock(3725.0), _clock(float("inf"))
    ('1:02:05', '-')
    """
    return str(timedelta(seconds=round(seconds))) if seconds < 1e7 else "-"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Laps:
    """Takes the slabs of a race and shows how far each method is."""

    display: Display
    tasks: Mapping[str, TaskID]
    begun: float

    def __call__(self, name: str, time: float) -> None:
        """Show one slab of a method."""
        task = self.tasks[name]
        if not self.display.tasks[task].started:
            self.display.start_task(task)
        if clock.perf_counter() - self.begun > PATIENCE and not self.display.live.is_started:
            self.display.start()
        self.display.update(task, completed=time)


@contextmanager
def laps_of(names: Sequence[str], end: float, console: Console) -> Iterator[Laps | None]:
    """What to call with each slab of some methods that go until ``end``; ``None`` where nobody watches."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    columns = (TextColumn("{task.description}"), *COLUMNS[:2], TextColumn("ETA"), TimeRemainingColumn())
    display = Display(*columns, console=console, transient=True)
    tasks = {name: display.add_task(name, total=end, start=False) for name in names}
    try:
        yield Laps(display=display, tasks=tasks, begun=clock.perf_counter())
    finally:
        display.stop()
