"""Dense systems of the rows of contacts, some of which may depend on others."""

import numpy as np

from softway.kernels.jit.compilation import kernel

DEPENDENT = 1e-12
"""Pivot relative to the greatest entry of the matrix below which a row depends on others."""
ADDED, ROUNDS = 1e-8, 3
"""Entry that is added on the diagonal of a matrix with a diagonal of about one, and solutions with it."""


@kernel
def solve_dense(A, x):
    """Solve in place by elimination with row exchanges; A is overwritten, unknowns of dependent rows become 0."""
    n, tiny = len(x), DEPENDENT * np.abs(A).max()
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[best, k]):
                best = i
        if best != k:
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
            x[k], x[best] = x[best], x[k]
        if abs(A[k, k]) <= tiny:
            continue
        for i in range(k + 1, n):
            factor = A[i, k] / A[k, k]
            if factor != 0.0:
                for j in range(k, n):
                    A[i, j] -= factor * A[k, j]
                x[i] -= factor * x[k]
    for k in range(n - 1, -1, -1):
        if abs(A[k, k]) <= tiny:
            x[k] = 0.0
            continue
        for j in range(k + 1, n):
            x[k] -= A[k, j] * x[j]
        x[k] /= A[k, k]


@kernel
def solve_nearly_dependent(A, x):
    """Solve in place where rows may almost depend on others; the solution hardly moves along dependent directions.

    A has a diagonal of about one, to which a small number is added; corrections by what is left then take its effect
    away (Riley's method).
    """
    b, left, order = x.copy(), x.copy(), np.arange(len(x))
    factor = A.copy()
    for i in range(len(x)):
        factor[i, i] += ADDED
    _eliminate(factor, order)
    x[:] = 0.0
    for turn in range(ROUNDS):
        if turn > 0:
            left[:] = b - A @ x
        _substitute(factor, order, left)
        x += left


@kernel
def _eliminate(A, order):
    """Factor in place by elimination, with the ``order`` (n,) of the exchanged rows."""
    n = len(order)
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[best, k]):
                best = i
        if best != k:
            order[k], order[best] = order[best], order[k]
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
        for i in range(k + 1, n):
            A[i, k] /= A[k, k]
            if A[i, k] != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= A[i, k] * A[k, j]


@kernel
def _substitute(A, order, x):
    """Solve in place with the factor."""
    b = x[order]
    for k in range(len(x)):
        for j in range(k):
            b[k] -= A[k, j] * b[j]
    for k in range(len(x) - 1, -1, -1):
        for j in range(k + 1, len(x)):
            b[k] -= A[k, j] * b[j]
        b[k] /= A[k, k]
    x[:] = b
