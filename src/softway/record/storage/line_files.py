"""Tables and files of blocks that grow together: one recorder for all runs of rigid bodies and of balls."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softway.record.storage import table
from softway.record.storage.table import Cells, Lines

Rows = Callable[[Any, int], Iterable[Cells | bytes]]
"""Lines or blocks of a file of a step of a march, after a number of slabs (time steps)."""
Columns = Sequence[tuple[str, str]]
"""Names and units of columns; none for a file of blocks."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LineFiles:
    """Recorder that takes the steps of a march in order; its files are valid after each of them.

    Parameters
    ----------
    files
        Open files by name.
    rows
        What each of them gets of a step.
    """

    files: Mapping[str, Lines]
    rows: Mapping[str, Rows]

    def take(self, step: Any, slabs: int) -> None:
        """Write a step after a number of slabs (time steps)."""
        for name, rows in self.rows.items():
            for row in rows(step, slabs):
                self.files[name].write(row)

    def close(self) -> None:
        """Close the files."""
        with ExitStack() as closing:
            for lines in self.files.values():
                closing.callback(lines.close)


def open_files(
    folder: Path, heads: Mapping[str, Columns], rows: Mapping[str, Rows], marks: Mapping[str, int]
) -> LineFiles:
    """Create files with headers in a folder; those with ``marks`` are truncated to these lengths, and continued."""
    with ExitStack() as failing:
        opened = {}
        for name, columns in heads.items():
            opened[name] = table.lines(folder / name, marks.get(name))
            failing.callback(opened[name].close)
            if name not in marks and columns:
                opened[name].write(table.header(columns))
        failing.pop_all()
    return LineFiles(files=opened, rows=rows)
