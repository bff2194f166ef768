"""Internal force of laws with a history, its tangent and tangent products, and the update of the history variables.

The kernels have the arguments of :mod:`softway.kernels.fused.elastic`, and in addition:

``motion``, ``law``, ``numbers``
    Addresses of the two stages of a point (motion in the slab, then stress, history variables and energies), and the
    constants of the law.
``geometry`` (b, q, 11 LANES)
    Derivatives ``dX_I/dxi_r`` of the reference positions in row 3 r + I [m], the volume of the point divided by their
    determinant, and the volume [m^3]; a unit cube in lanes without a cell.
``points`` (b, LANES)
    First point of the cell in each lane; lanes without a cell hold the number of points.
``u``, ``step`` (n, d)
    Displacement at the end of the slab, and its change in the slab [m].
``past``
    History variables at the points, see :mod:`softway.kernels.fused.history_stages`.
"""

from softway.kernels.fused.history_stages import foresee, piola, piola_change, recall, turn, write
from softway.kernels.fused.stages import (
    collect,
    couple,
    differentiate,
    enter,
    enter_diagonal,
    gather,
    keep,
    scatter,
    scratch,
    uncouple,
    unit,
)
from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.jit.lanes import (
    BACK,
    BRIDGE,
    CHANGE,
    FRAME,
    LANES,
    LOST,
    PAST,
    PLASTIC,
    RATIO,
    SHRINK,
    STEP,
    STORED,
    STRESS,
    TENSOR,
    TOTAL,
    VECTOR,
    VOLUME,
)
from softway.kernels.jit.simd import call, fma, load, mul, spread, store


@kernel
def force(motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, out, energy):
    """Add nodal forces [N] to ``out`` (n, d), and the energy that each part stores and dissipates [J] to ``energy``."""
    other = PAST + rows.shape[1] * VECTOR
    sums = other + rows.shape[1] * VECTOR
    s = scratch(sums + rows.shape[1] * VECTOR)
    for part in range(first, last):
        store(s, TOTAL, spread(0.0))
        for block in range(starts[part], starts[part + 1]):
            gather(u, rows[block], s, PAST)
            gather(step, rows[block], s, other)
            s[sums:] = 0.0
            for q in range(table.shape[0]):
                X = geometry[block, q]
                moved(s, other, table[q], X, u.shape[1])
                foresee(points, block, starts[part + 1] - 1, q, table.shape[0], past)
                recall(s, points[block], q, past)
                answered(motion, law, numbers, s, len(past[2]) > 0)
                taken = mul(load(s, RATIO), fma(1.0, load(s, STORED), load(s, LOST)))
                store(s, TOTAL, fma(load(X, TENSOR), taken, load(s, TOTAL)))
                turn(s, STRESS)
                piola(s, load(X, TENSOR))
                collect(s, table[q], sums)
            scatter(s, sums, rows[block], out)
        energy[part] += s[TOTAL : TOTAL + LANES].sum()


