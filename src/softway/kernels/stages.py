"""What the fused kernels are made of: from nodes to a point of the lanes and back; rows as in
:mod:`softway.kernels.lanes`.

In two dimensions the third component of a nodal vector repeats the first: it is what the hoop strain needs.
"""

from softway.kernels.compiled import inlined
from softway.kernels.lanes import (
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
from softway.kernels.vectors import fma, load, mul, spread, store


@inlined
def gather(u, rows, s, at):
    """Nodal vectors u (n, d) of the cells to ``s[at:]``."""
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
def differentiate(s, at, slopes):
    """NATURAL ``D_ri = sum_a slopes_ar u_ai`` of the nodal vectors ``s[at:]``."""
    for i in range(0, VECTOR, LANES):
        one = two = three = spread(0.0)
        for node in range(slopes.shape[0]):
            value = load(s, at + node * VECTOR + i)
            one = fma(slopes[node, 0], value, one)
            two = fma(slopes[node, 1], value, two)
            three = fma(slopes[node, 2], value, three)
        store(s, NATURAL + i, one)
        store(s, NATURAL + VECTOR + i, two)
        store(s, NATURAL + 2 * VECTOR + i, three)


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
    """``H_Ji = X_Jr D_ri`` to ``s[to:]``; in two dimensions none couple the plane with its normal."""
    for i in range(0, VECTOR, LANES):
        one, two, three = load(s, NATURAL + i), load(s, NATURAL + VECTOR + i), load(s, NATURAL + 2 * VECTOR + i)
        for J in range(0, TENSOR, VECTOR):
            store(s, to + J + i, _dot(load(X, J), load(X, J + LANES), load(X, J + 2 * LANES), one, two, three))
    if d == 2:
        for row in (2, 5, 6, 7):
            store(s, to + row * LANES, spread(0.0))


@inlined
def pull(s, X):
    """``D_ri = V X_Jr P_Ji`` of the FLUX to NATURAL."""
    volume = load(X, TENSOR)
    for i in range(0, VECTOR, LANES):
        one, two, three = load(s, FLUX + i), load(s, FLUX + VECTOR + i), load(s, FLUX + 2 * VECTOR + i)
        one, two, three = mul(volume, one), mul(volume, two), mul(volume, three)
        for r in range(0, VECTOR, LANES):
            a, b, c = load(X, r), load(X, VECTOR + r), load(X, 2 * VECTOR + r)
            store(s, NATURAL + (r // LANES) * VECTOR + i, _dot(a, b, c, one, two, three))


@inlined
def flux(s):
    """``P_Ji = S_JL f_Li`` to FLUX."""
    xx, yy, zz, xy, yz, zx = _six(s, STRESS)
    for i in range(0, VECTOR, LANES):
        f, g, h = load(s, FRAME + i), load(s, FRAME + VECTOR + i), load(s, FRAME + 2 * VECTOR + i)
        store(s, FLUX + i, _dot(xx, xy, zx, f, g, h))
        store(s, FLUX + VECTOR + i, _dot(xy, yy, yz, f, g, h))
        store(s, FLUX + 2 * VECTOR + i, _dot(zx, yz, zz, f, g, h))


@inlined
def flux_change(s):
    """``dP = dS f + SPIN S dH`` to FLUX, with ``dE = sym(dH f^T)`` and ``dS = SOFT (B:dE) B + 2 STIFF B dE B``."""
    xx, yy, zz, xy, yz, zx = _stress_change(s, *_six(s, BRIDGE))
    spin = load(s, SPIN)
    a, b, c, p, q, r = _six(s, STRESS)
    for i in range(0, VECTOR, LANES):
        f, g, h = load(s, FRAME + i), load(s, FRAME + VECTOR + i), load(s, FRAME + 2 * VECTOR + i)
        x, y, z = load(s, CHANGE + i), load(s, CHANGE + VECTOR + i), load(s, CHANGE + 2 * VECTOR + i)
        store(s, FLUX + i, fma(spin, _dot(a, p, r, x, y, z), _dot(xx, xy, zx, f, g, h)))
        store(s, FLUX + VECTOR + i, fma(spin, _dot(p, b, q, x, y, z), _dot(xy, yy, yz, f, g, h)))
        store(s, FLUX + 2 * VECTOR + i, fma(spin, _dot(r, q, c, x, y, z), _dot(zx, yz, zz, f, g, h)))


@inlined
def _stress_change(s, xx, yy, zz, xy, yz, zx):
    """The six components of dS, with those of B."""
    a, b, c = _symmetric(s, 0, 0), _symmetric(s, 1, 1), _symmetric(s, 2, 2)
    p, q, r = _symmetric(s, 0, 1), _symmetric(s, 1, 2), _symmetric(s, 2, 0)
    trace = fma(2.0, _dot(xy, yz, zx, p, q, r), _dot(xx, yy, zz, a, b, c))
    soft, stiff = mul(load(s, SOFT), trace), fma(2.0, load(s, STIFF), spread(0.0))
    one = _dot(xx, xy, zx, a, p, r), _dot(xx, xy, zx, p, b, q), _dot(xx, xy, zx, r, q, c)  # rows of B dE
    two = _dot(xy, yy, yz, a, p, r), _dot(xy, yy, yz, p, b, q), _dot(xy, yy, yz, r, q, c)
    three = _dot(zx, yz, zz, a, p, r), _dot(zx, yz, zz, p, b, q), _dot(zx, yz, zz, r, q, c)
    return (
        fma(soft, xx, mul(stiff, _dot(*one, xx, xy, zx))),
        fma(soft, yy, mul(stiff, _dot(*two, xy, yy, yz))),
        fma(soft, zz, mul(stiff, _dot(*three, zx, yz, zz))),
        fma(soft, xy, mul(stiff, _dot(*one, xy, yy, yz))),
        fma(soft, yz, mul(stiff, _dot(*two, zx, yz, zz))),
        fma(soft, zx, mul(stiff, _dot(*three, xx, xy, zx))),
    )


@inlined
def _symmetric(s, J, L):
    """``(f_J . dH_L + f_L . dH_J)/2``."""
    f, g, h, k = FRAME + J * VECTOR, CHANGE + L * VECTOR, FRAME + L * VECTOR, CHANGE + J * VECTOR
    one = _dot(*_three(s, f), *_three(s, g))
    two = _dot(*_three(s, h), *_three(s, k))
    return fma(0.5, one, fma(0.5, two, spread(0.0)))


@inlined
def _dot(a, b, c, x, y, z):
    return fma(a, x, fma(b, y, mul(c, z)))


@inlined
def _three(s, at):
    return load(s, at), load(s, at + LANES), load(s, at + 2 * LANES)


@inlined
def _six(s, at):
    a, b, c = _three(s, at)
    p, q, r = _three(s, at + VECTOR)
    return a, b, c, p, q, r
