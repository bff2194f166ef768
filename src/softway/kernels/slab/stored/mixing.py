"""Anderson mixing of the iterates of a slab (time step), as in :mod:`softway.solve.methods.anderson`."""

import numpy as np

from softway.kernels.jit.compilation import called, merged
from softway.tolerances import INDEPENDENT

KEPT, PREVIOUS = range(2)
"""Entries of ``Search.kept``: number of differences so far, and 1 if there is a value before."""
SWEEPS = 30
"""Greatest number of sweeps of Jacobi's method; it takes six or seven."""


@called
def mix(search, residual, q, impulse):
    """Replace q (N,) and the impulses (m,) by the combination of the last values with the least residual (N,)."""
    depth, size, last = len(search.gram), len(q), search.last
    if depth == 0:
        return
    if search.kept[PREVIOUS]:
        _keep(search, residual, q, impulse)
    for c in range(size):
        last[c], last[size + c] = residual[c], q[c]
    for r in range(len(impulse)):
        last[2 * size + r] = impulse[r]
    search.kept[PREVIOUS] = 1
    kept = min(search.kept[KEPT], depth)
    if kept == 0:
        return
    weights = search.small[2, 1]
    _weigh(search, residual, kept, weights)
    for k in range(kept):
        value, weight = search.values[k], weights[k]
        for c in range(size):
            q[c] -= weight * value[c]
        for r in range(len(impulse)):
            impulse[r] -= weight * value[size + r]


@merged
def _keep(search, residual, q, impulse):
    """Replace the oldest differences."""
    size, k = len(q), search.kept[KEPT] % len(search.gram)
    residuals, values, last = search.residuals[k], search.values[k], search.last
    for c in range(size):
        residuals[c] = residual[c] - last[c]
        values[c] = q[c] - last[size + c]
    for r in range(len(impulse)):
        values[size + r] = impulse[r] - last[2 * size + r]
    search.kept[KEPT] += 1


@called
def _weigh(search, residual, kept, weights):
    """Weights (kept,) of the differences that minimise the residual, after the last one was kept."""
    gram, (unit, turned, more) = search.gram, (search.small[0], search.small[1], search.small[2])
    k = (search.kept[KEPT] - 1) % len(gram)
    length, pull = more[0], more[2]
    for i in range(kept):
        gram[k, i] = gram[i, k] = _dot(search.residuals[i], search.residuals[k])
    for i in range(kept):
        length[i] = np.sqrt(max(gram[i, i], 1e-300))
        pull[i] = _dot(search.residuals[i], residual) / length[i]
        weights[i] = 0.0
    for i in range(kept):
        for j in range(kept):
            unit[i, j] = gram[i, j] / (length[i] * length[j])
    diagonalise(unit, turned, kept)
    for e in range(kept):
        if unit[e, e] > INDEPENDENT * kept:
            along = 0.0
            for i in range(kept):
                along += turned[i, e] * pull[i]
            for i in range(kept):
                weights[i] += turned[i, e] * (along / unit[e, e])
    for i in range(kept):
        weights[i] /= length[i]


@called
def _dot(a, b):
    """Inner product (N,), in sums of eight terms side by side."""
    s0 = s1 = s2 = s3 = s4 = s5 = s6 = s7 = 0.0
    whole = len(a) // 8
    for k in range(whole):
        one, two = a[8 * k : 8 * k + 8], b[8 * k : 8 * k + 8]
        s0 += one[0] * two[0]
        s1 += one[1] * two[1]
        s2 += one[2] * two[2]
        s3 += one[3] * two[3]
        s4 += one[4] * two[4]
        s5 += one[5] * two[5]
        s6 += one[6] * two[6]
        s7 += one[7] * two[7]
    total = ((s0 + s4) + (s1 + s5)) + ((s2 + s6) + (s3 + s7))
    for c in range(8 * whole, len(a)):
        total += a[c] * b[c]
    return total


@called
def diagonalise(A, V, n):
    """Jacobi's method: A (n, n) becomes diagonal, with its eigenvalues, and V (n, n) has its eigenvectors as columns.

    References
    ----------
    Golub, Van Loan (2013), Matrix computations, 8.5.
    """
    for i in range(n):
        for j in range(n):
            V[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        off = 0.0
        for i in range(n):
            for j in range(i):
                off += A[i, j] * A[i, j]
        if off <= 1e-40:
            return
        for p in range(n):
            for q in range(p + 1, n):
                if A[p, q] != 0.0:
                    _rotate(A, V, n, p, q)


@merged
def _rotate(A, V, n, p, q):
    """Make the entry (p, q) of A zero by a rotation."""
    tau = (A[q, q] - A[p, p]) / (2.0 * A[p, q])
    t = (1.0 if tau >= 0.0 else -1.0) / (abs(tau) + np.sqrt(1.0 + tau * tau))
    c = 1.0 / np.sqrt(1.0 + t * t)
    s = t * c
    for k in range(n):
        one, two = A[k, p], A[k, q]
        A[k, p] = c * one - s * two
        A[k, q] = s * one + c * two
        one, two = V[k, p], V[k, q]
        V[k, p] = c * one - s * two
        V[k, q] = s * one + c * two
    for k in range(n):
        one, two = A[p, k], A[q, k]
        A[p, k] = c * one - s * two
        A[q, k] = s * one + c * two
