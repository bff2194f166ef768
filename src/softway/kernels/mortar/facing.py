"""Pairs of simplices that may touch in a slab: those that face each other, neither too deep nor too far."""

from typing import NamedTuple

import numpy as np

from softway.arrays import Array
from softway.kernels.jit.compilation import inlined, unfused_kernel


class Side(NamedTuple):
    """Simplices of one surface: corners ``start`` and ``end`` (d, k, p), unit normals ``normal`` and ``last`` (d, p) at
    both, longest edges ``size`` (p,), displacements ``motion`` (d, p) of the centres, and thickness ``wall`` (p,) of
    the bodies behind them [m].
    """

    start: Array
    end: Array
    normal: Array
    last: Array
    size: Array
    motion: Array
    wall: Array


class Limits(NamedTuple):
    """Greatest product of normals ``angle``; overlap that is taken for contact, in sizes of the simplices, ``deep``,
    and in thicknesses of the bodies, ``part``; ``reach`` in front of the slave [m], and distance ``few``, in sizes, at
    which a pair is considered.
    """

    angle: float
    deep: float
    part: float
    reach: float
    few: float


@unfused_kernel
def facing(slave, master, i, j, limits, kept, limit):
    """Write the numbers ``kept`` of the pairs i, j (s,) that may touch, and the greatest distance ``limit`` at which
    each is considered [m]; returns how many there are.
    """
    d = slave.start.shape[0]
    count, between = 0, np.empty((d, 1))
    for s in range(len(i)):
        one, two, dot = i[s], j[s], 0.0
        for x in range(d):
            dot += slave.normal[x, one] * master.normal[x, two]
        if not dot <= limits.angle:
            continue
        size = max(slave.size[one], master.size[two])
        deep = limits.deep * size
        depth = min(deep, limits.part * (slave.wall[one] + master.wall[two]))
        least, most = _heights(slave.normal, one, slave.start, master.start, one, two)
        last, _ = _heights(slave.last, one, slave.end, master.end, one, two)
        if depth >= deep and -most > depth:
            square = 0.0
            for x in range(d):
                between[x, 0] = slave.normal[x, one] - master.normal[x, two]
                square += between[x, 0] ** 2
            length = np.sqrt(square)
            for x in range(d):
                between[x, 0] /= length if length > 0.0 else 1.0
            most = max(most, _heights(between, 0, slave.start, master.start, one, two)[1])
        if -most <= depth and min(least, last) <= limits.reach:
            square = 0.0
            for x in range(d):
                square += (slave.motion[x, one] - master.motion[x, two]) ** 2
            kept[count], limit[count] = s, limits.few * size + limits.reach + np.sqrt(square)
            count += 1
    return count


@inlined
def _heights(direction, p, slave, master, one, two):
    """Least and greatest height of the corners of a master along a direction above those of a slave."""
    low, high, lowest, highest = np.inf, -np.inf, np.inf, -np.inf
    for c in range(slave.shape[1]):
        base = over = 0.0
        for x in range(slave.shape[0]):
            base += direction[x, p] * slave[x, c, one]
            over += direction[x, p] * master[x, c, two]
        low, high = min(low, over), max(high, over)
        lowest, highest = min(lowest, base), max(highest, base)
    return low - highest, high - lowest
