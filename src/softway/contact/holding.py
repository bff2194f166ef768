"""Rows that keep their faces and edges while a slab is solved, and gather those that turn out to be missing.

A node that goes to and fro between two faces, or an edge that comes and goes, would keep an iteration from settling.
Kept rows do not change any more; where the answer still overlaps, the rows found there are added, so that the set only
grows.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.contact.edges import EdgeMeeting, crossings, edge_stencils
from softway.contact.meeting import Held, Meeting
from softway.contact.slave_pairs import Pairs
from softway.contact.stencils import Stencils
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldEdges:
    """Pairs of edges that do not change, taken as endless lines."""

    edges: EdgeMeeting

    @property
    def found(self) -> int:
        """Pairs that are kept."""
        return len(self.edges.row)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions ``x`` (n, 3)."""
        edges = self.edges
        return edge_stencils(edges, crossings(x, edges.one, edges.two), np.arange(len(edges.row)), len(x))


def held(meeting: Meeting | EdgeMeeting, x: Array, before: Held | HeldEdges | None) -> Held | HeldEdges:
    """A meeting with its rows kept as they are at ``x`` (n, d), added to those that were kept ``before``."""
    if isinstance(meeting, EdgeMeeting):
        live = meeting.live(crossings(x, meeting.one, meeting.two))
        now = HeldEdges(edges=meeting.take(live))
        return _more_edges(before.edges, now.edges) if isinstance(before, HeldEdges) else now
    found = meeting.held(x)
    return _more_faces(before, found, meeting.slots) if isinstance(before, Held) else found


def _more_edges(old: EdgeMeeting, new: EdgeMeeting) -> HeldEdges:
    """The kept edges, with a pair for each row that had none."""
    fresh = np.flatnonzero(~np.isin(new.row, old.row))
    row = np.concatenate([old.row, new.row[fresh]])
    order = np.argsort(row, kind="stable")
    one = old.one.joined(new.one.take(fresh)).take(order)
    two = old.two.joined(new.two.take(fresh)).take(order)
    return HeldEdges(edges=EdgeMeeting(row=row[order], one=one, two=two, count=old.count))


def _more_faces(old: Held, new: Held, slots: int) -> Held:
    """The kept faces, with the new ones of every node in its free slots."""
    a, b = old.pairs, new.pairs
    size = 1 + max(int(a.facet.max(initial=0)), int(b.facet.max(initial=0)))
    fresh = np.flatnonzero(~np.isin(b.slave * size + b.facet, a.slave * size + a.facet))
    used = set(old.rows.tolist())
    chosen, rows = [], []
    for i in fresh.tolist():
        first = int(b.slave[i]) * slots
        free = next((r for r in range(first, first + slots) if r not in used), None)
        if free is not None:
            used.add(free)
            chosen.append(i)
            rows.append(free)
    more = b.take(np.array(chosen, int))
    every = np.concatenate([old.rows, np.array(rows, int)])
    order = np.argsort(every, kind="stable")
    joined = Pairs(
        side=a.side,
        slave=np.concatenate([a.slave, more.slave]),
        node=np.concatenate([a.node, more.node]),
        facet=np.concatenate([a.facet, more.facet]),
    )
    return replace(old, pairs=joined.take(order), rows=every[order])
