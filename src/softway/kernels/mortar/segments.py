"""Overlap of pairs of segments in the plane, projected along the continuous field of slave normals.

The ends of the master segment are projected onto the slave segment along ``n(xi) = (1 - xi) n_0 + xi n_1`` (Yang,
Laursen and Meng, 2005): this is their overlap.  Within it a point of the slave faces the point of the master, or of its
continuation, that lies in front of it along the normal of the slave segment.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel

BEYOND = 0.5
"""Distance beyond the ends of the master, in its lengths, at which a slave point may face its continuation."""


@kernel
def segment_overlap(slave, corner, normal, master, other, i, j, pair, own, cross):
    """Overlaps of the pairs of segments i, j (s,); returns their number.

    Arguments: vertices (v, 2), ends (p, 2) and outward normals (v, 2) of the slave, vertices (w, 2) and ends (q, 2) of
    the master, which run the other way round.  The results are those of
    :func:`~softway.kernels.mortar.triangles.triangle_overlap`, with (2, 2) integrals for each pair.
    """
    found, at, there = 0, np.empty((2, 2)), np.empty((2, 2))
    for s in range(len(i)):
        a, b, c, e = corner[i[s], 0], corner[i[s], 1], other[j[s], 0], other[j[s], 1]
        tx, ty = slave[b, 0] - slave[a, 0], slave[b, 1] - slave[a, 1]
        ux, uy = normal[b, 0] - normal[a, 0], normal[b, 1] - normal[a, 1]
        seen = (tx, ty, normal[a, 0], normal[a, 1], ux, uy)
        at[0, 1] = _seen_at(slave[a, 0] - master[e, 0], slave[a, 1] - master[e, 1], seen)
        at[1, 1] = _seen_at(slave[a, 0] - master[c, 0], slave[a, 1] - master[c, 1], seen)
        if not at[1, 1] > at[0, 1]:
            continue
        rx, ry = master[e, 0] - master[c, 0], master[e, 1] - master[c, 1]
        square, facing = -(rx * tx + ry * ty), True
        for end in range(2):
            xi = at[end, 1]
            away = (slave[a, 0] + xi * tx - master[c, 0]) * tx + (slave[a, 1] + xi * ty - master[c, 1]) * ty
            facing &= rx * (normal[a, 1] + xi * uy) - ry * (normal[a, 0] + xi * ux) > 0.0
            eta = -away / square if square > 0.0 else 0.0
            there[end, 1] = min(max(eta, -BEYOND), 1.0 + BEYOND)
            at[end, 0], there[end, 0] = 1.0 - xi, 1.0 - there[end, 1]
        measure = np.sqrt(tx * tx + ty * ty) * (at[1, 1] - at[0, 1])
        if facing and measure > 0.0:
            pair[found] = s
            _products(at, at, measure / 6.0, found, own)
            _products(at, there, measure / 6.0, found, cross)
            found += 1
    return found


@inlined
def _seen_at(x, y, seen):
    """Coordinate xi in [0, 1] at which the normal passes through a point; 0 or 1 if it lies beyond.

    It is the root of ``(away + xi tangent) x (first + xi turn) = k0 + k1 xi + k2 xi^2`` with a change from plus to
    minus, for the point away from the start by ``-away = -(x, y)``.
    """
    tx, ty, nx, ny, ux, uy = seen
    k0, k1, k2 = x * ny - y * nx, (tx * ny - ty * nx) + (x * uy - y * ux), tx * uy - ty * ux
    if k0 > 0.0 and k0 + k1 + k2 < 0.0:
        return min(max(-2.0 * k0 / (k1 - np.sqrt(max(k1 * k1 - 4.0 * k2 * k0, 0.0))), 0.0), 1.0)
    return 1.0 if k0 > 0.0 else 0.0


@inlined
def _products(one, two, sixth, found, out):
    """Integrals (2, 2) over a segment of the products of linear functions with values (end, 2)."""
    for a in range(2):
        for b in range(2):
            ends = one[0, a] * two[0, b] + one[1, a] * two[1, b]
            out[found, a, b] = sixth * (ends + (one[0, a] + one[1, a]) * (two[0, b] + two[1, b]))
