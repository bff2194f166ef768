"""Records of a mechanism: ``history.csv``, ``motion.csv`` and ``events.csv``."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import numpy as np

from softway.arrays import Array, IntArray
from softway.mechanisms.members.stops import StopEvent
from softway.mechanisms.step import MechanismGroup, MechanismStep
from softway.record.storage.line_files import LineFiles, Rows, open_files
from softway.record.storage.table import Cells, line_format
from softway.record.write import events, history
from softway.record.write.mechanism.columns import HISTORY, MOTION, SLABS, group_motion, motion_columns, motion_values
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
    probes = tuple((r.name, r.unit) for r in readings)
    units = ["s", SLABS[1], *(c.unit for c in HISTORY[1:]), *(unit for _, unit in probes)]
    moved = ["s", *(unit for name in names for _, unit in motion_columns(name, dim))]

    def told(one: MechanismStep | MechanismGroup, slabs: int) -> Iterator[Cells | bytes]:
        if isinstance(one, MechanismStep):
            yield [one.time, slabs, *(c.value(one) for c in HISTORY[1:]), *(r.value(one) for r in readings)]
            return
        states = [one.bodies(k) for k in range(len(one))] if readings else []
        read = [np.array([r.at(state) for state in states]) for r in readings]
        yield _block(units, [one.time, one.slabs, *(c.value(one) for c in HISTORY[1:]), *read])

    def motion(one: MechanismStep | MechanismGroup, slabs: int) -> Iterator[Cells | bytes]:
        if isinstance(one, MechanismStep):
            yield [one.time, *(x for state in one.bodies.values() for x in motion_values(state))]
        else:
            yield _block(moved, [one.time, *group_motion(one).T])

    heads = {
        history.FILE: (("time", "s"), SLABS, *((c.name, c.unit) for c in HISTORY[1:]), *probes),
        MOTION: (("time", "s"), *(column for name in names for column in motion_columns(name, dim))),
        events.FILE: (*events.COLUMNS, *events.EXTRA),
    }
    rows: dict[str, Rows] = {history.FILE: told, MOTION: motion, events.FILE: _happened}
    return open_files(folder, heads, rows, marks)


def _block(units: Sequence[str], columns: Sequence[Array | IntArray]) -> bytes:
    """Lines of columns (k,)."""
    table = np.stack(columns, axis=1)
    return (line_format(units) * len(table) % tuple(table.ravel().tolist())).encode()


def _happened(one: MechanismStep | MechanismGroup, slabs: int) -> Iterator[Cells]:
    for events_of in [one.events] if isinstance(one, MechanismStep) else one.events:
        for event in sorted(events_of, key=lambda e: e.time):
            yield _cells(event)


def _cells(event: StopEvent) -> Cells:
    """Cells of the line of an event: a stop has a name, but no node and no place of its own."""
    numbers = [float(x) for x in (event.velocity_before, event.velocity_after, event.impulse)]
    return [float(event.time), event.stop, event.kind, -1, NAN, NAN, NAN, *numbers, 0.0, "", ""]
