"""Internal force, its tangent and tangent products, in one pass over the cells without intermediate arrays.

Common arguments of the kernels:

``measure``, ``law``, ``moduli``
    Addresses of the two stages of a point (strain and carrier, then stress, moduli and energy), and the constants of
    the law.
``rows`` (b, a, LANES)
    Row of the nodal arrays for each node a of the cells in block b; lanes without a cell refer to the last row, where
    the displacement is zero.
``table`` (q, a, 3)
    Derivatives of the shape functions along the reference coordinates.  The third is zero in plane problems, and the
    shape function itself in axisymmetric problems.
``geometry`` (b, q, 10 LANES)
    ``X_Jr = dxi_r/dX_J`` [1/m] in row 3 J + r, and the volume V of the point [m^3]; zero in lanes without a cell.
``starts``, ``first``, ``last``
    First block of each part of the body, and the range of parts to compute; no two parts write to the same row of
    ``out``.
``u`` (n, d)
    Displacement [m].
"""

from softway.kernels.fused.stages import (
    collect,
    couple,
    differentiate,
    enter,
    enter_diagonal,
    flux,
    flux_change,
    gather,
    keep,
    place,
    pull,
    scatter,
    scratch,
    unit,
)
from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.jit.lanes import CHANGE, ENERGY, FRAME, LANES, NATURAL, NODES, TENSOR, TOTAL, VECTOR
from softway.kernels.jit.simd import call, fma, load, spread, store


@kernel
def force(measure, law, moduli, rows, table, geometry, starts, first, last, u, out, energy):
    """Add nodal forces [N] to ``out`` (n, d), and the energy of each cell [J] to ``energy`` (b, LANES)."""
    sums = NODES + rows.shape[1] * VECTOR
    s = scratch(sums + rows.shape[1] * VECTOR)
    for block in range(starts[first], starts[last]):
        store(s, TOTAL, spread(0.0))
        gather(u, rows[block], s, NODES)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            _respond(measure, law, moduli, s, table[q], geometry[block, q], u.shape[1])
            store(s, TOTAL, fma(load(geometry[block, q], TENSOR), load(s, ENERGY), load(s, TOTAL)))
            flux(s)
            pull(s, geometry[block, q])
            collect(s, table[q], sums)
        scatter(s, sums, rows[block], out)
        for lane in range(LANES):
            energy[block, lane] += s[TOTAL + lane]


@kernel
def product(measure, law, moduli, rows, table, geometry, starts, first, last, u, w, out):
    """Add the change of the nodal forces [N] due to a change ``w`` (n, d) [m] of the displacement to ``out`` (n, d)."""
    change = NODES + rows.shape[1] * VECTOR
    sums = change + rows.shape[1] * VECTOR
    s = scratch(sums + rows.shape[1] * VECTOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, NODES)
        gather(w, rows[block], s, change)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            _respond(measure, law, moduli, s, table[q], geometry[block, q], u.shape[1])
            differentiate(s, change, table[q], NATURAL)
            place(s, geometry[block, q], CHANGE, u.shape[1])
            flux_change(s)
            pull(s, geometry[block, q])
            collect(s, table[q], sums)
        scatter(s, sums, rows[block], out)


@kernel
def tangent(measure, law, moduli, rows, table, geometry, starts, first, last, u, pairs, at, step, out):
    """Add the derivative of the force [N/m] to the entries ``out`` of a matrix.

    ``pairs`` (b, a, a, LANES) numbers the pairs of nodes; entry (i, j) of pair p is ``out[at[p] + i step[p] + j]``.
    """
    nodes, d = rows.shape[1], u.shape[1]
    moved = NODES + nodes * VECTOR
    sums = moved + 9 * TENSOR
    s = scratch(sums + nodes * nodes * TENSOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, NODES)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            _respond(measure, law, moduli, s, table[q], geometry[block, q], d)
            _moduli(s, geometry[block, q], d, moved)
            for node in range(nodes):
                couple(s, moved, table[q], node, nodes, sums + node * nodes * TENSOR)
        enter(s, sums, pairs[block], at, step, d, out)


@kernel
def diagonal(measure, law, moduli, rows, table, geometry, starts, first, last, u, out):
    """Add the derivative of the force on each node by the displacement of this node [N/m] to ``out`` (n, d, d)."""
    nodes, d = rows.shape[1], u.shape[1]
    moved = NODES + nodes * VECTOR
    sums = moved + 9 * TENSOR
    s = scratch(sums + nodes * TENSOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, NODES)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            _respond(measure, law, moduli, s, table[q], geometry[block, q], d)
            _moduli(s, geometry[block, q], d, moved)
            for node in range(nodes):
                couple(s, moved, table[q], node, node + 1, sums)
        enter_diagonal(s, sums, rows[block], d, out)


@kernel
def fold(rows, start, out):
    """Add the extra rows of ``out``, which begin at ``start``, to the given ``rows``, one after the other."""
    for k in range(len(rows)):
        out[rows[k]] += out[start + k]


@inlined
def _respond(measure, law, moduli, s, slopes, X, d):
    """Evaluate the stages of a point for the displacement at ``s[NODES:]``."""
    differentiate(s, NODES, slopes, NATURAL)
    place(s, X, FRAME, d)
    call(measure, s, moduli)
    call(law, s, moduli)


@inlined
def _moduli(s, X, d, to):
    """Derivative of the NATURAL flux D_ri by the NATURAL derivative (t, j), in row (r, t, i, j) of ``s[to:]``."""
    for t in range(3):
        for j in range(3):
            unit(s, t, j, NATURAL)
            place(s, X, CHANGE, d)
            flux_change(s)
            pull(s, X)
            keep(s, t, j, to)
