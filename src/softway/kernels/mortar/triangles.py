"""Overlap of pairs of triangles in space, projected along the normals of the slave triangles.

The master triangle is projected onto the plane of the slave triangle and cut by its edges (Puso and Laursen, 2004), in
barycentric coordinates of the slave triangle: these are the distances from its edges.
"""

from typing import NamedTuple

import numpy as np

from softway.arrays import Array
from softway.kernels.jit.compilation import uncounted, uncounted_kernel

EDGE_ON = 1e-10
"""Area over the square of the edges, below which the projected master triangle is degenerate."""
MOST = 24
"""Greatest number of corners: three cuts, each of which doubles it at worst, where rounding bends edges on the cut."""


class TriangleRoom(NamedTuple):
    """Circles ``slave`` (p, 4) and ``master`` (q, 4) around triangles, and place for one pair: gradients ``toward``
    (3, 3), coordinates ``seen`` (3, 2) and ``outward`` (3, 3), corners ``polygon`` and ``cut`` (MOST, 2), ``moments``.
    """

    slave: Array
    master: Array
    toward: Array
    seen: Array
    outward: Array
    polygon: Array
    cut: Array
    moments: Array


def triangle_room(p: int, q: int) -> TriangleRoom:
    """Place for p slave and q master triangles."""
    shapes = (p, 4), (q, 4), (3, 3), (3, 2), (3, 3), (MOST, 2), (MOST, 2), (3, 3)
    return TriangleRoom(*(np.empty(shape) for shape in shapes))


@uncounted_kernel
def triangle_overlap(slave, corner, master, other, i, j, room, pair, own, cross):
    """Overlaps of the pairs of triangles i, j (s,); returns their number.

    Arguments: vertices (v, 3) and corners (p, 3) of the slave, vertices (w, 3) and corners (q, 3) of the master.  The
    results are the numbers of the pairs with an overlap, and the integrals (s, 3, 3) of products of barycentric
    coordinates, ``own`` with both on the slave and ``cross`` with one on the slave, the other on the master.
    """
    last, found, area = -1, 0, 0.0
    _circles(slave, corner, room.slave)
    _circles(master, other, room.master)
    for s in range(len(i)):
        if i[s] != last:
            last = i[s]
            area = _toward(slave, corner, last, room.toward)
        if _apart(room, last, j[s]):
            continue
        for c in range(3):
            for g in range(2):
                room.seen[c, g] = 0.0
                for x in range(3):
                    away = master[other[j[s], c], x] - slave[corner[last, 0], x]
                    room.seen[c, g] += room.toward[g, x] * away
        if _beyond(room.seen):
            continue
        turn = _from_master(room.seen, room.outward)
        if turn == 0.0 or _behind(room.outward):
            continue
        count = _cut(room.seen, room.polygon, room.cut)
        if count > 2 and _moments(room.cut, count, room.moments) > 0.0:
            pair[found] = s
            for a in range(3):
                for b in range(3):
                    own[found, a, b], cross[found, a, b] = area * room.moments[a, b], 0.0
                    for c in range(3):
                        cross[found, a, b] += area * room.moments[a, c] * (room.outward[(b + 1) % 3, c] / turn)
            found += 1
    return found


@uncounted
def _circles(vertices, corner, out):
    """Write the centre of each triangle, and its greatest distance from a corner (q, 4)."""
    for p in range(len(corner)):
        square = 0.0
        for x in range(3):
            out[p, x] = (vertices[corner[p, 0], x] + vertices[corner[p, 1], x] + vertices[corner[p, 2], x]) / 3.0
        for c in range(3):
            away = 0.0
            for x in range(3):
                away += (vertices[corner[p, c], x] - out[p, x]) ** 2
            square = max(square, away)
        out[p, 3] = np.sqrt(square)


@uncounted
def _apart(room, i, j):
    """True if the circles of two triangles are apart, as seen along the slave normal."""
    x, y = room.master[j, 0] - room.slave[i, 0], room.master[j, 1] - room.slave[i, 1]
    z, both = room.master[j, 2] - room.slave[i, 2], room.master[j, 3] + room.slave[i, 3]
    height = room.toward[2, 0] * x + room.toward[2, 1] * y + room.toward[2, 2] * z
    return x * x + y * y + z * z - height * height > both * both


