"""Volume and first moments of the intersection of two cells: polygons with convex polygons, tetrahedra."""

import numpy as np

from softway.kernels.jit.compilation import kernel


@kernel
def polygon_overlaps(one, other, pairs, radial):
    """Moments (k, 3) of the intersections of polygons with convex polygons: measure, and x and y over it.

    Parameters
    ----------
    one, other
        (a, p, 2) and (b, q, 2) corners, anticlockwise; those of ``other`` convex.  Polygons of ``one`` may be concave:
        they are sums of triangles with a sign.
    pairs
        (k, 2) numbers of a polygon of each.
    radial
        True for the measure x dx dy, of a body of revolution.
    """
    found = np.zeros((len(pairs), 3))
    room = 5 + other.shape[1]
    shape, clipped = np.empty((room, 2)), np.empty((room, 2))
    for k in range(len(pairs)):
        a, b = one[pairs[k, 0]], other[pairs[k, 1]]
        for t in range(1, len(a) - 1):
            twice = (a[t, 0] - a[0, 0]) * (a[t + 1, 1] - a[0, 1]) - (a[t, 1] - a[0, 1]) * (a[t + 1, 0] - a[0, 0])
            if twice == 0.0:
                continue
            first, second = (t, t + 1) if twice > 0.0 else (t + 1, t)
            for i in range(2):
                shape[0, i], shape[1, i], shape[2, i] = a[0, i], a[first, i], a[second, i]
            count = 3
            for s in range(len(b)):
                count = _cut_polygon(shape, count, clipped, b[s], b[(s + 1) % len(b)])
            _add_polygon(shape, count, 1.0 if twice > 0.0 else -1.0, radial, found[k])
    return found


@kernel
def _cut_polygon(shape, count, clipped, p, q):
    """Cut a convex polygon by the line from p to q, its left side stays; returns the number of corners."""
    ex, ey = q[0] - p[0], q[1] - p[1]
    kept = 0
    for j in range(count):
        x0, y0 = shape[j, 0], shape[j, 1]
        x1, y1 = shape[(j + 1) % count, 0], shape[(j + 1) % count, 1]
        h0 = ex * (y0 - p[1]) - ey * (x0 - p[0])
        h1 = ex * (y1 - p[1]) - ey * (x1 - p[0])
        if h0 >= 0.0:
            clipped[kept, 0], clipped[kept, 1] = x0, y0
            kept += 1
        if (h0 > 0.0 and h1 < 0.0) or (h0 < 0.0 and h1 > 0.0):
            share = h0 / (h0 - h1)
            clipped[kept, 0], clipped[kept, 1] = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
            kept += 1
    for j in range(kept):
        shape[j, 0], shape[j, 1] = clipped[j, 0], clipped[j, 1]
    return kept


@kernel
def _add_polygon(shape, count, sign, radial, out):
    """Add the moments of a convex polygon, by the middles of the sides of triangles: exact to the second degree."""
    for j in range(1, count - 1):
        x = (shape[0, 0], shape[j, 0], shape[j + 1, 0])
        y = (shape[0, 1], shape[j, 1], shape[j + 1, 1])
        area = 0.5 * sign * ((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]))
        for e in range(3):
            mx, my = 0.5 * (x[e] + x[(e + 1) % 3]), 0.5 * (y[e] + y[(e + 1) % 3])
            weight = area / 3.0 * (mx if radial else 1.0)
            out[0] += weight
            out[1] += weight * mx
            out[2] += weight * my