@kernel
def settle(motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, after):
    """Write the history variables at the end of the slab to ``after``, which has the same arrays as ``past``."""
    other = PAST + rows.shape[1] * VECTOR
    s = scratch(other + rows.shape[1] * VECTOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        gather(step, rows[block], s, other)
        for q in range(table.shape[0]):
            moved(s, other, table[q], geometry[block, q], u.shape[1])
            foresee(points, block, starts[last] - 1, q, table.shape[0], past)
            recall(s, points[block], q, past)
            answered(motion, law, numbers, s, len(past[2]) > 0)
            turn(s, STRESS)
            if len(past[2]) > 0:
                turn(s, BACK)
            remember(s, points[block], q, geometry[block, q], past, after)


@kernel
def product(motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, w, out):
    """Add the change of the nodal forces [N] due to a change ``w`` (n, d) [m] of the displacement to ``out`` (n, d)."""
    nodes, d = rows.shape[1], u.shape[1]
    other = PAST + nodes * VECTOR
    change = other + nodes * VECTOR
    sums = change + nodes * VECTOR
    s = scratch(sums + nodes * VECTOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        gather(step, rows[block], s, other)
        gather(w, rows[block], s, change)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            X = geometry[block, q]
            _stiff(motion, law, numbers, s, other, table[q], X, d, points[block], q, past)
            differentiate(s, change, table[q], CHANGE)
            uncouple(s, CHANGE, d)
            piola_change(s, load(X, TENSOR))
            collect(s, table[q], sums)
        scatter(s, sums, rows[block], out)


@kernel
def tangent(
    motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, pairs, at, width, out
):
    """Add the derivative of the force [N/m] to the entries ``out`` of a matrix.

    The matrix is stored as in softway.kernels.fused.elastic.tangent.
    """
    nodes, d = rows.shape[1], u.shape[1]
    other = PAST + nodes * VECTOR
    moved = other + nodes * VECTOR
    sums = moved + 9 * TENSOR
    s = scratch(sums + nodes * nodes * TENSOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        gather(step, rows[block], s, other)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            X = geometry[block, q]
            _stiff(motion, law, numbers, s, other, table[q], X, d, points[block], q, past)
            point_moduli(s, X, d, moved)
            for node in range(nodes):
                couple(s, moved, table[q], node, nodes, sums + node * nodes * TENSOR)
        enter(s, sums, pairs[block], at, width, d, out)


@kernel
def diagonal(motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, out):
    """Add the derivative of the force on each node by the displacement of this node [N/m] to ``out`` (n, d, d)."""
    nodes, d = rows.shape[1], u.shape[1]
    other = PAST + nodes * VECTOR
    moved = other + nodes * VECTOR
    sums = moved + 9 * TENSOR
    s = scratch(sums + nodes * TENSOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        gather(step, rows[block], s, other)
        s[sums:] = 0.0
        for q in range(table.shape[0]):
            X = geometry[block, q]
            _stiff(motion, law, numbers, s, other, table[q], X, d, points[block], q, past)
            point_moduli(s, X, d, moved)
            for node in range(nodes):
                couple(s, moved, table[q], node, node + 1, sums)
        enter_diagonal(s, sums, rows[block], d, out)


@inlined
def remember(s, points, q, X, past, after):
    """Write stress, history variables and energies of the points to ``after``."""
    for k in range(LANES):
        p = points[k] + q
        if p < len(past[0]):
            write(s, STRESS + k, after[0], p)
            if len(past[1]) > 0:
                after[1][p] = s[PLASTIC + k]
            if len(past[2]) > 0:
                write(s, BACK + k, after[2], p)
            ratio = s[RATIO + k] * X[TENSOR + k] / X[TENSOR + LANES + k]
            after[3][p] = past[3][p] + ratio * s[STORED + k]
            after[4][p] = past[4][p] + ratio * s[LOST + k]


@inlined
def moved(s, other, slopes, X, d):
    """Compute the derivatives of the positions at the end of the slab, and their change in the slab.

    Without a history ``other`` is None, and there is no change.
    """
    differentiate(s, PAST, slopes, FRAME)
    uncouple(s, FRAME, d)
    for row in range(0, TENSOR, LANES):
        store(s, FRAME + row, load(X, row) + load(s, FRAME + row))
    if other is not None:
        differentiate(s, other, slopes, STEP)
        uncouple(s, STEP, d)


@inlined
def answered(motion, law, numbers, s, kinematic):
    """Evaluate motion and law in the axes of the middle of the slab."""
    call(motion, s, numbers)
    turn(s, STRESS)
    if kinematic:
        turn(s, BACK)
    call(law, s, numbers)


@inlined
def _stiff(motion, law, numbers, s, other, slopes, X, d, points, q, past):
    """Prepare the data of the moduli in the axes at the end of the slab."""
    moved(s, other, slopes, X, d)
    recall(s, points, q, past)
    answered(motion, law, numbers, s, len(past[2]) > 0)
    turn(s, STRESS)
    turn(s, BRIDGE)
    store(s, SHRINK, 1.0 / load(s, VOLUME))


@inlined
def point_moduli(s, X, d, to):
    """Derivative of the NATURAL flux by the NATURAL derivatives, as in softway.kernels.fused.elastic."""
    for t in range(3):
        for j in range(3):
            unit(s, t, j, CHANGE)
            uncouple(s, CHANGE, d)
            piola_change(s, load(X, TENSOR))
            keep(s, t, j, to)
