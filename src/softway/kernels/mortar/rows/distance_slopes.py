"""Slopes of the distance of two surfaces, measured along the normals of the slave.

The derivatives are explained in docs/theory/contact/mortar.md.
"""

from typing import NamedTuple

import numpy as np

from softway.arrays import Array
from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.mortar.rows.heights import add_heights, tilt
from softway.kernels.mortar.simplices import vector_area

STEEP = 0.2
"""Lower bound of the cosine between two surfaces when their distance is measured."""


class SlopeRoom(NamedTuple):
    """Place for one pair: the unit normal ``square`` (1, d) and the gradients ``gradient`` (k, d) of the slave, the
    normal ``normal`` (1, d) and the gradients ``along`` (k, d) of the master, coordinates ``at`` (k,), heights
    ``rise`` (k,) at the corners of the slave, and components along a slope: ``lean`` (k,) of the gradients, ``low`` and
    ``high`` (k,) of the corners of slave and master.
    """

    square: Array
    gradient: Array
    normal: Array
    along: Array
    at: Array
    rise: Array
    lean: Array
    low: Array
    high: Array


def slope_room(k: int, d: int) -> SlopeRoom:
    """Place for simplices of k corners in d dimensions."""
    return SlopeRoom(*(np.zeros(shape) for shape in ((1, d), (k, d), (1, d), (k, d), *((k,),) * 5)))


@uncounted_kernel
def distance_slopes(slave, master, pairs, below, above, heights, room, out):
    """Slopes of the distances, and heights along them, see :class:`~softway.kernels.mortar.tables.Distances`.

    ``heights`` (p, k, k) and (q, k, k) are those above the simplices of slave and master; none of flat surfaces.

    The slopes under a motion of the corners of the slave also turn the direction in which the distance is measured.
    Without the turn a row of two surfaces that are not parallel would have a moment.
    """
    p, k = slave.corner.shape
    for i in range(p):
        if pairs.first[i] < pairs.first[i + 1]:
            gradients(below, slave.corner, i, room.square, room.gradient)
        for s in range(pairs.first[i], pairs.first[i + 1]):
            cosine = _face(above, master.corner, pairs.master[s], room, out.facing, s)
            if len(heights[1]) and cosine > 0.0:
                gradients(above, master.corner, pairs.master[s], room.normal, room.along)
                add_heights(slave, master, heights, pairs, below, above, i, s, cosine, room, out.height)
                for a in range(k):
                    tilt(heights[1], pairs.master[s], pairs.cross[s, a], cosine, room, out.facing[s, a])
            if len(heights[1]):
                for a in range(k):
                    _project(slave, master, pairs, below, above, i, s, out.facing[s, a], room)
                    _lean(i, s, a, pairs, out.facing[s, a], room, out)
            else:
                _project(slave, master, pairs, below, above, i, s, out.facing[s, 0], room)
                for a in range(k):
                    _lean(i, s, a, pairs, out.facing[s, 0], room, out)


@uncounted
def _project(slave, master, pairs, below, above, i, s, facing, room):
    """Write the components along a slope (d,) of the corners of a pair and of the gradients of the slave."""
    for b in range(len(room.lean)):
        own, cross = slave.corner[i, b], master.corner[pairs.master[s], b]
        room.lean[b], room.low[b], room.high[b] = 0.0, 0.0, 0.0
        for c in range(len(facing)):
            room.lean[b] += room.gradient[b, c] * facing[c]
            room.low[b] += below[own, c] * facing[c]
            room.high[b] += above[cross, c] * facing[c]


@uncounted
def _lean(i, s, a, pairs, facing, room, out):
    """Add the integrals of a coordinate a and the slopes of a pair under a motion of the corners of the slave i."""
    k, distance = len(room.lean), 0.0
    for b in range(k):
        distance += pairs.own[s, a, b] * room.low[b] - pairs.cross[s, a, b] * room.high[b]
    out.span[s, a] = distance
    for b in range(k):
        turned = distance * room.lean[b]
        for c in range(len(facing)):
            out.leaning[i, a, b, c] += pairs.own[s, a, b] * facing[c] - turned * room.square[0, c]


@uncounted
def gradients(vertices, corner, i, square, gradient):
    """Unit normal (1, d) of a simplex, and gradients (k, d), along it, of its barycentric coordinates."""
    size = vector_area(vertices, corner, i, square, 0)
    for c in range(square.shape[1]):
        square[0, c] /= size
    if len(gradient) == 2:
        for c in range(2):
            gradient[1, c] = (vertices[corner[i, 1], c] - vertices[corner[i, 0], c]) / (size * size)
            gradient[0, c] = -gradient[1, c]
        return
    for k in range(3):
        start, end = corner[i, (k + 1) % 3], corner[i, (k + 2) % 3]
        for c in range(3):
            y, z = (c + 1) % 3, (c + 2) % 3
            turned = square[0, y] * (vertices[end, z] - vertices[start, z])
            gradient[k, c] = (turned - square[0, z] * (vertices[end, y] - vertices[start, y])) / (2.0 * size)


@uncounted
def _face(vertices, corner, j, room, facing, s):
    """Slopes of the distance along a slave normal: the master normal divided by its cosine, which is returned."""
    size, cosine = vector_area(vertices, corner, j, room.normal, 0), 0.0
    for c in range(facing.shape[2]):
        room.normal[0, c] /= size if size > 0.0 else 1.0
        cosine -= room.square[0, c] * room.normal[0, c]
    cosine = max(cosine, STEEP)
    for c in range(facing.shape[2]):
        facing[s, 0, c] = room.normal[0, c] / cosine
        for a in range(1, facing.shape[1]):
            facing[s, a, c] = facing[s, 0, c]
    return cosine if size > 0.0 else 0.0
