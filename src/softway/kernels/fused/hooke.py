"""Hooke's law at the points of the lanes; rows as in :mod:`softway.kernels.jit.lanes`."""

from functools import cache

import numpy as np
from numba import carray

from softway.kernels.jit.compilation import Stage, stage
from softway.kernels.jit.lanes import BRIDGE, ENERGY, LANES, NODES, SOFT, STIFF, STRESS


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
