"""Congruence ``C A C^T`` of a dense matrix by sparse rows, in blocks that stay in the cache.

Products are added in the order of the stored entries, as in the sparse products of SciPy: both give the same bits.
"""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.kernels.jit.compilation import unfused_kernel

WIDTH = 64
"""Columns of a block."""


def congruence(rows: sp.csr_array, matrix: Array) -> Array:
    """Product ``C A C^T`` (k, k) for sparse rows C (k, b) and a dense matrix A (b, b); it is kept by columns.

    Examples
    --------
    >>> congruence(sp.csr_array([[1.0, 2.0]]), np.array([[1.0, 0.5], [0.5, 3.0]])).tolist()
    [[15.0]]
    """
    k, b = rows.shape
    products, out = np.empty((b, k)), np.empty((k, k))
    right_products(rows.data, rows.indices, rows.indptr, np.ascontiguousarray(matrix.T, float), products)
    left_products(rows.data, rows.indices, rows.indptr, products, out)
    return out.T


@unfused_kernel
def right_products(value, column, first, rows, products):
    """Write ``(C A)^T`` into ``products`` (b, k), for the rows (b, b) of ``A^T``; C (k, b) has the entries ``value`` in
    ``column``, from ``first`` (k + 1,) on.
    """
    k, b = len(first) - 1, len(rows)
    block, total = np.empty((b, WIDTH)), np.empty(WIDTH)
    for start in range(0, b, WIDTH):
        width = min(WIDTH, b - start)
        for a in range(b):
            for w in range(width):
                block[a, w] = rows[start + w, a]
        for i in range(k):
            total[:] = 0.0
            for q in range(first[i], first[i + 1]):
                amount, part = value[q], block[column[q]]
                for w in range(WIDTH):
                    total[w] += amount * part[w]
            for w in range(width):
                products[start + w, i] = total[w]


@unfused_kernel
def left_products(value, column, first, products, out):
    """Write ``C products`` (k, k) into ``out``, for ``products`` (b, k) and C as in :func:`right_products`."""
    k, total = len(first) - 1, np.empty(WIDTH)
    block = np.empty((len(products), WIDTH))
    for start in range(0, k, WIDTH):
        width = min(WIDTH, k - start)
        for a in range(len(products)):
            for w in range(width):
                block[a, w] = products[a, start + w]
        for i in range(k):
            total[:] = 0.0
            for q in range(first[i], first[i + 1]):
                amount, part = value[q], block[column[q]]
                for w in range(WIDTH):
                    total[w] += amount * part[w]
            for w in range(width):
                out[i, start + w] = total[w]
