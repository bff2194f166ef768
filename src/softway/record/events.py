"""events.csv: one line for each node that touched or let go."""

from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np

from softway.march.step import Step
from softway.record import table
from softway.record.recorder import Opening

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


@dataclass(frozen=True, slots=True, eq=False)
class Events:
    """The open file."""

    stream: TextIO

    def take(self, step: Step) -> None:
        """Write the events inside one slab, in order of time."""
        for event in sorted(step.events, key=lambda e: e.time):
            place = np.zeros(3)
            place[: len(event.position)] = event.position
            numbers = [float(x) for x in (*place, event.velocity_before, event.velocity_after, event.impulse)]
            table.write(self.stream, [float(event.time), event.contact, event.kind, int(event.node), *numbers])

    def close(self) -> None:
        """Close the file."""
        self.stream.close()


def open_events(folder: Path, opening: Opening) -> Events:
    """Start ``events.csv`` with its header."""
    stream = (folder / FILE).open("w", encoding="utf-8", newline="")
    table.write(stream, table.header(COLUMNS))
    return Events(stream)
