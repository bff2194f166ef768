"""Records of a pile: ``history.csv``, ``balls.f64`` and ``events.csv``."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from softway.piles.march import PileStep
from softway.record.pile import motion
from softway.record.pile.history import COLUMNS, NEEDED
from softway.record.storage.line_files import LineFiles, Rows, open_files
from softway.record.storage.table import Cells
from softway.record.write import events, history


def open_pile(folder: Path, marks: Mapping[str, int]) -> LineFiles:
    """Create the files of a pile; those with ``marks`` exist: they are truncated to these lengths, and continued.

    A pile has no events of its own: its history counts the touches.
    """
    heads = {history.FILE: NEEDED, motion.FILE: (), events.FILE: (*events.COLUMNS, *events.EXTRA)}
    rows: dict[str, Rows] = {history.FILE: _told, motion.FILE: motion.moved}
    return open_files(folder, heads, rows, marks)


def _told(step: PileStep, slabs: int) -> Iterator[Cells]:
    yield [column.value(step, slabs) for column in COLUMNS]
