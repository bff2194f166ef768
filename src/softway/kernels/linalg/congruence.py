"""Congruence ``C A C^T`` of a dense matrix by sparse rows, in blocks that stay in the cache.

Products are added in the order of the stored entries, as in the sparse products of SciPy: both give the same bits.
"""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.kernels.jit.compilation import unfused_kernel

WIDTH = 64
"""Rows of the matrix in a block."""


def congruence(rows: sp.csr_array, matrix: Array) -> Array:
    """Product ``C A C^T`` (k, k) for sparse rows C (k, b) and a dense matrix A (b, b); it is kept by columns.

    Examples
    --------
    >>> congruence(sp.csr_array([[1.0, 2.0]]), np.array([[1.0, 0.5], [0.5, 3.0]])).tolist()
    [[15.0]]
    """
    k, b = rows.shape
    half, out = np.empty((b, k)), np.empty((k, k), order="F")
    products_with_rows(np.ascontiguousarray(matrix.T, float), rows.data, rows.indices, rows.indptr, half)
    products_with_rows(half.T, rows.data, rows.indices, rows.indptr, out)
    return out


@unfused_kernel
def products_with_rows(matrix, value, column, first, out):
    """Write ``M C^T`` (m, k) into ``out``, for a dense ``matrix`` M (m, b) and sparse rows C (k, b) with the entries
    ``value`` in ``column``, from ``first`` (k + 1,) on.
    """
    (m, b), k = matrix.shape, len(first) - 1
    block, total = np.empty((b, WIDTH)), np.empty(WIDTH)
    for start in range(0, m, WIDTH):
        width = min(WIDTH, m - start)
        for a in range(b):
            for w in range(width):
                block[a, w] = matrix[start + w, a]
        for i in range(k):
            total[:] = 0.0
            for q in range(first[i], first[i + 1]):
                amount, part = value[q], block[column[q]]
                for w in range(WIDTH):
                    total[w] += amount * part[w]
            for w in range(width):
                out[start + w, i] = total[w]
