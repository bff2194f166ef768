"""Kinematics of a slab at the points: strain, rotation and cofactors; rows as in :mod:`softway.kernels.jit.lanes`.

Compiled form of :mod:`softway.bodies.internal_force.inelastic.slab_kinematics` for the Jaumann rate with the midpoint
increment.
"""

from functools import cache

import numpy as np
from numba import carray

from softway.kernels.jit.compilation import Stage, inlined, stage
from softway.kernels.jit.elementary import log1p, log_tail
from softway.kernels.jit.lanes import FRAME, LANES, PAST, RATIO, STEP, STRAIN, TURN, VOLUME
from softway.kernels.jit.simd import any_above, load, pick, root, spread, store

_SMALL = 0.0294  # greatest t^2 for which the polynomial of the logarithm is valid


@cache
def midpoint() -> Stage:
    """Stage that computes the motion from the derivatives of the positions at the end of the slab and their change."""
    return stage(_midpoint)


def _midpoint(state, moduli) -> None:
    s = carray(state, (PAST,))
    f, d = _nine(s, FRAME), _nine(s, STEP)
    c = _cofactors(*f)
    volume = f[0] * c[0] + f[1] * c[1] + f[2] * c[2]
    store(s, VOLUME, volume)
    _put(s, FRAME, c)
    f = (
        f[0] - 0.5 * d[0], f[1] - 0.5 * d[1], f[2] - 0.5 * d[2],
        f[3] - 0.5 * d[3], f[4] - 0.5 * d[4], f[5] - 0.5 * d[5],
        f[6] - 0.5 * d[6], f[7] - 0.5 * d[7], f[8] - 0.5 * d[8],
    )  # fmt: skip
    c = _cofactors(*f)
    middle = f[0] * c[0] + f[1] * c[1] + f[2] * c[2]
    store(s, RATIO, middle)
    L = _gradient(d, c, 1.0 / middle)
    _put(s, TURN, _half_turn(0.25 * (L[7] - L[5]), 0.25 * (L[2] - L[6]), 0.25 * (L[3] - L[1])))
    wanted = pick(volume, spread(0.0), _dilation(s, *L), spread(np.nan))
    missing = (wanted - (L[0] + L[4] + L[8])) * (1.0 / 3.0)
    store(s, STRAIN, L[0] + missing)
    store(s, STRAIN + LANES, L[4] + missing)
    store(s, STRAIN + 2 * LANES, L[8] + missing)
    store(s, STRAIN + 3 * LANES, 0.5 * (L[1] + L[3]))
    store(s, STRAIN + 4 * LANES, 0.5 * (L[5] + L[7]))
    store(s, STRAIN + 5 * LANES, 0.5 * (L[2] + L[6]))


@inlined
def _nine(s, at):
    one = load(s, at), load(s, at + LANES), load(s, at + 2 * LANES)
    two = load(s, at + 3 * LANES), load(s, at + 4 * LANES), load(s, at + 5 * LANES)
    three = load(s, at + 6 * LANES), load(s, at + 7 * LANES), load(s, at + 8 * LANES)
    return (*one, *two, *three)


@inlined
def _put(s, at, T):
    for row in range(9):
        store(s, at + row * LANES, T[row])


@inlined
def _cofactors(a, b, c, d, e, f, g, h, i):
    """Cofactors of a tensor, row by row."""
    return (
        e * i - f * h, f * g - d * i, d * h - e * g,
        h * c - i * b, i * a - g * c, g * b - h * a,
        b * f - c * e, c * d - a * f, a * e - b * d,
    )  # fmt: skip


@inlined
def _gradient(d, c, shrink):
    """``L_ij = d(dx_i)/dx_j`` from the change ``d_ri`` of the derivatives and the cofactors c in the middle."""
    return (
        (d[0] * c[0] + d[3] * c[3] + d[6] * c[6]) * shrink,
        (d[0] * c[1] + d[3] * c[4] + d[6] * c[7]) * shrink,
        (d[0] * c[2] + d[3] * c[5] + d[6] * c[8]) * shrink,
        (d[1] * c[0] + d[4] * c[3] + d[7] * c[6]) * shrink,
        (d[1] * c[1] + d[4] * c[4] + d[7] * c[7]) * shrink,
        (d[1] * c[2] + d[4] * c[5] + d[7] * c[8]) * shrink,
        (d[2] * c[0] + d[5] * c[3] + d[8] * c[6]) * shrink,
        (d[2] * c[1] + d[5] * c[4] + d[8] * c[7]) * shrink,
        (d[2] * c[2] + d[5] * c[5] + d[8] * c[8]) * shrink,
    )


@inlined
def _dilation(s, a, b, c, d, e, f, g, h, i):
    """``ln J1/J0 = ln((1 + t)/(1 - t))`` of the gradient L of the slab; ``nan`` where a volume changes sign.

    ``J1/J0 = det(I + L/2)/det(I - L/2)`` is written in the invariants of L, without cancellation for small L.
    """
    second = (a * e - b * d) + (e * i - f * h) + (i * a - c * g)
    third = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    top, base = 0.5 * (a + e + i) + 0.125 * third, 1.0 + 0.25 * second
    t = top / base
    square = t * t
    if any_above(square, spread(_SMALL)):
        return _large(s, top, base)
    return t * (2.0 + log_tail(square))


@inlined
def _large(s, top, base):
    """Dilation as in :func:`_dilation`, for volume changes of any size."""
    store(s, STRAIN, top)
    store(s, STRAIN + LANES, base)
    for k in range(LANES):
        more, less = s[STRAIN + LANES + k] + s[STRAIN + k], s[STRAIN + LANES + k] - s[STRAIN + k]
        both = more * less
        shrink = 1.0 / (both if both > 0.0 else np.nan)
        s[STRAIN + k] = log1p(2.0 * s[STRAIN + k] * more * shrink, less * less * shrink)
    return load(s, STRAIN)


@inlined
def _half_turn(x, y, z):
    """Half of the rotation with a quaternion along (1, x, y, z).

    See softway.bodies.internal_force.inelastic.slab_kinematics.half_turn.
    """
    length = root(1.0 + (x * x + y * y + z * z))
    scale = 1.0 / (length * (1.0 + length))
    spin = scale * (1.0 + length)
    return (
        1.0 - scale * (y * y + z * z), scale * x * y - spin * z, scale * z * x + spin * y,
        scale * x * y + spin * z, 1.0 - scale * (z * z + x * x), scale * y * z - spin * x,
        scale * z * x - spin * y, scale * y * z + spin * x, 1.0 - scale * (x * x + y * y),
    )  # fmt: skip
