"""Number of parallel processes, and display of their progress."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from softway.errors import InputError

Show = Callable[[int, str], None]


def processes(asked: int | None) -> int:
    """Number of processes from ``--jobs``; by default one per processor.

    Examples
    --------
    >>> processes(3)
    3
    """
    if asked is not None and asked < 1:
        raise InputError("--jobs", f"{asked}", "1 or more")
    return asked or os.cpu_count() or 1


@contextmanager
def counted(total: int, things: str, first: str, console: Console) -> Iterator[Show | None]:
    """Function that shows the number of ``things`` done and a remark; ``None`` without an interactive terminal."""
    if console.quiet or not console.is_terminal:
        yield None
        return
    columns = (
        BarColumn(bar_width=24),
        TextColumn(f"{{task.completed}} of {{task.total}} {things}"),
        TextColumn("{task.description}, after"),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=console, transient=True) as display:
        task = display.add_task(first, total=total)
        yield lambda done, told: display.update(task, completed=done, description=told)
