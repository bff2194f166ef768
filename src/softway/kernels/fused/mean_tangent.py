"""Tangent of the force in cells with mean dilatation, its products and its diagonal blocks.

At a point with the derivatives f_ri of the positions along the reference coordinates, ``F_bar = r F`` has the first and
the second derivatives

    r (c - f (a:c)/m + f t/m),     a = f^-T,     t = change of ln theta

for a change c of f.  With the moduli D of the law at F_bar and its flux P_bar on the derivatives, both times the volume
V of the point, ``w = D:f``, ``p = r P_bar/m``, ``o = p:f``, and the sum ``k`` of ``o/theta`` over the cell, divided by
its volume, the second derivative of the energy is

    N + (b t^T + t b^T) + e t t^T,
    N_ritj = r^2 D_ritj + a_ri y_tj + y_ri a_tj + (g + r^2 (f:w)/m^2 + o/m) a_ri a_tj - (g - o) a_rj a_ti,
    y = -r^2 w/m - p,     g = k V J,     b = r^2/m (w - a (f:w)/m) + p - a o/m,     e = r^2 (f:w)/m^2 + o (1/m - 1),

see docs/theory/bodies/incompressible.md and softway.bodies.elements.mean_dilatation.  Arguments are those of
:mod:`softway.kernels.fused.inelastic`, and the number ``m`` of dimensions that theta scales.  For a stored energy
``step`` and ``past`` are None, ``geometry`` is that of :mod:`softway.kernels.fused.mean_elastic`, and ``motion`` the
stage of the strain.  The linear theory has the tangent of displacements that are zero.
"""

from softway.kernels.fused import mean_elastic
from softway.kernels.fused.history_stages import piola, recall, turn
from softway.kernels.fused.inelastic import answered, point_moduli
from softway.kernels.fused.mean_dilatation import means, scaled
from softway.kernels.fused.mean_elastic import cofactors, flat
from softway.kernels.fused.stages import (
    collect,
    couple,
    differentiate,
    enter,
    enter_diagonal,
    gather,
    scatter,
    scratch,
    uncouple,
)
from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.jit.lanes import (
    BRIDGE,
    CHANGE,
    LANES,
    NATURAL,
    PAST,
    SHRINK,
    STIFF,
    STRESS,
    TENSOR,
    VECTOR,
    VOLUME,
)
from softway.kernels.jit.simd import fma, load, mul, spread, store

_SLOPE, _VOLUME, _ROOT = TENSOR, 2 * TENSOR, 2 * TENSOR + LANES  # a, V J and r of a point, after its f
_PULL, _ANSWER = 2 * TENSOR + 2 * LANES, 2 * TENSOR + 3 * LANES  # o of a point, and the answer of the law
_ROWS = STIFF + LANES  # the answer of the law: first rows of a point, then SHRINK and BULK
_KEPT = _ANSWER + _ROWS + 2 * LANES
_MIXED, _NINE = 9 * TENSOR, TENSOR  # b of a point follows its moduli N; y and w follow


@kernel
def tangent(
    m, motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, pairs, at, width, out
):
    """Add the derivative of the force [N/m] to the entries ``out`` of a matrix.

    The matrix is stored as in softway.kernels.fused.elastic.tangent.
    """
    nodes, d = rows.shape[1], u.shape[1]
    sums = _layout(nodes)[-1] + table.shape[0] * _KEPT
    s = scratch(sums + nodes * nodes * TENSOR)
    for block in range(starts[first], starts[last]):
        _summed(m, motion, law, numbers, s, nodes, rows[block], points[block], table, geometry[block], u, step, past)
        enter(s, sums, pairs[block], at, width, d, out)


@kernel
def diagonal(m, motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, out):
    """Add the derivative of the force on each node by the displacement of this node [N/m] to ``out`` (n, d, d)."""
    nodes, d = rows.shape[1], u.shape[1]
    sums = _layout(nodes)[-1] + table.shape[0] * _KEPT
    s = scratch(sums + nodes * TENSOR)
    for block in range(starts[first], starts[last]):
        _summed(m, motion, law, numbers, s, 0, rows[block], points[block], table, geometry[block], u, step, past)
        enter_diagonal(s, sums, rows[block], d, out)


