"""World lines: positions of nodes over time, with kinks at their contact events."""

from collections.abc import Mapping

import numpy as np

from softway.arrays import Array, IntArray
from softway.record.read.findings import KINDS
from softway.record.read.records import Records


def kinks(run: Records) -> Mapping[int, Array]:
    """Time [s] and place [m] of the contact events, (k, 4) for each point of the fields.

    An event gives the node number in its body, but not the body.  Among the bodies that have such a node, the one whose
    node was closest to the place of the event is taken.
    """
    events, fields = run.events, run.fields
    rows = np.flatnonzero(~np.isin(events["kind"], KINDS))
    cells, times, node = fields.cells, fields.times, np.asarray(events["node"], int)[rows]
    starts = [
        int(cells.connectivity[cells.offsets[np.flatnonzero(cells.body == b)[0]] :].min())
        for b in range(len(cells.bodies))
    ]
    ends = [*starts[1:], len(cells.reference)]
    members = [[s + n for s, e in zip(starts, ends, strict=True) if s + n < e] for n in node]
    numbers = np.unique(np.array([n for each in members for n in each], int))
    track = np.array([frame.points[numbers] for frame in fields])
    found: dict[int, list[Array]] = {}
    for row, near in zip(rows, members, strict=True):
        time, place = events["time"][row], np.array([events[c][row] for c in "xyz"])
        paths = [track[:, np.searchsorted(numbers, n)] for n in near]
        then = [[np.interp(time, times, path[:, i]) for i in range(3)] for path in paths]
        owner = near[int(np.argmin(np.linalg.norm(np.array(then) - place, axis=1)))]
        found.setdefault(owner, []).append(np.array([time, *place]))
    return {number: np.array(rows) for number, rows in found.items()}


def world_lines(run: Records, numbers: IntArray, axis: int) -> list[Array]:
    """Times [s] and positions along an axis [m], (t, 2) for each of the points ``numbers`` (k,), including kinks."""
    times = run.fields.times
    track = np.array([frame.points[numbers, axis] for frame in run.fields])
    bent, lines = kinks(run), []
    for column, number in enumerate(numbers):
        line = np.column_stack([times, track[:, column]])
        if number in bent:
            line = np.concatenate([line, bent[number][:, [0, 1 + axis]]])
            line = line[np.argsort(line[:, 0], kind="stable")]
        lines.append(line)
    return lines
