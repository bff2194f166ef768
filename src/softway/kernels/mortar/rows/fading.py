"""Weights of pairs of simplices that hardly face each other, and their changes."""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.mortar.rows.distance_slopes import gradients
from softway.kernels.mortar.simplices import vector_area

FULL, NONE = np.sqrt(0.5), 0.5
"""Cosines of the angle between one normal and the reverse of the other: pairs up to 45 degrees count in full, beyond 60
degrees not at all."""


@uncounted_kernel
def fade(areas, above, other, i, j, count, pair, own, cross, change, room):
    """Multiply the integrals of the first ``count`` pairs by their weights, in place.

    Arguments: normals ``areas`` (p, d) of the slave simplices, vertices and corners of the master, pairs i, j (s,), the
    overlaps, and place for a normal ``room`` (1, d).  Writes the ``change`` (s,) of the weights with the cosines,
    relative to the weights, and returns the number of pairs with weight.
    """
    kept, k = 0, own.shape[1]
    for s in range(count):
        slave, dot, square = i[pair[s]], 0.0, 0.0
        size = vector_area(above, other, j[pair[s]], room, 0)
        for x in range(areas.shape[1]):
            dot -= areas[slave, x] * room[0, x]
            square += areas[slave, x] ** 2
        cosine = dot / (np.sqrt(square) * size) if size > 0.0 and square > 0.0 else 0.0
        weight = _weight(cosine)
        pair[kept], change[kept] = pair[s], _change(cosine)
        for a in range(k):
            for b in range(k):
                own[kept, a, b], cross[kept, a, b] = weight * own[s, a, b], weight * cross[s, a, b]
        kept += weight > 0.0
    return kept


@uncounted
def _weight(cosine):
    """Weight of a pair: smooth from zero to one."""
    way = min(max((cosine - NONE) / (FULL - NONE), 0.0), 1.0)
    return way * way * (3.0 - 2.0 * way)


@uncounted
def _change(cosine):
    """Change of the weight of a pair per change of the cosine, relative to the weight."""
    way = (cosine - NONE) / (FULL - NONE)
    return 6.0 * (1.0 - way) / (way * (3.0 - 2.0 * way) * (FULL - NONE)) if 0.0 < way < 1.0 else 0.0


@uncounted_kernel
def weight_slopes(slave, master, pairs, above, room, fading):
    """Write how the weights of pairs change, see :class:`~softway.kernels.mortar.tables.Fading`.

    Arguments: tables of both surfaces and of the pairs, vertices of the master, and room as for
    :func:`~softway.kernels.mortar.rows.distance_slopes.distance_slopes`.
    """
    for i in range(len(slave.corner)):
        for s in range(pairs.first[i], pairs.first[i + 1]):
            number = fading.number[s]
            if number >= 0:
                gradients(fading.points, slave.corner, i, room.square, room.gradient)
                gradients(above, master.corner, pairs.master[s], room.normal, room.along)
                _turn(pairs.change[s], room.gradient, room.normal, room.square, fading.slave[number])
                _turn(pairs.change[s], room.along, room.square, room.normal, fading.master[number])


@uncounted
def _turn(change, gradient, opposite, normal, out):
    """Write the change (k, d) under a motion of the corners of a simplex: its normal turns by the gradients of its
    coordinates, and the cosine with the ``opposite`` normal changes.
    """
    for b in range(out.shape[0]):
        lean = 0.0
        for x in range(out.shape[1]):
            lean += gradient[b, x] * opposite[0, x]
        for x in range(out.shape[1]):
            out[b, x] = change * lean * normal[0, x]
