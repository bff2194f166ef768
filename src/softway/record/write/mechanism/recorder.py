"""Recorder of a mechanism: it takes the steps of a march in order, and its files are valid after each of them."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from softway.mechanisms.march import MechanismStep
from softway.mechanisms.members.stops import StopEvent
from softway.record.storage import table
from softway.record.storage.table import Lines
from softway.record.write import events, history
from softway.record.write.mechanism.columns import HISTORY, MOTION, SLABS, motion_columns, motion_values
from softway.record.write.mechanism.probes import BodyReading

NAN = float("nan")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MechanismRecorder:
    """Open files ``history.csv``, ``motion.csv`` and ``events.csv`` of a mechanism.

    Parameters
    ----------
    history, motion, events
        The files.
    readings
        Resolved probes, columns of the history.
    """

    history: Lines
    motion: Lines
    events: Lines
    readings: tuple[BodyReading, ...]

    @property
    def files(self) -> Mapping[str, Lines]:
        """The files by name."""
        return {history.FILE: self.history, MOTION: self.motion, events.FILE: self.events}

    def take(self, step: MechanismStep, slabs: int) -> None:
        """Write the lines of a step after a number of slabs (time steps)."""
        probes = [reading.value(step) for reading in self.readings]
        self.history.write([step.time, slabs, *(c.value(step) for c in HISTORY[1:]), *probes])
        self.motion.write([step.time, *(x for state in step.bodies.values() for x in motion_values(state))])
        for event in sorted(step.events, key=lambda e: e.time):
            self.events.write(_cells(event))

    def close(self) -> None:
        """Close the files."""
        with ExitStack() as closing:
            for lines in self.files.values():
                closing.callback(lines.close)


def _cells(event: StopEvent) -> list[str | int | float]:
    """Cells of the line of an event: a stop has a name, but no node and no place of its own."""
    numbers = [float(x) for x in (event.velocity_before, event.velocity_after, event.impulse)]
    return [float(event.time), event.stop, event.kind, -1, NAN, NAN, NAN, *numbers, 0.0, ""]


def open_mechanism(
    folder: Path,
    names: Sequence[str],
    dim: int,
    readings: tuple[BodyReading, ...],
    marks: Mapping[str, int] = MappingProxyType({}),
) -> MechanismRecorder:
    """Create the files of a mechanism of the bodies ``names`` in ``dim`` dimensions, with their headers.

    Those with ``marks`` exist: they are truncated to these lengths, and continued.
    """
    heads = {
        history.FILE: (("time", "s"), SLABS, *((c.name, c.unit) for c in HISTORY[1:])),
        MOTION: (("time", "s"), *(column for name in names for column in motion_columns(name, dim))),
        events.FILE: (*events.COLUMNS, *events.EXTRA),
    }
    heads[history.FILE] = (*heads[history.FILE], *((r.name, r.unit) for r in readings))
    with ExitStack() as failing:
        opened = {}
        for name, columns in heads.items():
            opened[name] = table.lines(folder / name, marks.get(name))
            failing.callback(opened[name].close)
            if name not in marks:
                opened[name].write(table.header(columns))
        failing.pop_all()
    return MechanismRecorder(
        history=opened[history.FILE], motion=opened[MOTION], events=opened[events.FILE], readings=readings
    )
