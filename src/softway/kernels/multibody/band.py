"""Symmetric positive semidefinite systems in a band: a factor that leaves out dependent rows."""

from softway.kernels.jit.compilation import uncounted_kernel

DEPENDENT = 1e-11
"""Pivot relative to the diagonal below which a row depends on those before it."""


@uncounted_kernel
def factor_band(A, L, D):
    """Factor ``A = L D L^T``; A and L (n, w + 1) hold the entry (i, j) at ``[i, i - j]``.

    A row that depends on those before it has the pivot 0, its solution is 0, and it takes no part in the others.
    """
    n, w = A.shape[0], A.shape[1] - 1
    for i in range(n):
        first = max(0, i - w)
        for j in range(first, i):
            total = A[i, i - j]
            for k in range(max(first, j - w), j):
                total -= L[i, i - k] * L[j, j - k] * D[k]
            L[i, i - j] = total / D[j] if D[j] > 0.0 else 0.0
        pivot = A[i, 0]
        for k in range(first, i):
            pivot -= L[i, i - k] * L[i, i - k] * D[k]
        L[i, 0] = 1.0
        D[i] = pivot if pivot > DEPENDENT * A[i, 0] else 0.0


@uncounted_kernel
def solve_band(L, D, x):
    """Solve in place with the factor; the values of dependent rows become 0."""
    n, w = L.shape[0], L.shape[1] - 1
    for i in range(n):
        for k in range(max(0, i - w), i):
            x[i] -= L[i, i - k] * x[k]
    for i in range(n):
        x[i] = x[i] / D[i] if D[i] > 0.0 else 0.0
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, min(n, i + w + 1)):
            x[i] -= L[k, k - i] * x[k]