@uncounted
def _toward(slave, corner, i, toward):
    """Gradients of the last two barycentric coordinates of a slave triangle, and its unit normal; returns twice its
    area.
    """
    a, b, c = corner[i, 0], corner[i, 1], corner[i, 2]
    ux, uy, uz = slave[b, 0] - slave[a, 0], slave[b, 1] - slave[a, 1], slave[b, 2] - slave[a, 2]
    vx, vy, vz = slave[c, 0] - slave[a, 0], slave[c, 1] - slave[a, 1], slave[c, 2] - slave[a, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    toward[0, 0], toward[0, 1], toward[0, 2] = vy * nz - vz * ny, vz * nx - vx * nz, vx * ny - vy * nx
    toward[1, 0], toward[1, 1], toward[1, 2] = ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux
    for g in range(2):
        for x in range(3):
            toward[g, x] /= square
    size = np.sqrt(square)
    toward[2, 0], toward[2, 1], toward[2, 2] = nx / size, ny / size, nz / size
    return size


@uncounted
def _from_master(seen, outward):
    """Outward distances (3, 3) of the slave corners from the edges of the master triangle, times the edge lengths.

    ``seen`` (3, 2) are the last two coordinates of the master on the slave.  Returns twice the area of the master
    relative to that of the slave: negative where the two face each other, otherwise zero, as for a degenerate
    projection.
    """
    square = 0.0
    for e in range(3):
        x, y = seen[e, 0], seen[e, 1]
        run, rise = seen[(e + 1) % 3, 0] - x, seen[(e + 1) % 3, 1] - y
        outward[e, 0] = rise * x - run * y
        outward[e, 1], outward[e, 2] = outward[e, 0] - rise, outward[e, 0] + run
        square += run * run + rise * rise
    turn = (seen[1, 0] - seen[0, 0]) * (seen[2, 1] - seen[1, 1]) - (seen[1, 1] - seen[0, 1]) * (seen[2, 0] - seen[1, 0])
    return turn if -turn > EDGE_ON * square else 0.0


@uncounted
def _beyond(seen):
    """True if a master triangle lies beyond an edge of the slave triangle."""
    most = max(1.0 - seen[0, 0] - seen[0, 1], 1.0 - seen[1, 0] - seen[1, 1], 1.0 - seen[2, 0] - seen[2, 1])
    for g in range(2):
        most = min(most, max(seen[0, g], seen[1, g], seen[2, g]))
    return not most > 0.0


@uncounted
def _behind(outward):
    """True if the slave triangle lies beyond an edge of the master triangle."""
    least = -1.0
    for e in range(3):
        least = max(least, min(outward[e, 0], outward[e, 1], outward[e, 2]))
    return not least < 0.0


@uncounted
def _cut(seen, polygon, out):
    """Cut the triangle ``seen`` (3, 2) by the edges of the slave: corners ``out``, whose number is returned.

    Corners at the cut are interpolated along the edge (Sutherland and Hodgman, 1974).
    """
    count = 3
    for c in range(3):
        polygon[c, 0], polygon[c, 1] = seen[c, 0], seen[c, 1]
    for side in range(3):
        left = 0
        for c in range(count):
            after = c + 1 if c + 1 < count else 0
            here, there = _distance(polygon, c, side), _distance(polygon, after, side)
            if (here >= 0.0) != (there >= 0.0):
                t = here / (here - there)
                for x in range(2):
                    out[left, x] = polygon[c, x] + t * (polygon[after, x] - polygon[c, x])
                left += 1
            if there >= 0.0:
                out[left, 0], out[left, 1] = polygon[after, 0], polygon[after, 1]
                left += 1
        count = left
        for c in range(count):
            polygon[c, 0], polygon[c, 1] = out[c, 0], out[c, 1]
    return count


@uncounted
def _distance(polygon, c, side):
    """Barycentric coordinate of a corner: its distance from an edge of the slave."""
    return polygon[c, side] if side < 2 else 1.0 - polygon[c, 0] - polygon[c, 1]


@uncounted
def _moments(polygon, count, out):
    """Integrals (3, 3) of products of barycentric coordinates over a polygon, for a triangle of area 1/2.

    The polygon turns clockwise and is fanned into triangles about its first corner.  Returns the sum of the integrals.
    """
    m0 = mx = my = xx = xy = yy = 0.0
    for c in range(1, count - 1):
        x, y = polygon[c, 0] - polygon[0, 0], polygon[c, 1] - polygon[0, 1]
        u, v = polygon[c + 1, 0] - polygon[0, 0], polygon[c + 1, 1] - polygon[0, 1]
        turn = max(u * y - x * v, 0.0)
        m0 += 0.5 * turn
        mx += turn * (x + u) / 6.0
        my += turn * (y + v) / 6.0
        xx += turn * (x * x + u * u + x * u) / 12.0
        xy += turn * (x * y + u * v + 0.5 * (x * v + y * u)) / 12.0
        yy += turn * (y * y + v * v + y * v) / 12.0
    start = (1.0 - polygon[0, 0] - polygon[0, 1], polygon[0, 0], polygon[0, 1])
    mean = (-mx - my, mx, my)
    second = ((xx + 2.0 * xy + yy, -xx - xy, -xy - yy), (-xx - xy, xx, xy), (-xy - yy, xy, yy))
    total = 0.0
    for a in range(3):
        for b in range(3):
            value = start[a] * (m0 * start[b] + mean[b]) + start[b] * mean[a] + second[a][b]
            out[a, b] = max(value, 0.0)
            total += out[a, b]
    return total
