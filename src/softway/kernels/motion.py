"""Motion of a slab at the points of the lanes: strain, turn and cofactors; rows as in :mod:`softway.kernels.lanes`.

The compiled form of :mod:`softway.bodies.kinematics` for the rate of Jaumann, with the increment on the middle.
"""

from functools import cache

import numpy as np
from numba import carray

from softway.kernels.compiled import Stage, inlined, stage
from softway.kernels.functions import log1p
from softway.kernels.lanes import FRAME, LANES, PAST, RATIO, SHRINK, STEP, STRAIN, TURN


@cache
def midpoint() -> Stage:
    """From the derivatives at the end of the slab and their change to STRAIN, TURN, RATIO and the cofactors."""
    return stage(_midpoint)


def _midpoint(state, moduli) -> None:
    s = carray(state, (PAST,))
    for k in range(LANES):
        f = _nine(s, FRAME + k)
        d = _nine(s, STEP + k)
        f = (1.0 + f[0], f[1], f[2], f[3], 1.0 + f[4], f[5], f[6], f[7], 1.0 + f[8])
        middle = (
            f[0] - 0.5 * d[0], f[1] - 0.5 * d[1], f[2] - 0.5 * d[2],
            f[3] - 0.5 * d[3], f[4] - 0.5 * d[4], f[5] - 0.5 * d[5],
            f[6] - 0.5 * d[6], f[7] - 0.5 * d[7], f[8] - 0.5 * d[8],
        )  # fmt: skip
        cofactors = _cofactors(*f)
        ratio = f[0] * cofactors[0] + f[1] * cofactors[1] + f[2] * cofactors[2]
        _put(s, FRAME + k, cofactors)
        c = _cofactors(*middle)
        volume = middle[0] * c[0] + middle[1] * c[1] + middle[2] * c[2]
        s[RATIO + k], s[SHRINK + k] = volume, 1.0 / ratio
        L = _gradient(d, c, 1.0 / volume)
        missing = (_dilation(*L) - (L[0] + L[4] + L[8])) / 3.0
        missing += 0.0 if ratio > 0.0 else np.nan
        e = STRAIN + k
        s[e], s[e + LANES], s[e + 2 * LANES] = L[0] + missing, L[4] + missing, L[8] + missing
        s[e + 3 * LANES], s[e + 4 * LANES] = 0.5 * (L[1] + L[3]), 0.5 * (L[5] + L[7])
        s[e + 5 * LANES] = 0.5 * (L[2] + L[6])
        _put(s, TURN + k, _half_turn(0.25 * (L[7] - L[5]), 0.25 * (L[2] - L[6]), 0.25 * (L[3] - L[1])))


@inlined
def _nine(s, at):
    one = s[at], s[at + LANES], s[at + 2 * LANES]
    two = s[at + 3 * LANES], s[at + 4 * LANES], s[at + 5 * LANES]
    three = s[at + 6 * LANES], s[at + 7 * LANES], s[at + 8 * LANES]
    return (*one, *two, *three)


@inlined
def _put(s, at, T):
    s[at], s[at + LANES], s[at + 2 * LANES] = T[0], T[1], T[2]
    s[at + 3 * LANES], s[at + 4 * LANES], s[at + 5 * LANES] = T[3], T[4], T[5]
    s[at + 6 * LANES], s[at + 7 * LANES], s[at + 8 * LANES] = T[6], T[7], T[8]


@inlined
def _cofactors(a, b, c, d, e, f, g, h, i):
    """Rows of ``J F^-1`` (J, i) of the rows ``f_Ji = F_iJ``."""
    return (
        e * i - f * h, f * g - d * i, d * h - e * g,
        h * c - i * b, i * a - g * c, g * b - h * a,
        b * f - c * e, c * d - a * f, a * e - b * d,
    )  # fmt: skip


@inlined
def _gradient(d, c, shrink):
    """``L_ij = dF_iJ dX_J/dx_j`` of the rows ``d_Ji = dF_iJ`` and the cofactors c of the middle."""
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
def _dilation(a, b, c, d, e, f, g, h, i):
    """``ln J1/J0 = ln((1 + t)/(1 - t))`` of the gradient L of the slab; ``nan`` where a volume changes its sign.

    ``J1/J0 = det(I + L/2)/det(I - L/2)`` is written with the invariants of L: no digits are lost where L is small.
    """
    second = (a * e - b * d) + (e * i - f * h) + (i * a - c * g)
    third = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    top, base = 0.5 * (a + e + i) + 0.125 * third, 1.0 + 0.25 * second
    more, less = base + top, base - top
    both = more * less
    shrink = 1.0 / (both if both > 0.0 else np.nan)
    return log1p(2.0 * top * more * shrink, less * less * shrink)


@inlined
def _half_turn(x, y, z):
    """Half of the rotation whose unit quaternion is along (1, x, y, z), see softway.bodies.kinematics.half_turn."""
    length = np.sqrt(1.0 + (x * x + y * y + z * z))
    scale = 1.0 / (length * (1.0 + length))
    spin = scale * (1.0 + length)
    return (
        1.0 - scale * (y * y + z * z), scale * x * y - spin * z, scale * z * x + spin * y,
        scale * x * y + spin * z, 1.0 - scale * (z * z + x * x), scale * y * z - spin * x,
        scale * z * x - spin * y, scale * y * z + spin * x, 1.0 - scale * (x * x + y * y),
    )  # fmt: skip
