"""history.csv: one line for each accepted time step (slab), written before the next slab starts."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from softway.marching.results.step import Step
from softway.marching.slab.step_group import StepGroup
from softway.record.storage import table
from softway.record.storage.table import Lines
from softway.record.write.history_columns import Column, columns
from softway.record.write.recorder import RunStart

FILE = "history.csv"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class History:
    """Open file ``history.csv``; the probes of the start of the run follow its ``columns``.  ``line`` is its format."""

    lines: Lines
    columns: tuple[Column, ...]
    opening: RunStart
    line: str

    def take(self, step: Step) -> None:
        """Write the line of one slab: its energy and momentum audit, and the probes at its end."""
        values = [column.value(step) for column in self.columns]
        if self.opening.readings:
            motion, reactions = step.states.motion, step.reactions
            values += [r.value(motion, reactions) for r in self.opening.of(step).readings]
        self.lines.write((self.line % tuple(values)).encode())

    def take_group(self, group: StepGroup) -> None:
        """Write the lines of slabs that were compiled together."""
        count, numbers = len(group), group.numbers()
        values: list[Any] = [column.value(numbers) for column in self.columns]
        if self.opening.readings:
            motion, reactions = group.motion, group.reactions
            values += [r.values(motion, reactions) for r in self.opening.readings]
        rows = np.empty((count, len(values)))
        for k, value in enumerate(values):
            rows[:, k] = value
        self.lines.write((self.line * count % tuple(rows.ravel().tolist())).encode())

    @property
    def mark(self) -> int:
        """Length of the file [bytes]."""
        return self.lines.mark

    def sync(self) -> None:
        """Flush the lines to the disk."""
        self.lines.sync()

    def close(self) -> None:
        """Close the file."""
        self.lines.close()


def open_history(folder: Path, opening: RunStart, mark: int | None = None) -> History:
    """Create ``history.csv``, or continue the existing file; its first line is the initial state, with ``h = 0``."""
    ties = tuple(tie.label for tie in opening.scene.ties if tie.breaks is not None)
    heat = opening.ledger.heat
    contacts = tuple(c.label for c in opening.scene.contacts)
    of_heat = None if heat is None else (opening.passing_heat, tuple(heat.liquid), tuple(heat.rigid))
    rows, found = table.lines(folder / FILE, mark), columns(contacts, ties, of_heat, opening.adapts)
    if mark is None:
        rows.write(table.header([*((c.name, c.unit) for c in found), *((r.name, r.unit) for r in opening.readings)]))
        probes = [r.value(opening.initial, {}) for r in opening.readings]
        rows.write([*(column.initial(opening) for column in found), *probes])
    line = table.line_format([*(c.unit for c in found), *(r.unit for r in opening.readings)])
    return History(lines=rows, columns=found, opening=opening, line=line)
