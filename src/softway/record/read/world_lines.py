"""World lines: positions of nodes over time, with kinks at their contact events, and the space-time mesh."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray
from softway.marching.results.finding import KINDS
from softway.record.read.cells import Cells
from softway.record.read.frames import Frame
from softway.record.read.records import Records
from softway.record.write.events import MESH

SAME = 1e-9
"""Distance between the places at rest of a node in two meshes, relative to the size of all bodies, up to which it is
the same node."""


def kinks(run: Records) -> Mapping[int, Array]:
    """Time [s] and place [m] of the contact events, (k, 4) for each point of the fields; none where meshes change.

    An event gives the node number in its body, but not the body.  Among the bodies that have such a node, the one whose
    node was closest to the place of the event is taken.
    """
    if changes(run):
        return {}
    events, fields = run.events, run.fields
    rows = np.flatnonzero(~np.isin(events["kind"], (*KINDS, MESH)))
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


def changes(run: Records) -> bool:
    """True if the meshes of a run change."""
    return bool(run.fields.geometries.any())


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """Positions ``x`` (t, n) along an axis, and ``speed`` (2, n) at the first and the last of some ``times`` (t,), of
    the nodes of one geometry between ``begin`` and ``end``; ``key`` (n, 4) tells their places at rest and their bodies.
    """

    times: Array
    x: Array
    speed: Array
    key: Array
    begin: float
    end: float

    def line(self, node: int) -> Array:
        """Times and positions (t + 2, 2) of a node, from the beginning to the end with the speeds there."""
        first = self.x[0, node] + (self.begin - self.times[0]) * self.speed[0, node]
        last = self.x[-1, node] + (self.end - self.times[-1]) * self.speed[1, node]
        places = np.concatenate([[first], self.x[:, node], [last]])
        return np.column_stack([np.concatenate([[self.begin], self.times, [self.end]]), places])


def mesh_lines(run: Records, axis: int) -> list[Array]:
    """World lines of all nodes of a run whose meshes change, from the slab before which the mesh gets a node to that
    before which it loses it: times [s] and positions along an axis [m], (t, 2) each.
    """
    open_lines: dict[int, list[Array]] = {}
    done: list[list[Array]] = []
    before: _Piece | None = None
    for piece in _pieces(run, axis):
        kept = np.full(len(piece.key), -1) if before is None else _same_nodes(before.key, piece.key)
        lines = {node: [*open_lines.pop(int(old), []), piece.line(node)] for node, old in enumerate(kept)}
        done += open_lines.values()
        open_lines, before = lines, piece
    return [np.concatenate(line) for line in (*done, *open_lines.values())]


def _pieces(run: Records, axis: int) -> Iterator[_Piece]:
    """World lines between two changes of the geometry."""
    fields, times = run.fields, run.fields.times
    part = fields.geometries
    firsts = np.flatnonzero(np.diff(part, prepend=-1))
    lasts = np.append(firsts[1:] - 1, len(part) - 1)
    events = run.events
    changed = np.unique(events["time"][events["kind"] == MESH])
    begin = times[0]
    for first, last in zip(firsts, lasts, strict=True):
        frames = list(fields[int(first) : int(last) + 1])
        after = times[last + 1] if last + 1 < len(times) else times[last]
        between = changed[(changed >= times[last]) & (changed < after)]
        end = between[0] if len(between) else times[last]
        speed = np.array([frames[k].velocity[:, axis] for k in (0, -1)])
        x = np.array([frame.points[:, axis] for frame in frames])
        key = _keys(fields.cells_of(frames[0]))
        yield _Piece(times[first : last + 1], x, speed, key, float(begin), float(end))
        begin = between[-1] if len(between) else after


def _keys(cells: Cells) -> Array:
    """Places at rest and numbers of the bodies (n, 4) of all nodes, relative to the size of all bodies."""
    size = float(np.linalg.norm(np.ptp(cells.reference, axis=0)))
    body = np.zeros(len(cells.reference))
    body[cells.connectivity] = np.repeat(cells.body, np.diff(cells.offsets))
    return np.column_stack([cells.reference / size, body])


def _same_nodes(old: Array, new: Array) -> IntArray:
    """Number (n,) among the old nodes of each of the new ones; -1 where there was none."""
    distance, nearest = cKDTree(old).query(new)
    return np.where(distance <= SAME, nearest, -1)


def ends(run: Records, axis: int) -> tuple[Array, Array, Array]:
    """Positions [m] and velocities [m/s] along an axis of the lower and the upper end of all bodies at rest, (t, 2)
    each, and the least and the greatest position (2,) of all nodes.
    """
    found, most = [], np.array([np.inf, -np.inf])
    for frame, cells in run.fields.with_cells():
        nodes = _end_nodes(cells, axis)
        found.append(_at(frame, nodes, axis))
        along = frame.points[:, axis]
        most = np.array([min(most[0], along.min()), max(most[1], along.max())])
    both = np.array(found)
    return both[:, 0], both[:, 1], most


def _end_nodes(cells: Cells, axis: int) -> IntArray:
    along = cells.reference[:, axis]
    return np.array([np.argmin(along), np.argmax(along)])


def _at(frame: Frame, nodes: IntArray, axis: int) -> Array:
    return np.stack([frame.points[nodes, axis], frame.velocity[nodes, axis]])
