"""Energies and forces of a free expansion of the nodes, in one pass over the cells.

With the free strain ``e`` of the nodes, spread by the functions ``psi`` of heat, the energy per volume is
``-k e ln J``, or ``-k e tr H`` in the linear theory.  Arguments as in :mod:`softway.kernels.fused.elastic`, and

``modulus``, ``small``
    Stress ``k`` of a free strain of one where it is held [Pa], and True for the linear theory.
``functions`` (1 or b, q, a LANES)
    Functions ``psi`` of the nodes at the points; one block where they are the same in all cells.
"""

import numpy as np

from softway.kernels.fused.stages import collect, differentiate, gather, place, pull, scatter, scratch
from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.jit.elementary import log1p
from softway.kernels.jit.lanes import ENERGY, FLUX, FRAME, LANES, NATURAL, NODES, SOFT, STIFF, TENSOR, VECTOR
from softway.kernels.jit.simd import fma, load, mul, pick, spread, store

CHANGE_OF_VOLUME, RATIO, SHRINK = ENERGY, SOFT, STIFF
"""Rows of ``J - 1``, of ``J``, and of ``1/J``."""


@kernel
def held(modulus, small, functions, rows, table, geometry, starts, first, last, u, out):
    """Add the energies [J] that a free strain of one of each node would take, ``H``, to ``out`` (n,)."""
    nodes = rows.shape[1]
    sums = NODES + nodes * VECTOR
    s = scratch(sums + nodes * LANES)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, NODES)
        s[sums:] = 0.0
        psi = functions[block % len(functions)]
        for q in range(table.shape[0]):
            _strained(s, table[q], geometry[block, q], u.shape[1], small)
            if not small:
                for k in range(LANES):
                    s[CHANGE_OF_VOLUME + k] = log1p(s[CHANGE_OF_VOLUME + k], s[SHRINK + k])
            energy = mul(load(geometry[block, q], TENSOR), modulus * load(s, CHANGE_OF_VOLUME))
            for node in range(nodes):
                to = sums + node * LANES
                store(s, to, fma(load(psi[q], node * LANES), energy, load(s, to)))
        for k in range(LANES):
            for node in range(nodes):
                out[rows[block, node, k]] += s[sums + node * LANES + k]


@kernel
def forces(modulus, small, functions, rows, table, geometry, starts, first, last, u, free, out):
    """Add the nodal forces [N] of each of the free strains ``free`` (c, n) to ``out`` (c, n, d)."""
    nodes, count = rows.shape[1], len(free)
    strains = NODES + nodes * VECTOR
    sums = strains + count * nodes * LANES
    s = scratch(sums + count * nodes * VECTOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, NODES)
        for c in range(count):
            for node in range(nodes):
                for k in range(LANES):
                    s[strains + (c * nodes + node) * LANES + k] = free[c, rows[block, node, k]]
        s[sums:] = 0.0
        psi = functions[block % len(functions)]
        for q in range(table.shape[0]):
            _strained(s, table[q], geometry[block, q], u.shape[1], small)
            for c in range(count):
                strain = spread(0.0)
                for node in range(nodes):
                    strain = fma(load(psi[q], node * LANES), load(s, strains + (c * nodes + node) * LANES), strain)
                _flux(s, -modulus * strain, small)
                pull(s, geometry[block, q])
                collect(s, table[q], sums + c * nodes * VECTOR)
        for c in range(count):
            scatter(s, sums + c * nodes * VECTOR, rows[block], out[c])


@inlined
def _strained(s, slopes, X, d, small):
    """Write the derivatives ``f = I + H``, ``J - 1``, J and 1/J, not a number where it is not positive.

    In the linear theory ``J - 1`` is the trace of H.
    """
    differentiate(s, NODES, slopes, NATURAL)
    place(s, X, FRAME, d)
    a, b, c = load(s, FRAME), load(s, FRAME + LANES), load(s, FRAME + 2 * LANES)
    p, q, r = load(s, FRAME + 3 * LANES), load(s, FRAME + 4 * LANES), load(s, FRAME + 5 * LANES)
    x, y, z = load(s, FRAME + 6 * LANES), load(s, FRAME + 7 * LANES), load(s, FRAME + 8 * LANES)
    trace = a + q + z
    if small:
        store(s, CHANGE_OF_VOLUME, trace)
    else:
        minors = (a * q - b * p) + (a * z - c * x) + (q * z - r * y)
        change = trace + (minors + (a * (q * z - r * y) - b * (p * z - r * x) + c * (p * y - q * x)))
        change = pick(change, spread(-1.0), change, spread(np.nan))
        store(s, CHANGE_OF_VOLUME, change)
        store(s, RATIO, 1.0 + change)
        store(s, SHRINK, 1.0 / (1.0 + change))
        store(s, FRAME, 1.0 + a)
        store(s, FRAME + 4 * LANES, 1.0 + q)
        store(s, FRAME + 8 * LANES, 1.0 + z)


@inlined
def _flux(s, stress, small):
    """Write the flux ``stress f^-T``, or ``stress I`` in the linear theory, to FLUX."""
    if small:
        for row in range(9):
            store(s, FLUX + row * LANES, stress if row % 4 == 0 else spread(0.0))
    else:
        scaled = stress * load(s, SHRINK)
        for row in range(3):
            one, two = FRAME + (row + 1) % 3 * VECTOR, FRAME + (row + 2) % 3 * VECTOR
            for i in range(3):
                j, k = (i + 1) % 3 * LANES, (i + 2) % 3 * LANES
                cofactor = load(s, one + j) * load(s, two + k) - load(s, one + k) * load(s, two + j)
                store(s, FLUX + row * VECTOR + i * LANES, scaled * cofactor)
