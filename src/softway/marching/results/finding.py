"""Findings: the kinds of events that say what is wrong in a march, where and when."""

from collections.abc import Iterable

import numpy as np

from softway.arrays import Array
from softway.marching.results.step import Event

OVERLAP, BETWEEN, INVERTED, FLAT_CELL = "overlap", "overlap between nodes", "inverted cell", "flat cell"
NO_EQUILIBRIUM, DISSIPATION = "no equilibrium", "dissipation"
ENERGY, MOMENTUM, SPIN = "energy", "momentum", "spin"
KINDS = (OVERLAP, BETWEEN, INVERTED, FLAT_CELL, NO_EQUILIBRIUM, DISSIPATION, ENERGY, MOMENTUM, SPIN)
"""Kinds: a node lies inside of another body, of a tool or of its own body; a place between nodes does; a cell is
inverted; a cell has become flat; massless nodes had no equilibrium; a slab gave dissipated energy back; a balance
misses; momentum or spin do not agree with the fields."""


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
