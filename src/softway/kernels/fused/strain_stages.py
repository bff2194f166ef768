"""Strain measures at the points of the lanes: from displacement derivatives to strain and carrier.

Compiled form of :mod:`softway.laws.strain_measures` for cells that fill their space; rows as in
:mod:`softway.kernels.jit.lanes`.
"""

from functools import cache

import numpy as np
from numba import carray

from softway.kernels.jit.compilation import Stage, stage
from softway.kernels.jit.lanes import FRAME, LANES, NODES, SPIN, STRESS


@cache
def green() -> Stage:
    """Green's strain ``(H + H^T + H H^T)/2``, ``nan`` where the material is inverted, and the carrier ``I + H``."""
    return stage(_green)


@cache
def small() -> Stage:
    """Linearised strain ``(H + H^T)/2`` and the carrier ``I``."""
    return stage(_small)


def _green(state, moduli) -> None:
    s = carray(state, (NODES,))
    for k in range(LANES):
        f, e = FRAME + k, STRESS + k
        a, b, c = s[f], s[f + LANES], s[f + 2 * LANES]
        d, g, h = s[f + 3 * LANES], s[f + 4 * LANES], s[f + 5 * LANES]
        p, q, r = s[f + 6 * LANES], s[f + 7 * LANES], s[f + 8 * LANES]
        x, y, z = 1.0 + a, 1.0 + g, 1.0 + r
        ratio = x * (y * z - h * q) - b * (d * z - h * p) + c * (d * q - y * p)
        bad = 0.0 if ratio > 0.0 else np.nan
        s[e] = a + 0.5 * (a * a + b * b + c * c) + bad
        s[e + LANES] = g + 0.5 * (d * d + g * g + h * h) + bad
        s[e + 2 * LANES] = r + 0.5 * (p * p + q * q + r * r) + bad
        s[e + 3 * LANES] = 0.5 * (b + d + (a * d + b * g + c * h))
        s[e + 4 * LANES] = 0.5 * (h + q + (d * p + g * q + h * r))
        s[e + 5 * LANES] = 0.5 * (p + c + (a * p + b * q + c * r))
        s[f], s[f + 4 * LANES], s[f + 8 * LANES] = x, y, z
        s[SPIN + k] = 1.0


def _small(state, moduli) -> None:
    s = carray(state, (NODES,))
    for k in range(LANES):
        f, e = FRAME + k, STRESS + k
        s[e], s[e + LANES], s[e + 2 * LANES] = s[f], s[f + 4 * LANES], s[f + 8 * LANES]
        s[e + 3 * LANES] = 0.5 * (s[f + LANES] + s[f + 3 * LANES])
        s[e + 4 * LANES] = 0.5 * (s[f + 5 * LANES] + s[f + 7 * LANES])
        s[e + 5 * LANES] = 0.5 * (s[f + 6 * LANES] + s[f + 2 * LANES])
    s[FRAME : SPIN + LANES] = 0.0
    for start in range(FRAME, SPIN, 4 * LANES):
        s[start : start + LANES] = 1.0
