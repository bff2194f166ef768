"""Dense systems of the rows of contacts, some of which may depend on others."""

import numpy as np

from softway.kernels.jit.compilation import kernel

DEPENDENT = 1e-12
"""Pivot relative to the greatest entry of the matrix below which a row depends on others."""


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
