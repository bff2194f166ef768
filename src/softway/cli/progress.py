"""Progress of a run on a terminal: time left, error of the energy balance, closed contact nodes."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta
from threading import Timer

from rich.console import Console
from rich.progress import (
    BarColumn,
    SpinnerColumn,
    TaskID,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import Progress as Display

from softway.record.progress import Progress
from softway.scenario.check import Checked

PATIENCE = 1.0
"""Seconds after which a run is long enough to be watched."""
FIRST = "first slab: kernels are compiled once"
"""What a run may do before its first slab is done."""
COLUMNS = (
    TextColumn("{task.description}"),
    BarColumn(bar_width=16),
    TaskProgressColumn(),
    TextColumn("ETA {task.fields[left]}"),
    TextColumn("energy error {task.fields[error]}"),
    TextColumn("contacts {task.fields[closed]}"),
)


@contextmanager
def delayed(display: Display) -> Iterator[None]:
    """Show a display once the work takes longer than patience lasts, until it ends."""
    timer = Timer(PATIENCE, display.start)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        display.stop()


@contextmanager
def waiting(console: Console, what: str) -> Iterator[None]:
    """Say what is being done, and for how long, where that takes longer than patience lasts and somebody watches."""
    if console.quiet or not console.is_terminal:
        yield
        return
    columns = SpinnerColumn(), TextColumn("{task.description}, after"), TimeElapsedColumn()
    display = Display(*columns, console=console, transient=True)
    display.add_task(what, total=None)
    with delayed(display):
        yield


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
            description="",
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
    task = display.add_task(FIRST, total=checked.scenario.time.end, left="-", error="-", closed=0)
    with delayed(display):
        yield Watch(display=display, task=task)


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

    def __call__(self, name: str, time: float) -> None:
        """Show one slab of a method."""
        task = self.tasks[name]
        if not self.display.tasks[task].started:
            self.display.start_task(task)
        self.display.update(task, completed=time)


@contextmanager
def laps_of(names: Sequence[str], end: float, console: Console) -> Iterator[Laps | None]:
    """What to call with each slab of some methods that go until ``end``; ``None`` where nobody watches."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    columns = (*COLUMNS[:3], TextColumn("ETA"), TimeRemainingColumn())
    display = Display(*columns, console=console, transient=True)
    tasks = {name: display.add_task(name, total=end, start=False) for name in names}
    with delayed(display):
        yield Laps(display=display, tasks=tasks)
