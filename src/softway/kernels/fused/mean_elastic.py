"""Internal force of stored energies in cells with mean dilatation.

At each point the law is evaluated at ``F_bar = r F`` with ``r = (theta/J)^(1/m)`` and the mean theta of J over the
cell.  With its flux P on the derivatives, times the volume V of the point, and ``o = r P:f/m``, the flux is

    r P - o a + (k V J) a,        a = f^-T,        k = sum of o/theta over the cell, divided by its volume.

In the linear theory the mean of the trace of the strain takes the place of the trace
(softway.bodies.elements.mean_dilatation).  The kernels have the arguments of :mod:`softway.kernels.fused.elastic`, the
number ``m`` of dimensions that theta scales, and

``geometry`` (b, q, 21 LANES)
    Rows of :mod:`softway.kernels.fused.inelastic`, then those of :mod:`softway.kernels.fused.elastic`.
"""

from softway.kernels.fused.mean_dilatation import means, scaled
from softway.kernels.fused.stages import (
    collect,
    differentiate,
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
from softway.kernels.jit.lanes import CHANGE, ENERGY, FLUX, FRAME, LANES, NATURAL, PAST, TENSOR, TOTAL, VECTOR
from softway.kernels.jit.simd import call, fma, load, spread, store

_KEPT = 2 * TENSOR + LANES  # stored numbers of a point: two tensors and a determinant
_INVERSE = 11 * LANES  # first row of the inverse of the map from the reference element


@kernel
def force(m, measure, law, moduli, rows, table, geometry, starts, first, last, u, out, energy):
    """Add nodal forces [N] to ``out`` (n, d), and the energy of each cell [J] to ``energy`` (b, LANES)."""
    sums = PAST + rows.shape[1] * VECTOR
    kept = sums + rows.shape[1] * VECTOR
    s = scratch(kept + table.shape[0] * _KEPT)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        _, theta, size = means(s, None, kept, _KEPT, table, geometry[block], u.shape[1])
        s[sums:kept] = 0.0
        store(s, TOTAL, spread(0.0))
        quotient = spread(0.0)
        for q in range(table.shape[0]):
            X, at = geometry[block, q], kept + q * _KEPT
            _, r = scaled(s, at, X, None, theta, m)
            respond(s, X, measure, law, moduli, u.shape[1])
            _count(s, X)
            stress(s, X)
            quotient = quotient + _split(s, at, load(X, TENSOR), r, m)
        pressure = quotient / (size * theta)
        for q in range(table.shape[0]):
            at = kept + q * _KEPT
            for row in range(0, TENSOR, LANES):
                store(s, NATURAL + row, load(s, at + row) + pressure * load(s, at + TENSOR + row))
            collect(s, table[q], sums)
        _add(s, sums, rows[block], out, energy[block])


@kernel
def small_force(m, measure, law, moduli, rows, table, geometry, starts, first, last, u, out, energy):
    """:func:`force` of the linear theory."""
    sums = PAST + rows.shape[1] * VECTOR
    kept = sums + rows.shape[1] * VECTOR
    s = scratch(kept + table.shape[0] * TENSOR)
    for block in range(starts[first], starts[last]):
        gather(u, rows[block], s, PAST)
        s[sums:kept] = 0.0
        store(s, TOTAL, spread(0.0))
        grown, pressure, size = spread(0.0), spread(0.0), spread(0.0)
        for q in range(table.shape[0]):
            X = geometry[block, q]
            grown = grown + load(X, TENSOR + LANES) * _spatial(s, X, table[q], u.shape[1], m)
            size = size + load(X, TENSOR + LANES)
        for q in range(table.shape[0]):
            X = geometry[block, q]
            own = _spatial(s, X, table[q], u.shape[1], m)
            _spherical(s, FRAME, grown / size - own, m)
            _evaluate(s, measure, law, moduli)
            _count(s, X)
            flux(s)
            own = _trace(s, FLUX, m)
            pressure = pressure + load(X, TENSOR + LANES) * own
            _spherical(s, FLUX, -1.0 * own, m)
            for row in range(0, TENSOR, LANES):
                store(s, kept + q * TENSOR + row, load(s, FLUX + row))
        for q in range(table.shape[0]):
            for row in range(0, TENSOR, LANES):
                store(s, FLUX + row, load(s, kept + q * TENSOR + row))
            _spherical(s, FLUX, pressure / size, m)
            pull(s, geometry[block, q][_INVERSE:])
            collect(s, table[q], sums)
        _add(s, sums, rows[block], out, energy[block])


@inlined
def respond(s, X, measure, law, moduli, d):
    """Evaluate the stages of a point with the derivatives of the positions in FRAME."""
    for row in range(0, TENSOR, LANES):
        store(s, NATURAL + row, load(s, FRAME + row) - load(X, row))
    place(s, X[_INVERSE:], FRAME, d)
    _evaluate(s, measure, law, moduli)


@inlined
def _evaluate(s, measure, law, moduli):
    """Evaluate the stages of a point with the derivatives in FRAME."""
    call(measure, s, moduli)
    call(law, s, moduli)


@inlined
def _count(s, X):
    """Add the energy of a point to that of its cell."""
    store(s, TOTAL, fma(load(X, TENSOR + LANES), load(s, ENERGY), load(s, TOTAL)))


@inlined
def _add(s, sums, rows, out, energy):
    """Add the nodal forces of a block to ``out``, and its energies (LANES,)."""
    scatter(s, sums, rows, out)
    for lane in range(LANES):
        energy[lane] += s[TOTAL + lane]


@inlined
def stress(s, X):
    """Write the flux on the derivatives along the reference coordinates, times the volume, to NATURAL."""
    flux(s)
    pull(s, X[_INVERSE:])


@inlined
def stiffness(s, X, d, to):
    """Derivative of :func:`stress` by the derivatives, as in softway.kernels.fused.elastic."""
    for t in range(3):
        for j in range(3):
            unit(s, t, j, NATURAL)
            place(s, X[_INVERSE:], CHANGE, d)
            flux_change(s)
            pull(s, X[_INVERSE:])
            keep(s, t, j, to)


@inlined
def cofactors(s, f, by, to):
    """Write ``by`` times the cofactors of the derivatives ``s[f:]`` to ``s[to:]``."""
    for J in range(3):
        for i in range(3):
            one, two = f + (J + 1) % 3 * VECTOR, f + (J + 2) % 3 * VECTOR
            x, y = (i + 1) % 3 * LANES, (i + 2) % 3 * LANES
            minor = load(s, one + x) * load(s, two + y) - load(s, one + y) * load(s, two + x)
            store(s, to + J * VECTOR + i * LANES, by * minor)


@inlined
def flat(s, one, f, m):
    """Product of a flux with f in the dimensions that theta scales."""
    total = spread(0.0)
    for row in range(9):
        if m == 3 or row in (0, 1, 3, 4):
            total = fma(load(s, one + row * LANES), load(s, f + row * LANES), total)
    return total


@inlined
def _split(s, at, weight, r, m):
    """Store ``r P - o a`` and ``V J a`` of a point; return o."""
    own = r * flat(s, NATURAL, at, m) / (1.0 * m)
    cofactors(s, at, weight, at + TENSOR)  # V J a
    pull = own / (weight * load(s, at + 2 * TENSOR))
    for row in range(0, TENSOR, LANES):
        store(s, at + row, r * load(s, NATURAL + row) - pull * load(s, at + TENSOR + row))
    return own


@inlined
def _spatial(s, X, slopes, d, m):
    """Write the displacement derivatives of a point to FRAME; return their trace divided by m."""
    differentiate(s, PAST, slopes, NATURAL)
    place(s, X[_INVERSE:], FRAME, d)
    return _trace(s, FRAME, m)


@inlined
def _trace(s, at, m):
    if m == 3:
        return (1.0 / 3.0) * (load(s, at) + load(s, at + 4 * LANES) + load(s, at + 8 * LANES))
    return 0.5 * (load(s, at) + load(s, at + 4 * LANES))


@inlined
def _spherical(s, at, value, m):
    for row in range(0, 4 * m, 4):
        store(s, at + row * LANES, load(s, at + row * LANES) + value)
