"""Records of a mechanism: ``history.csv``, ``motion.csv`` and ``events.csv``."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from softway.mechanisms.members.stops import StopEvent
from softway.mechanisms.step import MechanismStep
from softway.record.storage.line_files import LineFiles, Rows, open_files
from softway.record.storage.table import Cells
from softway.record.write import events, history
from softway.record.write.mechanism.columns import HISTORY, MOTION, SLABS, motion_columns, motion_values
from softway.record.write.mechanism.probes import BodyReading

NAN = float("nan")


def open_mechanism(
    folder: Path,
    names: Sequence[str],
    dim: int,
    readings: tuple[BodyReading, ...],
    marks: Mapping[str, int] = MappingProxyType({}),
) -> LineFiles:
    """Create the files of a mechanism of the bodies ``names`` in ``dim`` dimensions, with their headers.

    Those with ``marks`` exist: they are truncated to these lengths, and continued.
    """

    def told(step: MechanismStep, slabs: int) -> Iterator[Cells]:
        yield [step.time, slabs, *(c.value(step) for c in HISTORY[1:]), *(r.value(step) for r in readings)]

    probes = ((r.name, r.unit) for r in readings)
    heads = {
        history.FILE: (("time", "s"), SLABS, *((c.name, c.unit) for c in HISTORY[1:]), *probes),
        MOTION: (("time", "s"), *(column for name in names for column in motion_columns(name, dim))),
        events.FILE: (*events.COLUMNS, *events.EXTRA),
    }
    rows: dict[str, Rows] = {history.FILE: told, MOTION: _moved, events.FILE: _happened}
    return open_files(folder, heads, rows, marks)


def _moved(step: MechanismStep, slabs: int) -> Iterator[Cells]:
    yield [step.time, *(x for state in step.bodies.values() for x in motion_values(state))]


def _happened(step: MechanismStep, slabs: int) -> Iterator[Cells]:
    for event in sorted(step.events, key=lambda e: e.time):
        yield _cells(event)


def _cells(event: StopEvent) -> Cells:
    """Cells of the line of an event: a stop has a name, but no node and no place of its own."""
    numbers = [float(x) for x in (event.velocity_before, event.velocity_after, event.impulse)]
    return [float(event.time), event.stop, event.kind, -1, NAN, NAN, NAN, *numbers, 0.0, "", ""]
