"""Tables with units: comma-separated text that is written by whole lines, and its reader."""

import csv
import io
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softway.errors import InputError
from softway.html_tables import grid
from softway.record.storage.gate.own_files import plain_file

TEXT = "-"
"""Unit in the header of a column of strings."""
COUNT = "1"
"""Unit in the header of a column of integers."""
Cells = Sequence[str | int | float]
"""Cells of a line."""
WIDE, LONG = 13, 20
"""Maximum numbers of columns and rows that a notebook shows in full."""
RATIO = "ratio"
"""Unit in the header of a column of ratios."""


@dataclass(frozen=True, slots=True, eq=False)
class Table(Mapping[str, NDArray[Any]]):
    r"""Table of named columns with units; the arrays (rows,) are read-only.

    Examples
    --------
    >>> table = parse("time [s],contact [-]\n0.5,floor\n")
    >>> table["time"], table.units["time"], str(table["contact"][0]), table.rows
    (array([0.5]), 's', 'floor', 1)
    """

    columns: Mapping[str, NDArray[Any]]
    units: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self.columns:
            raise KeyError(f"no column {name!r}; known columns: {', '.join(self.columns)}")
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def __repr__(self) -> str:
        return f"Table({self.rows} rows: {', '.join(self.columns)})"

    def _repr_html_(self) -> str:
        """HTML for notebooks: the first rows; for many columns the first, last, least and greatest value of each."""
        if len(self) <= WIDE:
            lines = zip(*(self[name][:LONG].tolist() for name in self), strict=True)
            more = f", the first {LONG}" if self.rows > LONG else ""
            return grid(f"{self.rows} rows{more}", header([(n, self.units.get(n, "")) for n in self]), lines)
        ends = ((n, self.units.get(n, ""), *_ends(self[n])) for n in self)
        return grid(f"{self.rows} rows", ("column", "unit", "first", "last", "least", "greatest"), ends)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.columns.values()), ()))


def _ends(column: NDArray[Any]) -> tuple[object, ...]:
    """First, last, least and greatest value of a column."""
    if not len(column) or column.dtype.kind not in "if":
        return (*column[:1].tolist(), *column[-1:].tolist(), "", "")
    known = column[~np.isnan(column)] if column.dtype.kind == "f" else column
    ends = (known.min(), known.max()) if len(known) else (column[0], column[0])
    return tuple(x.item() for x in (column[0], column[-1], *ends))


def header(columns: Sequence[tuple[str, str]]) -> list[str]:
    """Cells ``name [unit]`` of the header line.

    Examples
    --------
    >>> header([("time", "s"), ("kind", TEXT)])
    ['time [s]', 'kind [-]']
    """
    return [f"{name} [{unit}]" for name, unit in columns]


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """File that grows by whole lines, each visible to readers at once."""

    file: io.FileIO

    @property
    def mark(self) -> int:
        """Length of the file [bytes]."""
        return self.file.tell()

    def write(self, row: Cells | bytes) -> None:
        """Append one line of cells, floats with all their digits, or a block of bytes as it is.

        Raises
        ------
        OSError
            If the disk is full; a part of the line may have been written.
        """
        rest = row if isinstance(row, bytes) else _line(row)
        while rest:
            rest = rest[self.file.write(rest) or 0 :]

    def sync(self) -> None:
        """Flush the lines to the disk."""
        os.fsync(self.file.fileno())

    def close(self) -> None:
        """Close the file."""
        self.file.close()


def line_format(units: Sequence[str]) -> str:
    r"""Format of a line of numbers as :meth:`Lines.write` writes it; the columns have these ``units``.

    Examples
    --------
    >>> line_format(["s", COUNT]) % (0.1, 2)
    '0.10000000000000001,2\n'
    """
    return ",".join("%d" if unit == COUNT else "%.17g" for unit in units) + "\n"


def _line(cells: Cells) -> bytes:
    """Line of cells in a file."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow([format(c, ".17g") if isinstance(c, float) else c for c in cells])
    return text.getvalue().encode()


def lines(path: Path, mark: int | None = None) -> Lines:
    """Create a file of lines, or open the existing one and truncate it to a mark.

    Raises
    ------
    InputError
        If the file is shorter than the mark.
    """
    if mark is None:
        return Lines(io.FileIO(path, "w"))
    size = path.stat().st_size if path.is_file() else 0
    if size < mark:
        problem = f"has {size} bytes, but {mark} at the checkpoint"
        raise InputError(str(path), problem, "a new run, or a copy of the file")
    file = io.FileIO(path, "r+")
    file.truncate(mark)
    file.seek(mark)
    return Lines(file)


def read(path: Path, needed: Sequence[tuple[str, str]] = ()) -> Table:
    """Read the table in a file, which may still grow: an incomplete last line is ignored.

    Raises
    ------
    InputError
        If the file is missing, is not a table, or lacks one of the ``needed`` columns.
    """
    remedy = "the unchanged run folder"
    try:
        found = parse(plain_file(path).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(str(path), "is missing", remedy) from None
    except (OSError, ValueError) as error:
        raise InputError(str(path), f"cannot be read: {error}", remedy) from None
    for name, _ in needed:
        if name not in found:
            raise InputError(str(path), f"has no column '{name}'", remedy)
    return found


def parse(text: str) -> Table:
    """Parse the table in a text."""
    whole = text[: text.rfind("\n") + 1]
    first, _, body = whole.partition("\n")
    heads = next(csv.reader([first]), [])
    if not heads:
        return Table({})
    names, units = zip(*(_split(cell) for cell in heads), strict=True)
    columns = None if TEXT in units else _numbers(body, names, units)
    if columns is None:
        rows = [line for line in csv.reader(body.splitlines()) if len(line) == len(names)]
        columns = {name: _column([row[k] for row in rows], units[k]) for k, name in enumerate(names)}
    return Table(MappingProxyType(columns), MappingProxyType(dict(zip(names, units, strict=True))))


def _numbers(body: str, names: Sequence[str], units: Sequence[str]) -> dict[str, NDArray[Any]] | None:
    """Columns of a table of numbers, whose cells are converted together; None if a line has other cells."""
    cells = body.rstrip("\n").replace("\n", ",").split(",") if body else []
    if len(cells) != body.count("\n") * len(names) or any(
        line.count(",") != len(names) - 1 for line in body.splitlines()
    ):
        return None
    try:
        values = np.fromiter(map(float, cells), float, len(cells)).reshape(-1, len(names)).T
    except ValueError:
        return None
    found = {}
    for name, unit, column in zip(names, units, values, strict=True):
        found[name] = np.array(column, np.int64 if unit == COUNT else float)
        found[name].flags.writeable = False
    return found


def _split(cell: str) -> tuple[str, str]:
    name, _, unit = cell.rpartition(" [")
    return name, unit.rstrip("]")


def _column(cells: list[str], unit: str) -> NDArray[Any]:
    kinds: Mapping[str, type] = {TEXT: str, COUNT: np.int64}
    column: NDArray[Any] = np.array(cells, dtype=kinds.get(unit, float))
    column.flags.writeable = False
    return column
