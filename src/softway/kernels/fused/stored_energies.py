"""Hooke's law and the compressible neo-Hookean law at the points of the lanes.

Rows are those of :mod:`softway.kernels.jit.lanes`.
"""

from functools import cache

import numpy as np
from numba import carray

from softway.kernels.jit.compilation import Stage, inlined, stage
from softway.kernels.jit.elementary import log1p
from softway.kernels.jit.lanes import BRIDGE, ENERGY, LANES, NODES, SOFT, STIFF, STRESS

_SERIES_BELOW = 1e-2  # |j| below which j - ln(1 + j) is a series: 10 terms have an error below 1e-17 of j^2/2


@cache
def neo_hookean() -> Stage:
    """Stage of :class:`softway.laws.bulk.NeoHookean` in Green's strain, with the moduli (lambda, mu) [Pa]."""
    return stage(_neo_hookean)


def _neo_hookean(state, moduli) -> None:
    s = carray(state, (NODES,))
    bulk_part, shear = carray(moduli, (2,))
    for k in range(LANES):
        e, c = STRESS + k, BRIDGE + k
        xx, yy, zz = s[e], s[e + LANES], s[e + 2 * LANES]
        xy, yz, zx = s[e + 3 * LANES], s[e + 4 * LANES], s[e + 5 * LANES]
        second = xx * yy + yy * zz + zz * xx - xy * xy - yz * yz - zx * zx
        third = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx)
        higher = 4.0 * second + 8.0 * third
        j = 2.0 * (xx + yy + zz) + higher
        j = j if j > -1.0 else np.nan
        shrink = 1.0 / (1.0 + j)
        logarithm = log1p(j, shrink)
        energy = 0.5 * shear * (_excess(j, logarithm) - higher) + 0.125 * bulk_part * logarithm * logarithm
        s[ENERGY + k] = energy if energy < np.inf else np.inf
        ax, ay, az, bx, by, bz = _inverse(xx, yy, zz, xy, yz, zx, shrink)
        pull, twice = 0.5 * bulk_part * logarithm, 2.0 * shear
        s[e] = twice * (ax * xx + bx * xy + bz * zx) + pull * ax
        s[e + LANES] = twice * (bx * xy + ay * yy + by * yz) + pull * ay
        s[e + 2 * LANES] = twice * (bz * zx + by * yz + az * zz) + pull * az
        s[e + 3 * LANES] = twice * (ax * xy + bx * yy + bz * yz) + pull * bx
        s[e + 4 * LANES] = twice * (bx * zx + ay * yz + by * zz) + pull * by
        s[e + 5 * LANES] = twice * (bz * xx + by * xy + az * zx) + pull * bz
        s[c], s[c + LANES], s[c + 2 * LANES] = ax, ay, az
        s[c + 3 * LANES], s[c + 4 * LANES], s[c + 5 * LANES] = bx, by, bz
        s[SOFT + k] = bulk_part
        s[STIFF + k] = shear - pull


@inlined
def _inverse(xx, yy, zz, xy, yz, zx, shrink):
    """Inverse of ``C = I + 2 E`` by cofactors; ``shrink`` is 1/det C."""
    ax, ay, az, bx, by, bz = 1.0 + 2.0 * xx, 1.0 + 2.0 * yy, 1.0 + 2.0 * zz, 2.0 * xy, 2.0 * yz, 2.0 * zx
    return (
        (ay * az - by * by) * shrink,
        (az * ax - bz * bz) * shrink,
        (ax * ay - bx * bx) * shrink,
        (by * bz - bx * az) * shrink,
        (bz * bx - by * ax) * shrink,
        (bx * by - bz * ay) * shrink,
    )


@inlined
def _excess(j, logarithm):
    """``j - ln(1 + j)`` without cancellation: ``j^2 (1/2 - j/3 + j^2/4 - ...)``."""
    small = abs(j) < _SERIES_BELOW
    x = j if small else 0.0
    series = 1.0 / 10.0 - x / 11.0
    for n in range(9, 1, -1):
        series = 1.0 / n - x * series
    return x * x * series if small else j - logarithm


@cache
def hooke() -> Stage:
    """``W = lambda/2 (tr E)^2 + mu E:E`` with the moduli (lambda, mu) [Pa]; infinite where the strain is ``nan``."""
    return stage(_hooke)


def _hooke(state, moduli) -> None:
    s = carray(state, (NODES,))
    bulk_part, shear = carray(moduli, (2,))
    for k in range(LANES):
        e, b = STRESS + k, BRIDGE + k
        xx, yy, zz = s[e], s[e + LANES], s[e + 2 * LANES]
        xy, yz, zx = s[e + 3 * LANES], s[e + 4 * LANES], s[e + 5 * LANES]
        trace = xx + yy + zz
        square = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
        energy = 0.5 * bulk_part * trace * trace + shear * square
        s[ENERGY + k] = energy if energy < np.inf else np.inf
        for row in range(6):
            pressure = bulk_part * trace if row < 3 else 0.0
            s[e + row * LANES] = pressure + 2.0 * shear * s[e + row * LANES]
            s[b + row * LANES] = 1.0 if row < 3 else 0.0
        s[SOFT + k] = bulk_part
        s[STIFF + k] = shear
