"""Progress of a run on a terminal: time left, error of the energy balance, closed contact nodes."""

import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

from softway.march.step import Step

PATIENCE = 1.0
"""Seconds after which a run is long enough to be watched."""
COLUMNS = (
    BarColumn(bar_width=16),
    TaskProgressColumn(),
    TextColumn("ETA"),
    TimeRemainingColumn(),
    TextColumn("energy error {task.fields[error]}"),
    TextColumn("contacts {task.fields[closed]}"),
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Watch:
    """Takes the steps of a run and shows how far it is."""

    display: Progress
    task: TaskID
    begun: float

    def __call__(self, step: Step) -> None:
        """Show one step."""
        if clock.perf_counter() - self.begun < PATIENCE:
            return
        if not self.display.live.is_started:
            self.display.start()
        ledger = step.ledger
        self.display.update(
            self.task,
            completed=step.after.time,
            error=f"{ledger.energy_error:.1e} J",
            closed=sum(c.count for c in ledger.contacts.values()),
        )


@contextmanager
def progress_of(checked: Any, console: Console) -> Iterator[Watch | None]:
    """What to call with each step; ``None`` where nobody watches."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    display = Progress(*COLUMNS, console=console, transient=True)
    task = display.add_task("", total=checked.scenario.time.end, error="-", closed=0)
    try:
        yield Watch(display=display, task=task, begun=clock.perf_counter())
    finally:
        display.stop()
