"""Loads, tools and supports that change with time: their values at both ends of a slab (time step)."""

from functools import cache
from typing import NamedTuple

from softway.arrays import Array, IntArray
from softway.kernels.jit.by_address import BLOCKS, NUMBERS, ROWS, WHOLES, table
from softway.kernels.jit.compilation import Stage, called, uncounted_function_at
from softway.kernels.slab.tables import PART, bodies_at, rows_at


class Drives(NamedTuple):
    """Loads and motions over successive slabs s.

    The load is the sum of ``field`` (k, N) with factors ``load_at`` (s + 1, k) at the ends of the slabs and
    ``load_mean`` (s, k) over them.  Row r is that of the tool of the number ``tool`` (M,), or -1, with the gap
    ``offset`` (M,) at t = 0 and the direction ``normal`` (M, d); the tools have moved by ``shift`` (s + 1, tools, d)
    since then.  Supports move the ``component`` (j,) with the velocities ``rate`` (s + 1, j), and by ``bent`` (s, j)
    beyond the way of linear velocities.
    """

    field: Array
    load_at: Array
    load_mean: Array
    tool: IntArray
    offset: Array
    normal: Array
    shift: Array
    component: IntArray
    rate: Array
    bent: Array


drives_at = table(
    "Drives",
    field=ROWS,
    load_at=ROWS,
    load_mean=ROWS,
    tool=WHOLES,
    offset=NUMBERS,
    normal=ROWS,
    shift=BLOCKS,
    component=WHOLES,
    rate=ROWS,
    bent=ROWS,
)
"""The table at an address, for kernels."""


@cache
def driven() -> Stage:
    """Part that sets loads, rows and supports of a slab; its table is the seventh."""
    return uncounted_function_at(PART, _driven)


def _driven(slab):
    places, s = slab.places, slab.number
    bodies, rows, drives = bodies_at(places[0]), rows_at(places[1]), drives_at(places[6])
    if len(drives.field):
        set_loads(bodies, drives, s)
    set_rows(rows, drives, s)
    for j in range(len(drives.component)):
        bodies.given[drives.component[j]] = drives.rate[s + 1, j]
        bodies.bent[drives.component[j]] = drives.bent[s, j]
    return 1


@called
def set_loads(bodies, drives, s):
    """Loads at both ends of a slab; on components with inertia their mean over it."""
    for c in range(len(bodies.load)):
        first, last = 0.0, 0.0
        for k in range(len(drives.field)):
            amount = drives.field[k, c]
            first += (drives.load_mean[s, k] if bodies.heavy[c] else drives.load_at[s, k]) * amount
            last += (drives.load_mean[s, k] if bodies.heavy[c] else drives.load_at[s + 1, k]) * amount
        bodies.load_before[c], bodies.load[c] = first, last


@called
def set_rows(rows, drives, s):
    """Gaps at zero displacement at both ends of a slab, and the motion of the tools in it."""
    for r in range(len(rows.offset)):
        tool = drives.tool[r]
        if tool >= 0:
            first = moved = 0.0
            for i in range(drives.normal.shape[1]):
                first += drives.normal[r, i] * drives.shift[s, tool, i]
                moved += drives.normal[r, i] * (drives.shift[s + 1, tool, i] - drives.shift[s, tool, i])
            rows.before[r] = drives.offset[r] - first
            rows.offset[r] = rows.before[r] - moved
            rows.moved[r] = moved