@kernel
def product(m, motion, law, numbers, rows, points, table, geometry, starts, first, last, u, step, past, w, out):
    """Add the change of the nodal forces [N] due to a change ``w`` (n, d) [m] of the displacement to ``out`` (n, d)."""
    nodes, d = rows.shape[1], u.shape[1]
    other, mixed, slope, moved, kept = _layout(nodes)
    change = kept + table.shape[0] * _KEPT
    s = scratch(change + nodes * VECTOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        if past is not None:
            gather(step, rows[block], s, other)
        gather(w, rows[block], s, change)
        cell = other, kept, table, geometry[block], points[block], past, d
        theta, quotient = _answers(m, motion, law, numbers, s, *cell)
        s[mixed:moved] = 0.0
        grown, along, twice = spread(0.0), spread(0.0), spread(0.0)
        for q in range(table.shape[0]):
            _changed(s, change, table[q], d)
            at = kept + q * _KEPT
            grown = grown + load(s, at + _VOLUME) * _nine(s, CHANGE, at + _SLOPE)
        grown = grown / theta
        for q in range(table.shape[0]):
            twice = twice + _varied(m, s, kept + q * _KEPT, geometry[block, q], past, d, moved, quotient)
            _changed(s, change, table[q], d)
            along = along + _nine(s, CHANGE, moved + _MIXED)
            _grown(s, kept + q * _KEPT, theta, table[q], slope)
            _times(s, moved, grown)
            collect(s, table[q], mixed)
        along = along + twice * grown
        for row in range(0, nodes * VECTOR, LANES):
            store(s, mixed + row, fma(along, load(s, slope + row), load(s, mixed + row)))
        scatter(s, mixed, rows[block], out)


@inlined
def _summed(m, motion, law, numbers, s, stride, rows, points, table, geometry, u, step, past):
    """Sum the entries of all pairs of ``stride`` nodes, or with ``stride`` 0 those of each node with itself."""
    nodes, d = rows.shape[0], u.shape[1]
    other, mixed, slope, moved, kept = _layout(nodes)
    sums = kept + table.shape[0] * _KEPT
    gather(u, rows, s, PAST)
    if past is not None:
        gather(step, rows, s, other)
    theta, quotient = _answers(m, motion, law, numbers, s, other, kept, table, geometry, points, past, d)
    s[mixed:moved] = 0.0
    s[sums:] = 0.0
    twice = spread(0.0)
    for q in range(table.shape[0]):
        twice = twice + _varied(m, s, kept + q * _KEPT, geometry[q], past, d, moved, quotient)
        _collected(s, spread(1.0), moved + _MIXED, table[q], mixed)
        _grown(s, kept + q * _KEPT, theta, table[q], slope)
        for node in range(nodes):
            couple(s, moved, table[q], node, max(stride, node + 1), sums + node * stride * TENSOR)
    for node in range(nodes):
        for two in range(node, max(stride, node + 1)):
            _outer(s, mixed, slope, twice, node, two, sums + (node * stride + two) * TENSOR)


@inlined
def _layout(nodes):
    """First numbers of: step of the nodes, their b and derivative of ln theta, N of a point, and data of all points."""
    other = PAST + nodes * VECTOR
    mixed = other + nodes * VECTOR
    slope = mixed + nodes * VECTOR
    moved = slope + nodes * VECTOR
    return other, mixed, slope, moved, moved + _MIXED + 3 * _NINE


@inlined
def _answers(m, motion, law, numbers, s, other, kept, table, geometry, points, past, d):
    """Keep f, a, V J, r, o and the answer of the law of all points; return ``V theta`` of the cells and the mean k."""
    if past is None:
        _, after, size = means(s, None, kept, _KEPT, table, geometry, d)
    else:
        before, after, size = means(s, other, kept, _KEPT, table, geometry, d)
    quotient = spread(0.0)
    for q in range(table.shape[0]):
        X, at = geometry[q], kept + q * _KEPT
        if past is None:
            x, r = scaled(s, at, X, None, after, m)
            mean_elastic.respond(s, X, motion, law, numbers, d)
            mean_elastic.stress(s, X)
        else:
            x, r = scaled(s, at, X, before, after, m)
            recall(s, points, q, past)
            answered(motion, law, numbers, s, len(past[2]) > 0)
            turn(s, STRESS)
            turn(s, BRIDGE)
            store(s, SHRINK, 1.0 / load(s, VOLUME))
            piola(s, load(X, TENSOR))
        own = r * flat(s, NATURAL, at, m) / (1.0 * m)
        quotient = quotient + own
        cofactors(s, at, 1.0 / load(s, at + _VOLUME), at + _SLOPE)
        store(s, at + _VOLUME, x * after * load(X, TENSOR + LANES))
        store(s, at + _ROOT, r)
        store(s, at + _PULL, own)
        for row in range(0, _ROWS, LANES):
            store(s, at + _ANSWER + row, load(s, row))
        if past is not None:
            for row in range(0, 2 * LANES, LANES):
                store(s, at + _ANSWER + _ROWS + row, load(s, SHRINK + row))
    return size * after, quotient / (size * after)


@inlined
def _varied(m, s, at, X, past, d, to, quotient):
    """Write N and b of a point to ``s[to:]``; return e."""
    for row in range(0, _ROWS, LANES):
        store(s, row, load(s, at + _ANSWER + row))
    if past is None:
        mean_elastic.stiffness(s, X, d, to)
        mean_elastic.stress(s, X)
    else:
        for row in range(0, 2 * LANES, LANES):
            store(s, SHRINK + row, load(s, at + _ANSWER + _ROWS + row))
        point_moduli(s, X, d, to)
        piola(s, load(X, TENSOR))
    share = 1.0 / m
    root, own, grown = load(s, at + _ROOT), load(s, at + _PULL), quotient * load(s, at + _VOLUME)
    square, pull = root * root, share * root
    y, w = to + _MIXED + _NINE, to + _MIXED + 2 * _NINE
    _stretched(s, to, at, m, w)
    along = share * share * (square * flat(s, w, at, m))
    for row in range(0, TENSOR, LANES):
        a, p, stiff = load(s, at + _SLOPE + row), pull * load(s, NATURAL + row), share * (square * load(s, w + row))
        store(s, y + row, -1.0 * (stiff + p))
        store(s, to + _MIXED + row, (stiff - along * a) + (p - share * (own * a)))
    both = grown + along + share * own
    for entry in range(81):
        r, t, i, j = entry // 27, entry // 9 % 3, entry // 3 % 3, entry % 3
        if d == 3 or ((r == 2) == (i == 2) and (t == 2) == (j == 2)):
            _complete(s, to + entry * LANES, at, y, (r, t, i, j), square, both, grown - own)
    return along + (share - 1.0) * own


@inlined
def _complete(s, here, at, y, entry, square, both, turned):
    """Complete ``N_ritj`` at ``here``."""
    r, t, i, j = entry
    one, two = (3 * r + i) * LANES, (3 * t + j) * LANES
    a, b = load(s, at + _SLOPE + one), load(s, at + _SLOPE + two)
    cross = load(s, at + _SLOPE + (3 * r + j) * LANES) * load(s, at + _SLOPE + (3 * t + i) * LANES)
    sides = a * load(s, y + two) + load(s, y + one) * b
    store(s, here, square * load(s, here) + sides + both * (a * b) - turned * cross)


@inlined
def _stretched(s, to, at, m, w):
    """Write ``w = D:f`` of the dimensions that theta scales."""
    for r in range(3):
        for i in range(3):
            total = spread(0.0)
            for t in range(3):
                for j in range(3):
                    if m == 3 or (t < 2 and j < 2):
                        place = to + (27 * r + 9 * t + 3 * i + j) * LANES
                        total = fma(load(s, place), load(s, at + (3 * t + j) * LANES), total)
            store(s, w + (3 * r + i) * LANES, total)


@inlined
def _nine(s, one, two):
    total = spread(0.0)
    for row in range(0, TENSOR, LANES):
        total = fma(load(s, one + row), load(s, two + row), total)
    return total


@inlined
def _grown(s, at, theta, slopes, to):
    """Add the derivative of ln theta to the vectors of the nodes; ``theta`` is that of the cell times its volume."""
    _collected(s, load(s, at + _VOLUME) / theta, at + _SLOPE, slopes, to)


@inlined
def _collected(s, factor, nine, slopes, to):
    for row in range(0, TENSOR, LANES):
        store(s, NATURAL + row, mul(factor, load(s, nine + row)))
    collect(s, slopes, to)


@inlined
def _outer(s, mixed, slope, twice, one, two, to):
    """Add ``b t^T + t b^T + e t t^T`` of two nodes to the entries of the pair."""
    for i in range(3):
        b, t = load(s, mixed + one * VECTOR + i * LANES), load(s, slope + one * VECTOR + i * LANES)
        both = fma(twice, t, b)
        for j in range(3):
            here = to + (3 * i + j) * LANES
            rest = fma(t, load(s, mixed + two * VECTOR + j * LANES), load(s, here))
            store(s, here, fma(both, load(s, slope + two * VECTOR + j * LANES), rest))


@inlined
def _changed(s, change, slopes, d):
    differentiate(s, change, slopes, CHANGE)
    uncouple(s, CHANGE, d)


@inlined
def _times(s, moved, grown):
    """Write ``N:c + b t`` to NATURAL, with t = ``grown``."""
    for r in range(3):
        for i in range(3):
            total = mul(grown, load(s, moved + _MIXED + (3 * r + i) * LANES))
            for t in range(3):
                for j in range(3):
                    place = moved + (27 * r + 9 * t + 3 * i + j) * LANES
                    total = fma(load(s, place), load(s, CHANGE + (3 * t + j) * LANES), total)
            store(s, NATURAL + (3 * r + i) * LANES, total)
