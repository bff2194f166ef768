"""Deformable surfaces that certainly stay away from each other in a slab (time step): boxes around them, in loops."""

from functools import cache
from typing import NamedTuple

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.by_address import FLAGS, NUMBERS, ROWS, WHOLES, table
from softway.kernels.jit.compilation import Stage, called, uncounted_function_at
from softway.kernels.slab.tables import PART, bodies_at, course_at
from softway.tolerances import DECIDED


class Surfaces(NamedTuple):
    """Surfaces (k,) that may touch each other: their nodes ``start`` (k + 1,) and ``node`` (z,), the width by which
    they extend beyond the box of their nodes, ``swelling`` (k,), relative to it, and the greatest motion of a point,
    relative to that of the nodes, ``magnified`` (k,).

    ``one`` and ``other`` (p,) are pairs that may touch, with the ``distance`` (p,) of the search in a slab, of which
    ``raised`` (p,) is that at which they touch [m].  Pairs that are ``near`` (p,) have a row: they certainly stay
    within the distance, all others beyond it.  Work space are middles and motions of the boxes, ``centre`` and
    ``shift`` (k, d), their ``half`` widths (k, d), the ``spread`` (d,) of the motions, and how far the nodes
    ``strayed`` (k,) from the expected end.
    """

    start: IntArray
    node: IntArray
    swelling: Array
    magnified: Array
    one: IntArray
    other: IntArray
    distance: Array
    raised: Array
    near: BoolArray
    centre: Array
    shift: Array
    half: Array
    spread: Array
    strayed: Array


surfaces_at = table(
    "Surfaces",
    start=WHOLES,
    node=WHOLES,
    swelling=NUMBERS,
    magnified=NUMBERS,
    one=WHOLES,
    other=WHOLES,
    distance=NUMBERS,
    raised=NUMBERS,
    near=FLAGS,
    centre=ROWS,
    shift=ROWS,
    half=ROWS,
    spread=NUMBERS,
    strayed=NUMBERS,
)
"""The table at an address, for kernels."""


@cache
def apart() -> Stage:
    """Part that allows slabs in which no surfaces come near each other, and none of those near go away; their table is
    the sixth.
    """
    return uncounted_function_at(PART, _apart)


def _apart(slab):
    places, s = slab.places, slab.number
    return 1 if stay_apart(bodies_at(places[0]), course_at(places[3]), surfaces_at(places[5]), s) else 0


@called
def stay_apart(bodies, course, surfaces, s):
    """True if the search of the slab certainly finds no pairs but those that are near.

    It looks within ``distance`` of the way to the expected end.  If the end is farther than that from the expected one,
    it looks again, within twice the distance that was needed.
    """
    h = course.time[s + 1] - course.time[s]
    for k in range(len(surfaces.start) - 1):
        _boxed(bodies, course, surfaces, h, s, k)
    for i in range(bodies.dimension):
        low, high = surfaces.shift[0, i], surfaces.shift[0, i]
        for k in range(1, len(surfaces.start) - 1):
            low, high = min(low, surfaces.shift[k, i]), max(high, surfaces.shift[k, i])
        surfaces.spread[i] = high - low
    needed = 0.0
    for p in range(len(surfaces.one)):
        a, b = surfaces.one[p], surfaces.other[p]
        strayed = surfaces.magnified[a] * surfaces.strayed[a] + surfaces.magnified[b] * surfaces.strayed[b]
        needed = max(needed, surfaces.raised[p] + strayed)
    for p in range(len(surfaces.one)):
        distance = max(surfaces.distance[p], 2.0 * needed) / DECIDED
        if not (_close(surfaces, p) if surfaces.near[p] else _beside(bodies, surfaces, p, distance)):
            return False
    return needed < np.inf


@called
def _beside(bodies, surfaces, p, distance):
    """True if the boxes of a pair stay away from each other in one direction, by a distance.

    The search adds motions relative to a mean one, which are at most the spread of all motions.
    """
    a, b = surfaces.one[p], surfaces.other[p]
    for i in range(bodies.dimension):
        wide = surfaces.half[a, i] + surfaces.half[b, i] + surfaces.spread[i]
        if abs(surfaces.centre[a, i] - surfaces.centre[b, i]) > wide + distance:
            return True
    return False


@called
def _close(surfaces, p):
    """True if a pair of ends of bars is within half the distance of the search."""
    a, b = surfaces.one[p], surfaces.other[p]
    return abs(surfaces.centre[a, 0] - surfaces.centre[b, 0]) <= DECIDED * surfaces.distance[p]


@called
def _boxed(bodies, course, surfaces, h, s, k):
    """Box of a surface on its way to the expected end, and how far the end is from that."""
    d, most = bodies.dimension, 0.0
    for i in range(d):
        low0 = low1 = 1e300
        high0 = high1 = -1e300
        for e in range(surfaces.start[k], surfaces.start[k + 1]):
            c = surfaces.node[e] * d + i
            first = bodies.points[c] + course.u[s, c]
            last = bodies.points[c] + expected(bodies, course, h, s, c)
            low0, high0, low1, high1 = min(low0, first), max(high0, first), min(low1, last), max(high1, last)
        surfaces.centre[k, i] = 0.25 * (low0 + high0 + low1 + high1)
        surfaces.shift[k, i] = 0.5 * (low1 + high1 - low0 - high0)
        surfaces.half[k, i] = max(high0 - low0, high1 - low1) * (0.5 + surfaces.swelling[k])
    for e in range(surfaces.start[k], surfaces.start[k + 1]):
        total = 0.0
        for c in range(surfaces.node[e] * d, surfaces.node[e] * d + d):
            total += (course.u[s + 1, c] - expected(bodies, course, h, s, c)) ** 2
        most = max(most, total)
    surfaces.strayed[k] = most**0.5


@called
def expected(bodies, course, h, s, c):
    """Displacement of a component at the end of a slab, if its velocity goes on as before."""
    v = course.v[s, c]
    rate = v + h * course.slope[s, c] if bodies.place[c] >= 0 else bodies.given[c]
    return course.u[s, c] + h * (0.5 * (v + rate) if bodies.heavy[c] else rate) + bodies.bent[c]
