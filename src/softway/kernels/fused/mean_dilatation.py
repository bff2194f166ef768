"""Kernels of :mod:`softway.kernels.fused.inelastic` for cells with mean dilatation.

The volume ratio in a cell is replaced by its mean,

    F_bar = (theta/J)^(1/m) F,        theta = mean of J over the cell

at the start and at the end of the slab.  The law is evaluated with F_bar (softway.bodies.elements.mean_dilatation).
With the Cauchy stress s of the law, its mean normal stress p in m dimensions and the mean of p over the cell, the flux
on the derivatives is

    ((theta/J) (s - p I) + mean(p) I) J F^-T.

The kernels have the same arguments, and in addition the number ``m`` of dimensions that theta scales.
"""

from softway.kernels.fused.history_stages import foresee, recall, turn
from softway.kernels.fused.inelastic import answered, moved, remember
from softway.kernels.fused.stages import collect, gather, scatter, scratch, six
from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.jit.elementary import inverse_cube_root
from softway.kernels.jit.lanes import (
    BACK,
    FRAME,
    LANES,
    LOST,
    NATURAL,
    PAST,
    RATIO,
    STEP,
    STORED,
    STRESS,
    TENSOR,
    TOTAL,
    VECTOR,
)
from softway.kernels.jit.simd import load, root, spread, store

_KEPT = 20 * LANES  # stored numbers of a point: two tensors and two determinants


@kernel
def force(m, motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, out, energy):
    """Add nodal forces [N] to ``out`` (n, d), and the energy that each part stores and dissipates [J] to ``energy``."""
    other = PAST + rows.shape[1] * VECTOR
    sums = other + rows.shape[1] * VECTOR
    kept = sums + rows.shape[1] * VECTOR
    s = scratch(kept + table.shape[0] * _KEPT)
    for part in range(first, last):
        store(s, TOTAL, spread(0.0))
        for block in range(starts[part], starts[part + 1]):
            gather(u, rows[block], s, PAST)
            gather(step, rows[block], s, other)
            before, after, size = means(s, other, kept, _KEPT, table, geometry[block], u.shape[1])
            s[sums:kept] = 0.0
            pressure = spread(0.0)
            for q in range(table.shape[0]):
                X, at = geometry[block, q], kept + q * _KEPT
                foresee(points, block, starts[part + 1] - 1, q, table.shape[0], past)
                x, r = scaled(s, at, X, before, after, m)
                recall(s, points[block], q, past)
                answered(motion, law, numbers, s, len(past[2]) > 0)
                taken = load(X, TENSOR) * load(s, RATIO) * (load(s, STORED) + load(s, LOST))
                store(s, TOTAL, load(s, TOTAL) + taken)
                turn(s, STRESS)
                pressure = pressure + load(X, TENSOR + LANES) * _split(s, at, load(X, TENSOR) * r, x, m)
            pressure = pressure / size
            for q in range(table.shape[0]):
                at = kept + q * _KEPT
                for row in range(0, TENSOR, LANES):
                    store(s, NATURAL + row, load(s, at + row) + pressure * load(s, at + TENSOR + row))
                collect(s, table[q], sums)
            scatter(s, sums, rows[block], out)
        energy[part] += s[TOTAL : TOTAL + LANES].sum()


@kernel
def settle(m, motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, after):
    """Write the history variables at the end of the slab to ``after``, which has the same arrays as ``past``."""
    other = PAST + rows.shape[1] * VECTOR
    kept = other + rows.shape[1] * VECTOR
    s = scratch(kept + table.shape[0] * _KEPT)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        gather(step, rows[block], s, other)
        start, end, _ = means(s, other, kept, _KEPT, table, geometry[block], u.shape[1])
        for q in range(table.shape[0]):
            foresee(points, block, starts[last] - 1, q, table.shape[0], past)
            scaled(s, kept + q * _KEPT, geometry[block, q], start, end, m)
            recall(s, points[block], q, past)
            answered(motion, law, numbers, s, len(past[2]) > 0)
            turn(s, STRESS)
            if len(past[2]) > 0:
                turn(s, BACK)
            remember(s, points[block], q, geometry[block, q], past, after)


