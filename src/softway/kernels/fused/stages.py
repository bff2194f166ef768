"""Building blocks of the fused kernels, from nodes to points and back; rows as in :mod:`softway.kernels.jit.lanes`.

In two dimensions the third component of a nodal vector repeats the first, as the hoop strain needs it.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined
from softway.kernels.jit.lanes import (
    BRIDGE,
    CHANGE,
    FLUX,
    FRAME,
    LANES,
    NATURAL,
    SOFT,
    SPIN,
    STIFF,
    STRESS,
    TENSOR,
    VECTOR,
)
from softway.kernels.jit.simd import fma, load, mul, spread, store


@inlined
def scratch(size):
    """Array for the rows of a point, aligned to cache lines."""
    s = np.empty(size + LANES)
    start = np.int64(s.ctypes.data) // 8 % LANES
    return s[LANES - start : LANES - start + size]


@inlined
def gather(u, rows, s, at):
    """Copy the nodal vectors u (n, d) of the cells to ``s[at:]``."""
    d = u.shape[1]
    for node in range(rows.shape[0]):
        for k in range(LANES):
            row, to = rows[node, k], at + node * VECTOR + k
            s[to] = u[row, 0]
            s[to + LANES] = u[row, 1]
            s[to + 2 * LANES] = u[row, 2 % d]


@inlined
def scatter(s, at, rows, out):
    """Add nodal vectors ``s[at:]`` of the cells to ``out`` (n, d), one cell after the other."""
    d = out.shape[1]
    for k in range(LANES):
        for node in range(rows.shape[0]):
            row, here = rows[node, k], at + node * VECTOR + k
            out[row, 0] += s[here]
            out[row, 1] += s[here + LANES]
            out[row, 2 % d] += s[here + 2 * LANES]


@inlined
def differentiate(s, at, slopes, to):
    """Write ``D_ri = sum_a slopes_ar u_ai`` of the nodal vectors ``s[at:]`` to ``s[to:]``."""
    for i in range(0, VECTOR, LANES):
        one = two = three = spread(0.0)
        for node in range(slopes.shape[0]):
            value = load(s, at + node * VECTOR + i)
            one = fma(slopes[node, 0], value, one)
            two = fma(slopes[node, 1], value, two)
            three = fma(slopes[node, 2], value, three)
        store(s, to + i, one)
        store(s, to + VECTOR + i, two)
        store(s, to + 2 * VECTOR + i, three)


@inlined
def collect(s, slopes, at):
    """Add ``f_ai = sum_r slopes_ar D_ri`` of the NATURAL flux to the nodal vectors ``s[at:]``."""
    for i in range(0, VECTOR, LANES):
        one, two, three = load(s, NATURAL + i), load(s, NATURAL + VECTOR + i), load(s, NATURAL + 2 * VECTOR + i)
        for node in range(slopes.shape[0]):
            to = at + node * VECTOR + i
            rest = fma(slopes[node, 2], three, load(s, to))
            store(s, to, fma(slopes[node, 0], one, fma(slopes[node, 1], two, rest)))


@inlined
def place(s, X, to, d):
    """Write ``H_Ji = X_Jr D_ri`` of the NATURAL derivatives to ``s[to:]``."""
    for i in range(0, VECTOR, LANES):
        one, two, three = load(s, NATURAL + i), load(s, NATURAL + VECTOR + i), load(s, NATURAL + 2 * VECTOR + i)
        for J in range(0, TENSOR, VECTOR):
            store(s, to + J + i, dot(load(X, J), load(X, J + LANES), load(X, J + 2 * LANES), one, two, three))
    uncouple(s, to, d)


@inlined
def uncouple(s, to, d):
    """Set derivatives that couple the plane with its normal to zero, in two dimensions."""
    if d == 2:
        for row in (2, 5, 6, 7):
            store(s, to + row * LANES, spread(0.0))


@inlined
def pull(s, X):
    """Write ``D_ri = V X_Jr P_Ji`` of the FLUX to NATURAL."""
    volume = load(X, TENSOR)
    for i in range(0, VECTOR, LANES):
        one, two, three = load(s, FLUX + i), load(s, FLUX + VECTOR + i), load(s, FLUX + 2 * VECTOR + i)
        one, two, three = mul(volume, one), mul(volume, two), mul(volume, three)
        for r in range(0, VECTOR, LANES):
            a, b, c = load(X, r), load(X, VECTOR + r), load(X, 2 * VECTOR + r)
            store(s, NATURAL + (r // LANES) * VECTOR + i, dot(a, b, c, one, two, three))


@inlined
def flux(s):
    """Write ``P_Ji = S_JL f_Li`` to FLUX."""
    xx, yy, zz, xy, yz, zx = six(s, STRESS)
    for i in range(0, VECTOR, LANES):
        f, g, h = load(s, FRAME + i), load(s, FRAME + VECTOR + i), load(s, FRAME + 2 * VECTOR + i)
        store(s, FLUX + i, dot(xx, xy, zx, f, g, h))
        store(s, FLUX + VECTOR + i, dot(xy, yy, yz, f, g, h))
        store(s, FLUX + 2 * VECTOR + i, dot(zx, yz, zz, f, g, h))


@inlined
def flux_change(s):
    """Write ``dP = dS f + SPIN S dH`` to FLUX, ``dE = sym(dH f^T)`` and ``dS = SOFT (B:dE) B + 2 STIFF B dE B``."""
    xx, yy, zz, xy, yz, zx = _stress_change(s, *six(s, BRIDGE))
    spin = load(s, SPIN)
    a, b, c, p, q, r = six(s, STRESS)
    for i in range(0, VECTOR, LANES):
        f, g, h = load(s, FRAME + i), load(s, FRAME + VECTOR + i), load(s, FRAME + 2 * VECTOR + i)
        x, y, z = load(s, CHANGE + i), load(s, CHANGE + VECTOR + i), load(s, CHANGE + 2 * VECTOR + i)
        store(s, FLUX + i, fma(spin, dot(a, p, r, x, y, z), dot(xx, xy, zx, f, g, h)))
        store(s, FLUX + VECTOR + i, fma(spin, dot(p, b, q, x, y, z), dot(xy, yy, yz, f, g, h)))
        store(s, FLUX + 2 * VECTOR + i, fma(spin, dot(r, q, c, x, y, z), dot(zx, yz, zz, f, g, h)))


@inlined
def _stress_change(s, xx, yy, zz, xy, yz, zx):
    """Six components of dS from the six components of B."""
    a, b, c = _symmetric(s, 0, 0), _symmetric(s, 1, 1), _symmetric(s, 2, 2)
    p, q, r = _symmetric(s, 0, 1), _symmetric(s, 1, 2), _symmetric(s, 2, 0)
    trace = fma(2.0, dot(xy, yz, zx, p, q, r), dot(xx, yy, zz, a, b, c))
    soft, stiff = mul(load(s, SOFT), trace), fma(2.0, load(s, STIFF), spread(0.0))
    one = dot(xx, xy, zx, a, p, r), dot(xx, xy, zx, p, b, q), dot(xx, xy, zx, r, q, c)  # rows of B dE
    two = dot(xy, yy, yz, a, p, r), dot(xy, yy, yz, p, b, q), dot(xy, yy, yz, r, q, c)
    three = dot(zx, yz, zz, a, p, r), dot(zx, yz, zz, p, b, q), dot(zx, yz, zz, r, q, c)
    return (
        fma(soft, xx, mul(stiff, dot(*one, xx, xy, zx))),
        fma(soft, yy, mul(stiff, dot(*two, xy, yy, yz))),
        fma(soft, zz, mul(stiff, dot(*three, zx, yz, zz))),
        fma(soft, xy, mul(stiff, dot(*one, xy, yy, yz))),
        fma(soft, yz, mul(stiff, dot(*two, zx, yz, zz))),
        fma(soft, zx, mul(stiff, dot(*three, xx, xy, zx))),
    )


@inlined
def _symmetric(s, J, L):
    """``(f_J . dH_L + f_L . dH_J)/2``."""
    f, g, h, k = FRAME + J * VECTOR, CHANGE + L * VECTOR, FRAME + L * VECTOR, CHANGE + J * VECTOR
    one = dot(*_three(s, f), *_three(s, g))
    two = dot(*_three(s, h), *_three(s, k))
    return fma(0.5, one, fma(0.5, two, spread(0.0)))


@inlined
def unit(s, t, j, to):
    """Write derivatives with entry (t, j) one and all others zero to ``s[to:]``."""
    s[to : to + TENSOR] = 0.0
    store(s, to + (3 * t + j) * LANES, spread(1.0))


@inlined
def keep(s, t, j, to):
    """Copy the NATURAL flux D_ri of the unit derivative (t, j) to row (r, t, i, j) of ``s[to:]``."""
    for r in range(3):
        for i in range(3):
            row = 27 * r + 9 * t + 3 * i + j
            store(s, to + row * LANES, load(s, NATURAL + (3 * r + i) * LANES))


@inlined
def couple(s, moved, slopes, node, last, to):
    """Add ``slopes_ar D_ritj slopes_bt`` of node a and all nodes b >= a to entry (b, i, j) of ``s[to:]``."""
    a, b, c = slopes[node, 0], slopes[node, 1], slopes[node, 2]
    for entry in range(0, TENSOR, LANES):
        x = _along(s, moved + entry, a, b, c)
        y = _along(s, moved + TENSOR + entry, a, b, c)
        z = _along(s, moved + 2 * TENSOR + entry, a, b, c)
        for other in range(node, last):
            here = to + other * TENSOR + entry
            rest = fma(slopes[other, 2], z, load(s, here))
            store(s, here, fma(slopes[other, 0], x, fma(slopes[other, 1], y, rest)))


@inlined
def _along(s, at, a, b, c):
    rest = fma(c, load(s, at + 6 * TENSOR), spread(0.0))
    return fma(a, load(s, at), fma(b, load(s, at + 3 * TENSOR), rest))


@inlined
def enter(s, sums, pairs, at, step, d, out):
    """Add the coupled pairs of nodes at ``s[sums:]`` to the entries ``out`` of a symmetric matrix."""
    nodes = pairs.shape[0]
    for k in range(LANES):
        for one in range(nodes):
            for two in range(one, nodes):
                here = sums + (one * nodes + two) * TENSOR + k
                p, r = pairs[one, two, k], pairs[two, one, k]
                for i in range(3):
                    for j in range(3):
                        value = s[here + (3 * i + j) * LANES]
                        out[at[p] + (i % d) * step[p] + j % d] += value
                        if one != two:
                            out[at[r] + (j % d) * step[r] + i % d] += value


@inlined
def enter_diagonal(s, sums, rows, d, out):
    """Add the diagonal blocks of the nodes at ``s[sums:]`` to ``out`` (n, d, d)."""
    for k in range(LANES):
        for node in range(rows.shape[0]):
            row = rows[node, k]
            for entry in range(9):
                out[row, (entry // 3) % d, (entry % 3) % d] += s[sums + node * TENSOR + entry * LANES + k]


@inlined
def dot(a, b, c, x, y, z):
    """``a x + b y + c z``."""
    return fma(a, x, fma(b, y, mul(c, z)))


@inlined
def _three(s, at):
    return load(s, at), load(s, at + LANES), load(s, at + 2 * LANES)


@inlined
def six(s, at):
    """Components of a symmetric tensor."""
    a, b, c = _three(s, at)
    p, q, r = _three(s, at + VECTOR)
    return a, b, c, p, q, r
