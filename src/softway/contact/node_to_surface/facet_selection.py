"""Selection of the facets that are active for a slave node."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.node_to_surface.facet_projection import BEHIND, EDGE, SMOOTH, FacetProjection, convex_drop
from softway.contact.node_to_surface.pairs import firsts
from softway.contact.surfaces.facet_geometry import nearest
from softway.kernels.geometry.closest_points import dot

SAME = 1e-9
"""Fraction of the size of a facet below which distances are equal."""
PARALLEL = float(np.cos(np.deg2rad(5.0)))
"""Cosine of five degrees: facets whose normals differ by less make one condition."""
HINGE = 0.1
"""Distance from a concave edge, as a fraction of the facet size, within which both facets of the edge are active."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetChoice:
    """Pair (count, slots) of every row, -1 for none, and facets (p,) that are ``extended`` over an edge."""

    pair: IntArray
    extended: BoolArray


def choose_facets(seen: FacetProjection, count: int, slots: int, start: Array, above: Array) -> FacetChoice:
    """Choose the facets of ``count`` slaves with ``slots`` rows each.

    ``start`` (n, d) are the positions at the start of the slab, ``above`` (p,) the heights of the slaves there [m].
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
    return FacetChoice(pair=pair, extended=extended)


def _nearest(seen: FacetProjection, start: Array, extended: BoolArray) -> IntArray:
    """Nearest facet of each slave; among equally near ones that with the least gap, then with the greatest height.

    Marks facets that are extended over an edge.
    """
    slave, least = seen.pairs.slave, seen.pairs.least(seen.distance)
    close = np.flatnonzero(seen.distance <= least + SAME * seen.size)
    edge = close[~seen.inner[close]]
    extended[edge] = seen.came_over(edge, start) | seen.within(edge)
    gap = np.where(seen.inner | extended, seen.height, least)[close]
    order = close[np.lexsort((-seen.height[close], gap, slave[close]))]
    return order[firsts(slave[order])]


def _struck(seen: FacetProjection, first: IntArray, start: Array, above: Array, extended: BoolArray) -> IntArray:
    """Facets that slaves crossed on their straight paths, if the nearest facets do not show it.

    The nearest facet shows it if its gap is negative.  If it continues the crossed facet smoothly, the slave slid over
    a convex surface and crossed nothing.  Marks crossed facets without feet as extended.
    """
    slave, own = seen.pairs.slave, seen.inner | extended
    safe = first[~own[first] | (seen.height[first] >= 0.0)]
    shown = np.full(slave.max(initial=0) + 1, -1)
    shown[slave[safe]] = safe
    pair = np.flatnonzero((seen.height < 0.0) & (above > -BEHIND * seen.size) & (shown[slave] >= 0))
    other = shown[slave[pair]]
    away = seen.feet.offset[other] / np.where(own[other], 1.0, seen.distance[other])[:, None]
    out = np.where(own[other, None], seen.feet.normal[other], away)
    cosine, path = dot(seen.feet.normal[pair], out), seen.centre(pair) - seen.foot(other)
    rise = dot(out, path) - convex_drop(cosine) * np.sqrt(dot(path, path))
    pair = pair[(cosine < SMOOTH) | (rise > BEHIND * seen.size[pair])]
    fraction = np.maximum(above[pair], 0.0) / (np.maximum(above[pair], 0.0) - seen.height[pair])
    hit = _crossed(seen, pair, start, fraction)
    pair = pair[hit][np.lexsort((fraction[hit], slave[pair[hit]]))]
    pair = pair[firsts(slave[pair])]
    extended[pair] = ~seen.inner[pair]
    return pair


def _crossed(seen: FacetProjection, pair: IntArray, start: Array, fraction: Array) -> BoolArray:
    """True where the foot of a slave lies on its facet after a ``fraction`` of the path from the start."""
    pairs = seen.pairs.subset(pair)
    points, nodes = (
        start[k] + fraction.reshape(-1, *[1] * k.ndim) * (seen.x[k] - start[k]) for k in (pairs.node, pairs.masters)
    )
    feet = pairs.closest_points(points, nodes, nearest)
    beyond = feet.offset - dot(feet.normal, feet.offset)[:, None] * feet.normal
    return np.asarray(dot(beyond, beyond) <= (EDGE * seen.size[pair]) ** 2)


def _further(seen: FacetProjection, before: IntArray, start: Array, extended: BoolArray) -> IntArray:
    """Next facet of slaves: one that faces the facets of the slots ``before`` (count, k) at an angle.

    The slave is above it, or was so at the start of the slab, or is above the other facet of their common edge; in the
    last two cases the facet is marked as extended.
    """
    slave = seen.pairs.slave
    pair, joined = np.arange(len(slave)), seen.inner
    for slot in before.T:
        other = slot[slave[pair]]
        turned = (other >= 0) & (dot(seen.feet.normal[pair], seen.feet.normal[other]) < PARALLEL)
        pair, other, joined = pair[turned], other[turned], joined[turned]
        close = np.abs(dot(seen.beyond[pair], seen.feet.offset[pair])) <= HINGE * seen.size[pair]
        facing = seen.mutually_facing(pair, other)
        joined = (joined | (close & seen.hinged(pair, other)))[facing]
        pair = pair[facing]
    pair = pair[joined | seen.came_over(pair, start)]
    pair = pair[np.lexsort((seen.distance[pair], slave[pair]))]
    pair = pair[firsts(slave[pair])]
    extended[pair] = ~seen.inner[pair]
    return pair