@inlined
def means(s, other, kept, width, table, geometry, d):
    """theta at the start and at the end, and the volume of the cells; store the derivatives at all points.

    The data of a point take ``width`` numbers.  Without a history ``other`` is None, and there is nothing at the start.
    """
    before, after, size = spread(0.0), spread(0.0), spread(0.0)
    for q in range(table.shape[0]):
        X, at = geometry[q], kept + q * width
        moved(s, other, table[q], X, d)
        after, size = after + load(X, TENSOR) * _stored(s, at, other), size + load(X, TENSOR + LANES)
        if other is not None:
            before = before + load(X, TENSOR) * load(s, at + 2 * TENSOR + LANES)
    return before / size, after / size, size


@inlined
def _stored(s, at, other):
    """Store the derivatives at the end and at the start, and their determinants; return that of the end."""
    for row in range(0, TENSOR, LANES):
        f = load(s, FRAME + row)
        store(s, at + row, f)
        if other is not None:
            store(s, at + TENSOR + row, f - load(s, STEP + row))
    end = determinant(s, at)
    store(s, at + 2 * TENSOR, end)
    if other is not None:
        store(s, at + 2 * TENSOR + LANES, determinant(s, at + TENSOR))
    return end


@inlined
def scaled(s, at, X, before, after, m):
    """Store the derivatives of F_bar at the end and their change; return ``J/theta`` and ``(theta/J)^(1/m)``."""
    ratio = load(X, TENSOR) / load(X, TENSOR + LANES)
    x1 = ratio * load(s, at + 2 * TENSOR) / after
    r1 = inverse_root(x1, m)
    for row in range(9):
        end = load(s, at + row * LANES)
        store(s, FRAME + row * LANES, r1 * end if m == 3 or row in (0, 1, 3, 4) else end)
    if before is not None:
        r0 = inverse_root(ratio * load(s, at + 2 * TENSOR + LANES) / before, m)
        for row in range(9):
            start = load(s, at + TENSOR + row * LANES)
            start = r0 * start if m == 3 or row in (0, 1, 3, 4) else start
            store(s, STEP + row * LANES, load(s, FRAME + row * LANES) - start)
    return x1, r1


@inlined
def inverse_root(x, m):
    """``x^(-1/m)``."""
    return inverse_cube_root(x) if m == 3 else 1.0 / root(x)


@inlined
def _split(s, at, weight, x, m):
    """Store the flux of the deviator and the factor of the mean pressure; return the pressure of the point."""
    xx, yy, zz, xy, yz, zx = six(s, STRESS)
    p = (1.0 / 3.0) * (xx + yy + zz) if m == 3 else 0.5 * (xx + yy)
    xx, yy, zz = xx - p, yy - p, zz - p
    for J in range(0, TENSOR, VECTOR):
        a, b, c = load(s, FRAME + J), load(s, FRAME + J + LANES), load(s, FRAME + J + 2 * LANES)
        a, b, c = weight * a, weight * b, weight * c
        store(s, at + J, xx * a + xy * b + zx * c)
        store(s, at + J + LANES, xy * a + yy * b + yz * c)
        store(s, at + J + 2 * LANES, zx * a + yz * b + zz * c)
        store(s, at + TENSOR + J, x * a)
        store(s, at + TENSOR + J + LANES, x * b)
        store(s, at + TENSOR + J + 2 * LANES, x * c)
    return p


@inlined
def determinant(s, at):
    """Determinant of the derivatives ``s[at:]``."""
    a, b, c = load(s, at), load(s, at + LANES), load(s, at + 2 * LANES)
    d, e, f = load(s, at + 3 * LANES), load(s, at + 4 * LANES), load(s, at + 5 * LANES)
    g, h, i = load(s, at + 6 * LANES), load(s, at + 7 * LANES), load(s, at + 8 * LANES)
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