@kernel
def tetrahedron_overlaps(one, other, pairs):
    """Moments (k, 4) of the intersections of tetrahedra: volume, and x, y and z over it.

    Parameters
    ----------
    one, other
        (a, 4, 3) and (b, 4, 3) corners of tetrahedra.
    pairs
        (k, 2) numbers of a tetrahedron of each.
    """
    found = np.zeros((len(pairs), 4))
    now, then = np.empty((96, 4, 3)), np.empty((96, 4, 3))
    height, order, cut = np.empty(4), np.empty(4, np.int64), np.empty((6, 3))
    normal = np.empty(3)
    for k in range(len(pairs)):
        a, b = one[pairs[k, 0]], other[pairs[k, 1]]
        if _apart(b, a, normal) or _apart(a, b, normal):
            continue
        now[0] = a
        count = 1
        for f in range(4):
            p = b[(f + 1) % 4]
            _inward(b, f, normal)
            kept = 0
            for t in range(count):
                for j in range(4):
                    height[j] = _height(normal, now[t, j], p)
                kept = _cut_tetrahedron(now[t], height, order, cut, then, kept)
            count = kept
            now[:count] = then[:count]
        for t in range(count):
            u = now[t, 1] - now[t, 0]
            volume = abs(_dot(u, _cross(now[t, 2] - now[t, 0], now[t, 3] - now[t, 0]))) / 6.0
            found[k, 0] += volume
            for i in range(3):
                found[k, 1 + i] += 0.25 * volume * (now[t, 0, i] + now[t, 1, i] + now[t, 2, i] + now[t, 3, i])
    return found


@kernel
def _inward(x, f, out):
    """Write the normal of the face of a tetrahedron opposite to its corner f that points to this corner."""
    p, q, r = x[(f + 1) % 4], x[(f + 2) % 4], x[(f + 3) % 4]
    ux, uy, uz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    vx, vy, vz = r[0] - p[0], r[1] - p[1], r[2] - p[2]
    out[0], out[1], out[2] = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    if _height(out, x[f], p) < 0.0:
        out[0], out[1], out[2] = -out[0], -out[1], -out[2]


@kernel
def _height(normal, x, p):
    """Height of a point over the plane through p, times the length of its normal."""
    return normal[0] * (x[0] - p[0]) + normal[1] * (x[1] - p[1]) + normal[2] * (x[2] - p[2])


@kernel
def _apart(x, y, normal):
    """Whether a tetrahedron y is on the outer side of a face of a tetrahedron x."""
    for f in range(4):
        _inward(x, f, normal)
        p, outside = x[(f + 1) % 4], True
        for j in range(4):
            outside = outside and _height(normal, y[j], p) <= 0.0
        if outside:
            return True
    return False


@kernel
def _cross(u, v):
    """Cross product of two vectors."""
    out = np.empty(3)
    out[0] = u[1] * v[2] - u[2] * v[1]
    out[1] = u[2] * v[0] - u[0] * v[2]
    out[2] = u[0] * v[1] - u[1] * v[0]
    return out


@kernel
def _dot(u, v):
    """Scalar product of two vectors."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@kernel
def _cut_tetrahedron(x, height, order, cut, out, kept):
    """Write tetrahedra that fill the part of one with positive heights, from row ``kept`` on; returns the next row."""
    order[0], order[1], order[2], order[3] = 0, 1, 2, 3
    above = 0
    for j in range(4):
        k = j
        while k > 0 and height[order[k - 1]] < height[j]:
            order[k] = order[k - 1]
            k -= 1
        order[k] = j
        above += height[j] > 0.0
    if above == 4:
        out[kept] = x
        return kept + 1
    if above == 1:
        out[kept, 0] = x[order[0]]
        for j in range(1, 4):
            out[kept, j] = _between(x, height, order[0], order[j])
        return kept + 1
    if above == 0:
        return kept
    if above == 3:  # prism between the face above and its cut
        for j in range(3):
            cut[j] = x[order[j]]
            cut[3 + j] = _between(x, height, order[j], order[3])
    else:  # prism between the triangles at both ends of the edge above
        for j in range(2):
            cut[3 * j] = x[order[j]]
            cut[3 * j + 1] = _between(x, height, order[j], order[2])
            cut[3 * j + 2] = _between(x, height, order[j], order[3])
    for piece in range(3):
        for j in range(4):
            out[kept + piece, j] = cut[piece + j]
    return kept + 3


@kernel
def _between(x, height, above, below):
    """Point of an edge of a tetrahedron at the height zero."""
    share = height[above] / (height[above] - height[below])
    return x[above] + share * (x[below] - x[above])
