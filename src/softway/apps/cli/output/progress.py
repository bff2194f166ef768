"""Progress display of a run: remaining time, error of the energy balance, closed contact nodes."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta
from functools import partial
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

from softway.heat.march import HeatStep
from softway.mechanisms.step import MechanismStep
from softway.piles.march import PileStep
from softway.record.write.progress import MechanismProgress, Occasional, Progress, Tell
from softway.scenario.checks.check import Checked
from softway.scenario.run_rigid import CheckedRigid

PATIENCE = 1.0
"""Seconds after which the progress of a run is shown."""
FIRST = "first slab: kernels are compiled once"
"""Description shown during the first slab."""
COLUMNS = (
    TextColumn("{task.description}"),
    BarColumn(bar_width=16),
    TaskProgressColumn(),
    TextColumn("ETA {task.fields[left]}"),
    TextColumn("energy error {task.fields[error]}"),
    TextColumn("contacts {task.fields[closed]}"),
    TextColumn("{task.fields[span]}"),
)


@contextmanager
def delayed(display: Display) -> Iterator[None]:
    """Show a display if the work takes longer than ``PATIENCE``; stop it at the end of the work."""
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
    """Show the current work and its duration on an interactive terminal, if it takes longer than ``PATIENCE``."""
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
    """Progress display of a run, of solids, of a mechanism, of a pile or of conductors."""

    display: Display
    task: TaskID

    def __call__(self, progress: Progress | MechanismProgress) -> None:
        """Show one step."""
        if progress.wall < PATIENCE:
            return
        if not self.display.live.is_started:
            self.display.start()
        step, span = progress.step, ""
        if isinstance(step, MechanismStep):
            error, closed = step.energy_error, len(step.closed)
        elif isinstance(step, HeatStep):
            error, closed = step.ledger.error, 0
        elif isinstance(step, PileStep):
            error, closed = step.energy_error, step.closed
        else:
            error, closed = step.ledger.energy_error, sum(c.count for c in step.ledger.contacts.values())
            span = f"slab {step.slab.span:.3g} s"
        self.display.update(
            self.task,
            description="",
            completed=progress.time,
            left=_clock(progress.left),
            error=f"{error:.1e} J",
            closed=closed,
            span=span,
        )


@contextmanager
def progress_of(checked: Checked | CheckedRigid, console: Console) -> Iterator[Occasional | None]:
    """Function to call after each step; ``None`` without an interactive terminal."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    display = Display(*COLUMNS, console=console, transient=True)
    task = display.add_task(FIRST, total=checked.scenario.time.end, left="-", error="-", closed=0, span="")
    with delayed(display):
        yield Occasional(Watch(display=display, task=task))


def teller(console: Console) -> Tell:
    """Function that prints a line beside the progress display."""
    return partial(console.print, markup=False, soft_wrap=True)


def _clock(seconds: float) -> str:
    """Duration as hours, minutes and seconds; ``-`` if it is extremely long.

    Examples
    --------
    >>> _clock(3725.0), _clock(float("inf"))
    ('1:02:05', '-')
    """
    return str(timedelta(seconds=round(seconds))) if seconds < 1e7 else "-"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Laps:
    """Progress display of a race, with one bar per method."""

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
    """Function to call after each slab of the methods, which run until ``end``; ``None`` without a terminal."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    columns = (*COLUMNS[:3], TextColumn("ETA"), TimeRemainingColumn())
    display = Display(*columns, console=console, transient=True)
    tasks = {name: display.add_task(name, total=end, start=False) for name in names}
    with delayed(display):
        yield Laps(display=display, tasks=tasks)
