"""events.csv: contact events of nodes (touch, release, stick, slip), changes of meshes, and findings, one line each."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np

from softway.marching.results.step import Event, Ledger, Step
from softway.marching.slab.step_group import StepGroup
from softway.record.storage import table
from softway.record.storage.table import Lines
from softway.record.write.recorder import RunStart

FILE = "events.csv"
COLUMNS = (
    ("time", "s"),
    ("contact", table.TEXT),
    ("kind", table.TEXT),
    ("node", table.COUNT),
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("normal_velocity_before", "m/s"),
    ("normal_velocity_after", "m/s"),
    ("impulse", "N s"),
)
"""Columns of every run."""
EXTRA = (("depth", "m"), ("finding", table.TEXT), ("bodies", table.TEXT))
"""Columns of the findings of the audit, and the bodies that touch; files of earlier versions lack them."""
MESH = "mesh"
"""Kind of the event of a solid whose mesh changes, with its name for the contact, no node and no place; the column of
findings tells the new number of nodes and cells, and of meshes that are replaced the measure that asked for it."""
HEAT = (("heat", "J"),)
"""Column of runs with contacts that pass heat: what has passed from the first body to the end of the slab of the event.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Events:
    """Open file ``events.csv``, with the labels of the contacts that pass heat."""

    lines: Lines
    passing: tuple[str, ...] = ()

    def take(self, step: Step) -> None:
        """Write the changes of meshes before a time step (slab) and the events inside it, in order of time."""
        if not (step.events or step.transfers or step.exchanges):
            return
        for event in sorted((*_changes(step), *step.events), key=lambda e: e.time):
            place = np.zeros(3)
            place[: len(event.position)] = event.position
            numbers = [
                float(x) for x in (*place, event.velocity_before, event.velocity_after, event.impulse, event.depth)
            ]
            texts = event.finding, "-".join(event.bodies)
            heat = [self._passed(event.contact, step.ledger)] if self.passing else []
            self.lines.write([float(event.time), event.contact, event.kind, int(event.node), *numbers, *texts, *heat])

    def _passed(self, contact: str, ledger: Ledger) -> float:
        """Heat that has passed a contact by the end of a slab [J]; not a number of others."""
        if ledger.heat is None or contact not in self.passing:
            return nan
        return float(ledger.heat.through[self.passing.index(contact)])

    def take_group(self, group: StepGroup) -> None:
        """Nothing: no events are in these slabs."""

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


def _changes(step: Step) -> Iterator[Event]:
    """Changes of meshes before a slab."""
    reasons = {**dict.fromkeys(step.transfers, ""), **{name: f": {one.reason}" for name, one in step.exchanges.items()}}
    for name, reason in reasons.items():
        mesh, d = step.model.meshes[name], step.model.shape[1]
        yield Event(
            time=step.slab.start,
            contact=name,
            kind=MESH,
            node=-1,
            position=np.zeros(d),
            velocity_before=0.0,
            velocity_after=0.0,
            impulse=0.0,
            finding=f"{mesh.n_nodes} nodes, {mesh.n_cells} cells{reason}",
        )


def open_events(folder: Path, opening: RunStart, mark: int | None = None) -> Events:
    """Create ``events.csv`` with its header, or continue the existing file."""
    rows, passing = table.lines(folder / FILE, mark), opening.passing_heat
    if mark is None:
        rows.write(table.header((*COLUMNS, *EXTRA, *(HEAT if passing else ()))))
    return Events(rows, passing)
