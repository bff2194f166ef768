"""Volume and first moments of the intersection of two cells: convex polygons with polygons, tetrahedra."""

import numpy as np

from softway.kernels.jit.compilation import kernel


@kernel
def polygon_overlaps(one, other, pairs, radial):
    """Moments (k, 3) of the intersections of polygons with convex polygons: measure, and x and y over it.

    Parameters
    ----------
    one, other
        (a, p, 2) and (b, q, 2) corners, anticlockwise; those of ``other`` convex.  Polygons of ``one`` may be concave.
    pairs
        (k, 2) numbers of a polygon of each.
    radial
        True for the measure x dx dy, of a body of revolution.
    """
    found = np.zeros((len(pairs), 3))
    room = 3 + other.shape[1] + 2
    shape, clipped = np.empty((room, 2)), np.empty((room, 2))
    for k in range(len(pairs)):
        a, b = one[pairs[k, 0]], other[pairs[k, 1]]
        for t in range(1, len(a) - 1):
            twice = (a[t, 0] - a[0, 0]) * (a[t + 1, 1] - a[0, 1]) - (a[t, 1] - a[0, 1]) * (a[t + 1, 0] - a[0, 0])
            if twice == 0.0:
                continue
            sign = 1.0 if twice > 0.0 else -1.0
            first, second = (t, t + 1) if twice > 0.0 else (t + 1, t)
            for i in range(2):
                shape[0, i], shape[1, i], shape[2, i] = a[0, i], a[first, i], a[second, i]
            count = 3
            for s in range(len(b)):
                p, q = b[s], b[(s + 1) % len(b)]
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
                count = kept
                for j in range(count):
                    shape[j, 0], shape[j, 1] = clipped[j, 0], clipped[j, 1]
                if count < 3:
                    break
            for j in range(1, count - 1):
                x0, y0, x1, y1, x2, y2 = shape[0, 0], shape[0, 1], shape[j, 0], shape[j, 1], shape[j + 1, 0], shape[j + 1, 1]
                area = 0.5 * sign * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0))
                for e in range(3):  # middles of the sides: exact for polynomials of second degree
                    mx = 0.5 * (x0 + x1) if e == 0 else (0.5 * (x1 + x2) if e == 1 else 0.5 * (x2 + x0))
                    my = 0.5 * (y0 + y1) if e == 0 else (0.5 * (y1 + y2) if e == 1 else 0.5 * (y2 + y0))
                    weight = area / 3.0 * (mx if radial else 1.0)
                    found[k, 0] += weight
                    found[k, 1] += weight * mx
                    found[k, 2] += weight * my
    return found


@kernel
def tetrahedron_overlaps(one, other, pairs):
    """Moments (k, 4) of the intersections of tetrahedra: volume, and x, y and z over it.

    Parameters
    ----------
    one, other
        (a, 4, 3) and (b, 4, 3) corners of tetrahedra with a positive volume.
    pairs
        (k, 2) numbers of a tetrahedron of each.
    """
    found = np.zeros((len(pairs), 4))
    now, then = np.empty((96, 4, 3)), np.empty((96, 4, 3))
    order, height = np.empty(4, dtype=np.int64), np.empty(4)
    faces = ((1, 2, 3, 0), (0, 3, 2, 1), (0, 1, 3, 2), (0, 2, 1, 3))
    normal, cut = np.empty(3), np.empty((6, 3))
    for k in range(len(pairs)):
        b = other[pairs[k, 1]]
        now[0] = one[pairs[k, 0]]
        count = 1
        for face in faces:
            p = b[face[0]]
            u, v = b[face[1]] - p, b[face[2]] - p
            normal[0] = u[1] * v[2] - u[2] * v[1]
            normal[1] = u[2] * v[0] - u[0] * v[2]
            normal[2] = u[0] * v[1] - u[1] * v[0]
            inner = 0.0
            for i in range(3):
                inner += normal[i] * (b[face[3], i] - p[i])
            sign = 1.0 if inner > 0.0 else -1.0
            kept = 0
            for t in range(count):
                above = 0
                for j in range(4):
                    height[j] = 0.0
                    for i in range(3):
                        height[j] += sign * normal[i] * (now[t, j, i] - p[i])
                    if height[j] > 0.0:
                        above += 1
                head, tail = 0, 3
                for j in range(4):
                    if height[j] > 0.0:
                        order[head] = j
                        head += 1
                    else:
                        order[tail] = j
                        tail -= 1
                if above == 4:
                    then[kept] = now[t]
                    kept += 1
                elif above == 1:
                    then[kept, 0] = now[t, order[0]]
                    for j in range(1, 4):
                        share = height[order[0]] / (height[order[0]] - height[order[j]])
                        then[kept, j] = now[t, order[0]] + share * (now[t, order[j]] - now[t, order[0]])
                    kept += 1
                elif above > 1:
                    if above == 3:  # prism between the face above and its cut
                        for j in range(3):
                            a, c = order[j], order[3]
                            share = height[a] / (height[a] - height[c])
                            cut[j] = now[t, a]
                            cut[3 + j] = now[t, a] + share * (now[t, c] - now[t, a])
                    else:  # prism between the two triangles at the ends of the edge above
                        for j in range(2):
                            a = order[j]
                            cut[3 * j] = now[t, a]
                            for m in range(2):
                                c = order[2 + m]
                                share = height[a] / (height[a] - height[c])
                                cut[3 * j + 1 + m] = now[t, a] + share * (now[t, c] - now[t, a])
                    for piece in ((0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)):
                        for j in range(4):
                            then[kept, j] = cut[piece[j]]
                        kept += 1
            count = kept
            for t in range(count):
                now[t] = then[t]
        for t in range(count):
            u, v, w = now[t, 1] - now[t, 0], now[t, 2] - now[t, 0], now[t, 3] - now[t, 0]
            volume = abs(
                u[0] * (v[1] * w[2] - v[2] * w[1])
                - u[1] * (v[0] * w[2] - v[2] * w[0])
                + u[2] * (v[0] * w[1] - v[1] * w[0])
            ) / 6.0
            found[k, 0] += volume
            for i in range(3):
                found[k, 1 + i] += 0.25 * volume * (now[t, 0, i] + now[t, 1, i] + now[t, 2, i] + now[t, 3, i])
    return found
