"""Which facets count for a slave."""

from dataclasses import dataclass

import numpy as np

from softway.contact.facets import nearest
from softway.contact.sight import BEHIND, EDGE, SMOOTH, Sight, dip
from softway.contact.slave_pairs import firsts
from softway.kernels.closest import dot
from softway.typing import Array, BoolArray, IntArray

SAME = 1e-9
"""Share of the size of a facet by which distances are told apart."""
PARALLEL = float(np.cos(np.deg2rad(5.0)))
"""Facets whose normals differ by less than five degrees are one condition."""
HINGE = 0.1
"""Share of the size of a facet within which a slave beyond its concave edge counts for both facets of the edge."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Choice:
    """The pair (count, slots) of every row, -1 for none, and which facets (p,) are ``extended`` over an edge."""

    pair: IntArray
    extended: BoolArray


def choose(seen: Sight, count: int, slots: int, start: Array, above: Array) -> Choice:
    """The facets of ``count`` slaves with so many slots each.

    ``start`` (n, d) are the positions when the slab began, ``above`` (p,) the heights of the slaves at that time [m].
    """
    slave = seen.pairs.slave
    pair, extended = np.full((count, slots), -1), np.zeros(len(slave), dtype=bool)
    found = _nearest(seen, start, extended)
    pair[slave[found], 0] = found
    struck = _struck(seen, found, start, above, extended)
    pair[slave[struck], 0] = struck
    for slot in range(1, slots):
        found = _further(seen, pair[:, :slot], start, extended) if len(found) else found
        pair[slave[found], slot] = found
    return Choice(pair=pair, extended=extended)


def _nearest(seen: Sight, start: Array, extended: BoolArray) -> IntArray:
    """The nearest facet of each slave; of equally near ones that with the least gap, then with the greatest height.

    Marks those that are extended over an edge.
    """
    slave, least = seen.pairs.slave, seen.pairs.least(seen.distance)
    close = np.flatnonzero(seen.distance <= least + SAME * seen.size)
    edge = close[~seen.inner[close]]
    extended[edge] = seen.came_over(edge, start) | seen.within(edge)
    gap = np.where(seen.inner | extended, seen.height, least)[close]
    order = close[np.lexsort((-seen.height[close], gap, slave[close]))]
    return order[firsts(slave[order])]


def _struck(seen: Sight, first: IntArray, start: Array, above: Array, extended: BoolArray) -> IntArray:
    """The facets that slaves crossed on their straight way, where their nearest facets do not show it.

    The nearest facet shows it when its gap is negative; and nothing happened when it continues the crossed facet
    smoothly: the slave slid over a convex piece of surface.  Marks crossed facets without feet as extended.
    """
    slave, own = seen.pairs.slave, seen.inner | extended
    safe = first[~own[first] | (seen.height[first] >= 0.0)]
    shown = np.full(slave.max(initial=0) + 1, -1)
    shown[slave[safe]] = safe
    pair = np.flatnonzero((seen.height < 0.0) & (above > -BEHIND * seen.size) & (shown[slave] >= 0))
    other = shown[slave[pair]]
    away = seen.feet.offset[other] / np.where(own[other], 1.0, seen.distance[other])[:, None]
    out = np.where(own[other, None], seen.feet.normal[other], away)
    cosine, way = dot(seen.feet.normal[pair], out), seen.centre(pair) - seen.foot(other)
    rise = dot(out, way) - dip(cosine) * np.sqrt(dot(way, way))
    pair = pair[(cosine < SMOOTH) | (rise > BEHIND * seen.size[pair])]
    share = np.maximum(above[pair], 0.0) / (np.maximum(above[pair], 0.0) - seen.height[pair])
    hit = _crossed(seen, pair, start, share)
    pair = pair[hit][np.lexsort((share[hit], slave[pair[hit]]))]
    pair = pair[firsts(slave[pair])]
    extended[pair] = ~seen.inner[pair]
    return pair


def _crossed(seen: Sight, pair: IntArray, start: Array, share: Array) -> BoolArray:
    """Whether the feet of slaves lie on their facets after a ``share`` of the way from the start."""
    pairs = seen.pairs.take(pair)
    points, nodes = (
        start[k] + share.reshape(-1, *[1] * k.ndim) * (seen.x[k] - start[k]) for k in (pairs.node, pairs.masters)
    )
    feet = pairs.look(points, nodes, nearest)
    beyond = feet.offset - dot(feet.normal, feet.offset)[:, None] * feet.normal
    return np.asarray(dot(beyond, beyond) <= (EDGE * seen.size[pair]) ** 2)


def _further(seen: Sight, before: IntArray, start: Array, extended: BoolArray) -> IntArray:
    """The next facet of some slaves: one that faces those of the slots ``before`` (count, k) at an angle.

    The slave is over it, or was when the slab began, or is over the other facet of their common edge; the two latter
    are marked as extended.
    """
    slave = seen.pairs.slave
    pair, joined = np.arange(len(slave)), seen.inner
    for slot in before.T:
        other = slot[slave[pair]]
        turned = (other >= 0) & (dot(seen.feet.normal[pair], seen.feet.normal[other]) < PARALLEL)
        pair, other, joined = pair[turned], other[turned], joined[turned]
        close = np.abs(dot(seen.beyond[pair], seen.feet.offset[pair])) <= HINGE * seen.size[pair]
        facing = seen.faces(pair, other)
        joined = (joined | (close & seen.hinged(pair, other)))[facing]
        pair = pair[facing]
    pair = pair[joined | seen.came_over(pair, start)]
    pair = pair[np.lexsort((seen.distance[pair], slave[pair]))]
    pair = pair[firsts(slave[pair])]
    extended[pair] = ~seen.inner[pair]
    return pair
