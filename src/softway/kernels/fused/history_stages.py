"""Building blocks of the fused kernels of laws with a history, in addition to :mod:`softway.kernels.fused.stages`.

The history variables are stored point after point, as in the rest of the program.  ``past`` holds the stress (p, 3, 3)
[Pa], the plastic strain (p,), the back stress (p, 3, 3) [Pa], and the stored and the dissipated energy (p,) [J/m^3].
Plastic strain and back stress are empty for laws without them.  Lanes without a cell have point numbers beyond the
last point.
"""

import numpy as np

from softway.kernels.fused.stages import dot, six
from softway.kernels.jit.compilation import inlined
from softway.kernels.jit.lanes import (
    BACK,
    BRIDGE,
    BULK,
    CHANGE,
    FRAME,
    LANES,
    NATURAL,
    PLASTIC,
    SHRINK,
    SOFT,
    STIFF,
    STRESS,
    TENSOR,
    TURN,
    VECTOR,
)
from softway.kernels.jit.simd import fetch, fma, load, mul, spread, store

_AHEAD = 16  # number of points of a lane between prefetching and reading


@inlined
def recall(s, points, q, past):
    """Read stress, plastic strain and back stress at point q of the cells with the first points ``points``."""
    stress, plastic, back = past[0], past[1], past[2]
    for k in range(LANES):
        p = points[k] + q
        if p < len(stress):
            _read(s, STRESS + k, stress, p)
            s[PLASTIC + k] = plastic[p] if len(plastic) else 0.0
            if len(back):
                _read(s, BACK + k, back, p)
        else:
            for row in range(6):
                s[STRESS + k + row * LANES] = s[BACK + k + row * LANES] = 0.0
            s[PLASTIC + k] = 0.0


