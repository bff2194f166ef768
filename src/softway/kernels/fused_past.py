"""Internal force of laws with a history in one pass over the cells, its tangent and products, and the memory after.

Arguments are those of :mod:`softway.kernels.fused`, and

``motion``, ``law``, ``numbers``
    Addresses of the stages of one point (motion of the slab, then stress, memory and energies), and the numbers of the
    law.
``geometry`` (b, q, 11 LANES)
    Derivatives ``dX_I/dxi_r`` of the places in row 3 r + I [m], the volume of the point over their determinant, and
    the volume [m^3]; a unit cube where no cell is.
``points`` (b, LANES)
    First point of the cell in each lane; the number of points where no cell is.
``u``, ``step`` (n, d)
    Displacement at the end of the slab, and its change in the slab [m].
``past``
    Arrays of the points, see :mod:`softway.kernels.past`.
"""

from softway.kernels.compiled import inlined, kernel
from softway.kernels.lanes import (
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
from softway.kernels.past import foresee, piola, piola_change, recall, turn, write
from softway.kernels.stages import (
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
from softway.kernels.vectors import call, fma, load, mul, spread, store


@kernel
def force(motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, out, energy):
    """Add nodal forces [N] to ``out`` (n, d), and what each part stores and dissipates [J] to ``energy``."""
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
    """Put the memory of the points at the end of the slab to ``after``, arrays as those of ``past``."""
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
    """Add the change of the nodal forces [N] under a change ``w`` (n, d) [m] of the displacement to ``out`` (n, d)."""
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
    """Add the derivative of the force [N/m] to the entries ``out`` of a matrix, as softway.kernels.fused.tangent."""
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
            _moduli(s, X, d, moved)
            for node in range(nodes):
                couple(s, moved, table[q], node, nodes, sums + node * nodes * TENSOR)
        enter(s, sums, pairs[block], at, width, d, out)


@kernel
def diagonal(motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, out):
    """Add the derivative of the force on each node to its own displacement [N/m] to ``out`` (n, d, d)."""
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
            _moduli(s, X, d, moved)
            for node in range(nodes):
                couple(s, moved, table[q], node, node + 1, sums)
        enter_diagonal(s, sums, rows[block], d, out)


@inlined
def remember(s, points, q, X, past, after):
    """What the points remember from now on."""
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
    """Derivatives of the places at the end, and their change in the slab."""
    differentiate(s, PAST, slopes, FRAME)
    uncouple(s, FRAME, d)
    for row in range(0, TENSOR, LANES):
        store(s, FRAME + row, load(X, row) + load(s, FRAME + row))
    differentiate(s, other, slopes, STEP)
    uncouple(s, STEP, d)


@inlined
def answered(motion, law, numbers, s, kinematic):
    """Motion and law, in the axes of the middle."""
    call(motion, s, numbers)
    turn(s, STRESS)
    if kinematic:
        turn(s, BACK)
    call(law, s, numbers)


@inlined
def _stiff(motion, law, numbers, s, other, slopes, X, d, points, q, past):
    """What the moduli need, in the axes of the end."""
    moved(s, other, slopes, X, d)
    recall(s, points, q, past)
    answered(motion, law, numbers, s, len(past[2]) > 0)
    turn(s, STRESS)
    turn(s, BRIDGE)
    store(s, SHRINK, 1.0 / load(s, VOLUME))


@inlined
def _moduli(s, X, d, to):
    """Change of the NATURAL flux with the NATURAL derivatives, as in softway.kernels.fused."""
    for t in range(3):
        for j in range(3):
            unit(s, t, j, CHANGE)
            uncouple(s, CHANGE, d)
            piola_change(s, load(X, TENSOR))
            keep(s, t, j, to)
