"""Findings of the audit: the kinds of events that say what is wrong in a run, where and when."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.marching.results.step import Event

OVERLAP, BETWEEN, INVERTED = "overlap", "overlap between nodes", "inverted cell"
DISSIPATION, ENERGY, MOMENTUM, SPIN = "dissipation", "energy", "momentum", "spin"
KINDS = (OVERLAP, BETWEEN, INVERTED, DISSIPATION, ENERGY, MOMENTUM, SPIN)
"""Kinds: a node lies inside of another body, of a tool or of its own body; a place between nodes does; a cell is
inverted; a slab gave dissipated energy back; a balance misses; momentum or spin do not agree with the fields."""


def finding(
    time: float,
    kind: str,
    between: Iterable[str],
    text: str,
    *,
    node: int = -1,
    place: Array | None = None,
    depth: float = 0.0,
) -> Event:
    """Finding as an event.

    Parameters
    ----------
    time
        Instant [s].
    kind
        One of ``KINDS``.
    between
        Names of what is concerned: two bodies, a body and a tool, or one body; ``all`` for a balance.
    text
        One sentence.
    node
        Node in the numbering of the first body; -1 if there is none.
    place
        (d,) place [m]; by default none.
    depth
        Depth of an overlap [m].

    Examples
    --------
    >>> found = finding(0.5, "overlap", ("ball", "floor"), "node 3 is 0.01 m inside 'floor'", node=3, depth=0.01)
    >>> found.contact, found.kind, found.depth
    ('ball-floor', 'overlap', 0.01)
    """
    return Event(
        time=time,
        contact="-".join(between),
        kind=kind,
        node=node,
        position=np.zeros(3) if place is None else place,
        velocity_before=0.0,
        velocity_after=0.0,
        impulse=0.0,
        depth=depth,
        finding=text,
    )


def gathered(events: Iterable[Event]) -> list[dict[str, Any]]:
    """Findings by kind and pair, the first one first.

    An entry has ``kind``, ``between``, ``count``, the times ``first`` and ``last`` [s], the greatest ``depth`` [m], and
    the sentence ``text`` on the deepest or else the last one.

    Examples
    --------
    >>> found = [finding(t, "overlap", ("a", "b"), f"{t} m", depth=t) for t in (0.1, 0.3, 0.2)]
    >>> [(e["between"], e["count"], e["depth"], e["text"]) for e in gathered(found)]
    [('a-b', 3, 0.3, '0.3 m')]
    """
    rows: dict[tuple[str, str], list[Event]] = {}
    for event in events:
        rows.setdefault((event.kind, event.contact), []).append(event)
    return [_entry(kind, between, found) for (kind, between), found in rows.items()]


def _entry(kind: str, between: str, found: list[Event]) -> dict[str, Any]:
    worst = max(found, key=lambda event: event.depth) if any(event.depth for event in found) else found[-1]
    return {
        "kind": kind,
        "between": between,
        "count": len(found),
        "first": found[0].time,
        "last": found[-1].time,
        "depth": worst.depth,
        "text": worst.finding,
    }


def sentences(found: Iterable[Mapping[str, Any]]) -> list[str]:
    """One sentence for each entry of :func:`gathered`, with its times.

    Examples
    --------
    >>> sentences(gathered([finding(0.25, "overlap", ("a", "b"), "node 3 of 'a' is 0.01 m inside 'b'")]))
    ["node 3 of 'a' is 0.01 m inside 'b' (overlap, at 0.25 s)"]
    """
    return [f"{one['text']} ({one['kind']}, {_when(one)})" for one in found]


def _when(one: Mapping[str, Any]) -> str:
    if one["count"] == 1:
        return f"at {one['first']:.6g} s"
    return f"from {one['first']:.6g} to {one['last']:.6g} s"


def stored(events: Mapping[str, Any]) -> list[Event]:
    """Findings in a table of events; none in those of earlier versions."""
    if "finding" not in events:
        return []
    rows = np.flatnonzero(np.isin(events["kind"], KINDS))
    return [
        finding(
            float(events["time"][k]),
            str(events["kind"][k]),
            (str(events["contact"][k]),),
            str(events["finding"][k]),
            node=int(events["node"][k]),
            place=np.array([events[axis][k] for axis in "xyz"]),
            depth=float(events["depth"][k]),
        )
        for k in rows
    ]
