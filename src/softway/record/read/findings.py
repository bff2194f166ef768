"""Findings of a run, gathered by kind and bodies, and as sentences."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from softway.marching.results.finding import FLAT_CELL, INVERTED, KINDS, finding
from softway.marching.results.step import Event


def gathered(events: Iterable[Event]) -> list[dict[str, Any]]:
    """Findings by kind and pair, the first one first.

    An entry has ``kind``, ``between``, ``count``, the times ``first`` and ``last`` [s], the greatest ``depth`` [m], and
    the sentence ``text`` on the deepest or else the last one, of cells on the first one.

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
    last = found[0] if kind in (INVERTED, FLAT_CELL) else found[-1]
    worst = max(found, key=lambda event: event.depth) if any(event.depth for event in found) else last
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
