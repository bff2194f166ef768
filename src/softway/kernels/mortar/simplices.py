"""Normals of simplices, and their pairs that are near each other."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.jit.compilation import uncounted, uncounted_kernel


def vector_areas(vertices: Array, corner: IntArray) -> Array:
    """Outward normals (p, d) of segments (p, 2) or triangles (p, 3), with their length or area as magnitude.

    Examples
    --------
    >>> vector_areas(np.array([[0.0, 0.0], [2.0, 0.0]]), np.array([[0, 1]])).tolist()
    [[0.0, -2.0]]
    """
    out = np.empty((len(corner), vertices.shape[1]))
    _vector_areas(vertices, corner, out)
    return out


@uncounted_kernel
def _vector_areas(vertices, corner, out):
    """Write the normals of all simplices."""
    for p in range(len(corner)):
        vector_area(vertices, corner, p, out, p)


@uncounted
def vector_area(vertices, corner, p, out, row):
    """Write the normal of the simplex p, with its length or area as magnitude, to a row; returns the magnitude."""
    a, b = corner[p, 0], corner[p, 1]
    if vertices.shape[1] == 2:
        out[row, 0], out[row, 1] = vertices[b, 1] - vertices[a, 1], vertices[a, 0] - vertices[b, 0]
        return np.sqrt(out[row, 0] ** 2 + out[row, 1] ** 2)
    c, size = corner[p, 2], 0.0
    for x in range(3):
        y, z = (x + 1) % 3, (x + 2) % 3
        first = (vertices[b, y] - vertices[a, y]) * (vertices[c, z] - vertices[a, z])
        out[row, x] = 0.5 * (first - (vertices[b, z] - vertices[a, z]) * (vertices[c, y] - vertices[a, y]))
        size += out[row, x] ** 2
    return np.sqrt(size)


@uncounted_kernel
def keep_near(below, corner, above, other, areas, i, j, limit, count, pair, own, cross):
    """Keep, in place, those of the ``count`` overlaps whose mean distance along the slave normal is within its limit.

    Arguments: vertices and corners of slave and master, normals ``areas`` (p, d) of the slave, pairs i, j (s,) with
    their limits, and the overlaps.  Returns the number that is left.
    """
    kept = 0
    for s in range(count):
        slave, master, size, height, measure = i[pair[s]], j[pair[s]], 0.0, 0.0, 0.0
        for b in range(corner.shape[1]):
            mine = others = low = high = 0.0
            for a in range(corner.shape[1]):
                mine, others = mine + own[s, a, b], others + cross[s, a, b]
                own[kept, a, b], cross[kept, a, b] = own[s, a, b], cross[s, a, b]
            for x in range(below.shape[1]):
                low += below[corner[slave, b], x] * areas[slave, x]
                high += above[other[master, b], x] * areas[slave, x]
            height, measure = height + others * high - mine * low, measure + mine
        for x in range(below.shape[1]):
            size += areas[slave, x] ** 2
        pair[kept] = pair[s]
        if abs(height) <= limit[pair[s]] * measure * np.sqrt(size):
            kept += 1
    return kept
