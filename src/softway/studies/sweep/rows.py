"""Table of a sweep, with one row per run, read from its folder."""

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path

from softway.html_tables import grid
from softway.record.read.summary import UNITS
from softway.record.run import Run
from softway.record.storage.atomic_file import replaced
from softway.record.storage.provenance import DONE, FILE, RUNNING, Stop
from softway.record.storage.table import COUNT, TEXT, Table, header, read
from softway.studies.sweep.attempt import Attempt

NAME = "sweep.csv"
WAITING = Stop("waiting")


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """Row of the table of a sweep: one run.

    Parameters
    ----------
    values
        Values of the swept parameters by path, as text.
    folder
        Folder of the run; it does not exist if the run was refused.
    stop
        Reason why the run stopped; ``waiting`` if it has not started.
    numbers
        Numbers of the summary by name: ``energy_error_relative``, ``certificate.min_gap``, ``contact.wall.impulse``.
    """

    values: Mapping[str, str]
    folder: Path
    stop: Stop
    numbers: Mapping[str, float | int | None]

    @property
    def failed(self) -> bool:
        """True if the run failed."""
        return self.stop.reason == "failed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """Result of a sweep: its runs and their table.

    Parameters
    ----------
    path
        Folder of the sweep, with a folder for each run and the table ``sweep.csv``.
    rows
        Runs in the order of the values; the last path varies fastest.
    """

    path: Path
    rows: tuple[Row, ...]

    def _repr_html_(self) -> str:
        """HTML table for notebooks; ``table`` has all numbers."""
        numbers = ("slabs", "energy_error_relative", "wall_time")
        paths = list(self.rows[0].values) if self.rows else []
        lines = (
            (*row.values.values(), row.stop.reason, *(row.numbers.get(n, "") for n in numbers)) for row in self.rows
        )
        return grid(f"Sweep in {self.path}", (*paths, "stop", "slabs", "energy error", "wall time [s]"), lines)

    @property
    def failed(self) -> tuple[Row, ...]:
        """Runs that failed."""
        return tuple(row for row in self.rows if row.failed)

    @property
    def table(self) -> Table:
        """Columns by name, with units: the values as text, ``stop``, ``reason``, ``run``, and the numbers."""
        return read(self.path / NAME)


def row_of(attempt: Attempt, complaint: str = "", wall: float = nan) -> Row:
    """Row of a run, read from its folder; ``complaint`` and wall time ``wall`` [s] are not recorded there."""
    stop, found = attempt.stop, {}
    if complaint and (stop is None or stop in (DONE, RUNNING) or not stop.message):
        stop = Stop("failed", complaint)
    if (attempt.folder / FILE).is_file():
        found = {"wall_time": wall, **_numbers(Run(attempt.folder).summary)}
    return Row(values=dict(attempt.trial.values), folder=attempt.folder, stop=stop or WAITING, numbers=found)


def save(sweep: Sweep) -> None:
    """Write the table atomically; missing numbers are ``nan`` and missing counts 0."""
    columns = list(dict.fromkeys(name for row in sweep.rows for name in row.numbers))
    counts = {n for row in sweep.rows for n, v in row.numbers.items() if isinstance(v, int)}
    units = {name: COUNT if name in counts else UNITS.get(name.rpartition(".")[2], COUNT) for name in columns}
    text = io.StringIO()
    write = csv.writer(text, lineterminator="\n").writerow
    words = [(name, TEXT) for name in (*sweep.rows[0].values, "stop", "reason", "run")]
    write(header(words + list(units.items())))
    for row in sweep.rows:
        cells = [_cell(row.numbers.get(name), units[name] == COUNT) for name in columns]
        message = " ".join(row.stop.message.split())
        write([*row.values.values(), row.stop.reason, message, row.folder.name, *cells])
    replaced(sweep.path / NAME, text.getvalue().encode())


def _cell(number: float | int | None, count: bool) -> str:
    if number is None:
        return "0" if count else "nan"
    return str(number) if isinstance(number, int) else format(number, ".17g")


def _numbers(summary: Mapping[str, object], prefix: str = "") -> dict[str, float | int | None]:
    """Numbers of a summary, its certificate and its contacts, in one flat mapping."""
    found: dict[str, float | int | None] = {}
    for name, value in summary.items():
        if isinstance(value, Mapping) and name != "units":
            found |= _numbers(value, "contact." if name == "contacts" else f"{prefix}{name}.")
        elif value is None or (isinstance(value, int | float) and not isinstance(value, bool)):
            found[prefix + name] = value
    return found


def ordered(attempts: Sequence[Attempt], rows: Mapping[str, Row]) -> tuple[Row, ...]:
    """Rows in the order of the attempts; missing rows are read from the folders."""
    return tuple(rows.get(a.trial.name) or row_of(a) for a in attempts)
