"""Command sweep: runs of a scenario with combinations of values."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.apps.cli.output.jobs import counted, processes
from softway.apps.cli.output.options import AllowPython, Quiet, Set
from softway.studies.sweep.plan import parsed, trials
from softway.studies.sweep.rows import NAME, Row, Sweep
from softway.studies.sweep.sweep import Watch
from softway.studies.sweep.sweep import sweep as execute

DONE, FAILED = 0, 3
SHOWN = ("energy_error_relative", "wall_time", "slabs")
"""Numbers of a run in the terminal table; ``OF_CONTACT`` are those of a contact. The file has all numbers."""
OF_CONTACT = ("first_touch", "last_release", "impulse", "peak_force")
HEADS = {
    "energy_error_relative": ("energy error", ""),
    "wall_time": ("wall", "s"),
    "slabs": ("slabs", ""),
    "first_touch": ("touch", "s"),
    "last_release": ("release", "s"),
    "impulse": ("impulse", "N s"),
    "peak_force": ("peak force", "N"),
}


def sweep(
    file: Path,
    /,
    *,
    over: Annotated[tuple[str, ...], Parameter(negative=())] = (),
    jobs: int | None = None,
    out: Path | None = None,
    scheduler: str | None = None,
    set_: Set = (),
    again: Annotated[bool, Parameter(negative=())] = False,
    quiet: Quiet = False,
    allow_python: AllowPython = False,
) -> int:
    """Compute a scenario with every combination of some values and write one table. The same command resumes a sweep.

    Parameters
    ----------
    file
        Scenario in TOML.
    over
        Values with units: path=v1,v2; can be repeated.
    jobs
        Number of parallel processes; by default one per processor.
    out
        Folder for the runs and sweep.csv; by default sweeps/ and the name of the file.
    scheduler
        Address of a Dask scheduler whose workers compute instead: pip install 'softway[dask]'.
    set_
        Change a value of the scenario for all runs: path=value; can be repeated.
    again
        Compute the runs that failed before again.
    quiet
        Print errors only.
    allow_python
        Allow module:name in the scenario to run code of installed modules, not only of modules next to the file.
    """
    values, number, console = parsed(over), processes(jobs), Console(quiet=quiet)
    with _interruption(), _progress(len(trials(values)), console) as watch:
        done = execute(
            file,
            values,
            out=out,
            changes=set_,
            jobs=number,
            scheduler=scheduler,
            again=again,
            allow_python=allow_python,
            watch=watch,
        )
    _table(done, console)
    for row in done.failed:
        told = f"{row.folder.name}: {row.stop.message}"
        Console(stderr=True).print(escape(told), soft_wrap=True, highlight=False, style="red")
    console.print(escape(str(done.path / NAME)), soft_wrap=True, highlight=False)
    return FAILED if done.failed else DONE


@contextmanager
def _interruption() -> Iterator[None]:
    try:
        yield
    except KeyboardInterrupt:
        Console(stderr=True).print("resume with the same command", soft_wrap=True)
        raise


def _table(done: Sweep, console: Console) -> None:
    """Print one line per run."""
    known = dict.fromkeys(name for row in done.rows for name in row.numbers)
    numbers = [*SHOWN, *(n for n in known if n.startswith("contact.") and n.rpartition(".")[2] in OF_CONTACT)]
    contacts = {n.rpartition(".")[0] for n in numbers} - {""}
    paths = list(done.rows[0].values)
    ends = [path.rpartition(".")[2] for path in paths]
    grid = Grid(box=None, pad_edge=False, header_style="bold")
    for path, end in zip(paths, ends, strict=True):
        grid.add_column(escape(end if ends.count(end) == 1 else path), justify="right", overflow="fold")
    grid.add_column("stop")
    for name in numbers:
        contact, _, last = name.rpartition(".")
        which = f"{contact.removeprefix('contact.')} " if contact and len(contacts) > 1 else ""
        grid.add_column(escape(which + HEADS[last][0]), justify="right", overflow="fold")
    units = (HEADS[name.rpartition(".")[2]][1] for name in numbers)
    grid.add_row(*("" for _ in paths), "", *units)
    for row in done.rows:
        cells = (_cell(name, row.numbers.get(name)) for name in numbers)
        style = "red" if row.failed else ""
        grid.add_row(*map(escape, row.values.values()), row.stop.reason, *cells, style=style)
    console.print(grid)


def _cell(name: str, value: float | int | None) -> str:
    if value is None:
        return "-"
    return f"{value:.1e}" if name == SHOWN[0] else f"{value:.4g}" if isinstance(value, float) else str(value)


@contextmanager
def _progress(runs: int, console: Console) -> Iterator[Watch | None]:
    """Function to call after each run; ``None`` without an interactive terminal."""
    begun, ended = perf_counter(), 0
    with counted(runs, "runs", "ETA -", console) as show:
        if show is None:
            yield None
            return

        def watch(row: Row, left: int) -> None:
            nonlocal ended
            ended += 1
            ahead = (perf_counter() - begun) * left / ended
            show(runs - left, f"{row.stop.reason}, ETA {ahead:.0f} s")

        yield watch