@inlined
def foresee(points, block, last, q, of, past):
    """Prefetch the data of point q, one of ``of`` points of a cell, that :func:`recall` reads a few blocks later."""
    there = min(block + 1 + (_AHEAD - 1) // of, last)
    for k in range(LANES):
        p = min(np.int64(points[there, k]) + q, len(past[0]) - 1)
        fetch(past[0], 9 * p)
        fetch(past[0], 9 * p + 8)
        if q == 0 and len(past[1]):
            fetch(past[1], p)
        if len(past[2]):
            fetch(past[2], 9 * p + 8)


@inlined
def _read(s, at, tensors, p):
    t = tensors[p]
    s[at], s[at + LANES], s[at + 2 * LANES] = t[0, 0], t[1, 1], t[2, 2]
    s[at + 3 * LANES], s[at + 4 * LANES], s[at + 5 * LANES] = t[0, 1], t[1, 2], t[2, 0]


@inlined
def write(s, at, tensors, p):
    """Write a symmetric tensor of one lane to ``tensors[p]``."""
    t = tensors[p]
    t[0, 0], t[1, 1], t[2, 2] = s[at], s[at + LANES], s[at + 2 * LANES]
    t[0, 1] = t[1, 0] = s[at + 3 * LANES]
    t[1, 2] = t[2, 1] = s[at + 4 * LANES]
    t[2, 0] = t[0, 2] = s[at + 5 * LANES]


@inlined
def turn(s, at):
    """Rotate a symmetric tensor ``s[at:]`` to the axes half a slab later, ``R s R^T``."""
    xx, yy, zz, xy, yz, zx = six(s, at)
    a, b, c = _row(s, TURN)
    d, e, f = _row(s, TURN + VECTOR)
    g, h, i = _row(s, TURN + 2 * VECTOR)
    x, y, z = dot(a, b, c, xx, xy, zx), dot(a, b, c, xy, yy, yz), dot(a, b, c, zx, yz, zz)
    store(s, at, dot(x, y, z, a, b, c))
    store(s, at + 3 * LANES, dot(x, y, z, d, e, f))
    store(s, at + 5 * LANES, dot(x, y, z, g, h, i))
    x, y, z = dot(d, e, f, xx, xy, zx), dot(d, e, f, xy, yy, yz), dot(d, e, f, zx, yz, zz)
    store(s, at + LANES, dot(x, y, z, d, e, f))
    store(s, at + 4 * LANES, dot(x, y, z, g, h, i))
    x, y, z = dot(g, h, i, xx, xy, zx), dot(g, h, i, xy, yy, yz), dot(g, h, i, zx, yz, zz)
    store(s, at + 2 * LANES, dot(x, y, z, g, h, i))


@inlined
def piola(s, weight):
    """Write the flux ``D_ri = weight j d xi_r/dx_a s_ai`` of the Cauchy stress to NATURAL; cofactors are in FRAME."""
    xx, yy, zz, xy, yz, zx = six(s, STRESS)
    xx, yy, zz, xy, yz, zx = weight * xx, weight * yy, weight * zz, weight * xy, weight * yz, weight * zx
    for J in range(0, TENSOR, VECTOR):
        a, b, c = _row(s, FRAME + J)
        store(s, NATURAL + J, dot(xx, xy, zx, a, b, c))
        store(s, NATURAL + J + LANES, dot(xy, yy, yz, a, b, c))
        store(s, NATURAL + J + 2 * LANES, dot(zx, yz, zz, a, b, c))


@inlined
def piola_change(s, weight):
    """Write the change of D due to the CHANGE of the derivatives to NATURAL.

    ``dD_ri = weight K_ra (C:d + s l^T)_ai`` with the gradient l of the change, its symmetric part d, the cofactors K
    and the symmetrised moduli C of the Truesdell rate: see
    softway.bodies.internal_force.inelastic.material_points.spatial.
    """
    l1, l2, l3 = _change(s, 0), _change(s, LANES), _change(s, 2 * LANES)
    xx, yy, zz, xy, yz, zx = six(s, STRESS)
    a, b, c, p, q, r = _moduli(s, l1, l2, l3)
    for J in range(0, TENSOR, VECTOR):
        f, g, h = _row(s, FRAME + J)
        f, g, h = weight * f, weight * g, weight * h
        x, y, z = dot(xx, xy, zx, f, g, h), dot(xy, yy, yz, f, g, h), dot(zx, yz, zz, f, g, h)
        store(s, NATURAL + J, fma(1.0, dot(a, p, r, f, g, h), dot(x, y, z, *l1)))
        store(s, NATURAL + J + LANES, fma(1.0, dot(p, b, q, f, g, h), dot(x, y, z, *l2)))
        store(s, NATURAL + J + 2 * LANES, fma(1.0, dot(r, q, c, f, g, h), dot(x, y, z, *l3)))


@inlined
def _change(s, i):
    """Row i of the gradient ``l_ia = dD_ri K_ra / j``."""
    shrink = load(s, SHRINK)
    x, y, z = load(s, CHANGE + i), load(s, CHANGE + VECTOR + i), load(s, CHANGE + 2 * VECTOR + i)
    x, y, z = mul(shrink, x), mul(shrink, y), mul(shrink, z)
    one = dot(x, y, z, load(s, FRAME), load(s, FRAME + VECTOR), load(s, FRAME + 2 * VECTOR))
    at = FRAME + LANES
    two = dot(x, y, z, load(s, at), load(s, at + VECTOR), load(s, at + 2 * VECTOR))
    at = FRAME + 2 * LANES
    three = dot(x, y, z, load(s, at), load(s, at + VECTOR), load(s, at + 2 * VECTOR))
    return one, two, three


@inlined
def _moduli(s, l1, l2, l3):
    """``SOFT dev(d) + BULK tr(d) I - STIFF n (n:d) - d s - s d + (tr(d) s + (s:d) I)/2``."""
    n, t = six(s, BRIDGE), six(s, STRESS)
    d = l1[0], l2[1], l3[2], _mean(l1[1], l2[0]), _mean(l2[2], l3[1]), _mean(l3[0], l1[2])
    trace = fma(1.0, d[0], fma(1.0, d[1], d[2]))
    soft, half = load(s, SOFT), mul(spread(0.5), trace)
    along = fma(-1.0, mul(load(s, STIFF), _double(n, d)), spread(0.0))
    rest = mul(fma(-1.0 / 3.0, soft, load(s, BULK)), trace)
    rest = fma(0.5, _double(t, d), rest)
    xx, xy = dot(t[0], t[3], t[5], d[0], d[3], d[5]), dot(t[0], t[3], t[5], d[3], d[1], d[4])
    yy = dot(t[3], t[1], t[4], d[3], d[1], d[4])
    zz = dot(t[5], t[4], t[2], d[5], d[4], d[2])
    xy = _mean(xy, dot(t[3], t[1], t[4], d[0], d[3], d[5]))
    yz = _mean(dot(t[3], t[1], t[4], d[5], d[4], d[2]), dot(t[5], t[4], t[2], d[3], d[1], d[4]))
    zx = _mean(dot(t[5], t[4], t[2], d[0], d[3], d[5]), dot(t[0], t[3], t[5], d[5], d[4], d[2]))
    return (
        fma(-2.0, xx, fma(soft, d[0], fma(half, t[0], fma(along, n[0], rest)))),
        fma(-2.0, yy, fma(soft, d[1], fma(half, t[1], fma(along, n[1], rest)))),
        fma(-2.0, zz, fma(soft, d[2], fma(half, t[2], fma(along, n[2], rest)))),
        fma(-2.0, xy, fma(soft, d[3], fma(half, t[3], mul(along, n[3])))),
        fma(-2.0, yz, fma(soft, d[4], fma(half, t[4], mul(along, n[4])))),
        fma(-2.0, zx, fma(soft, d[5], fma(half, t[5], mul(along, n[5])))),
    )


@inlined
def _double(S, T):
    """``S:T`` of two symmetric tensors."""
    return fma(2.0, dot(S[3], S[4], S[5], T[3], T[4], T[5]), dot(S[0], S[1], S[2], T[0], T[1], T[2]))


@inlined
def _mean(a, b):
    return fma(0.5, a, fma(0.5, b, spread(0.0)))


@inlined
def _row(s, at):
    return load(s, at), load(s, at + LANES), load(s, at + 2 * LANES)
