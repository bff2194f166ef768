"""Congruence ``C A C^T`` of a dense matrix by sparse rows, in blocks that stay in the cache.

Products are added in the order of the stored entries, as in the sparse products of SciPy: both give the same bits.
"""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
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
    every, whole = np.arange(rows.shape[1]), np.ascontiguousarray(matrix.T, float)
    return _congruence((rows.data, rows.indices, rows.indptr), whole, every, every, _all(whole))


def congruence_of_columns(rows: sp.csr_array, columns: Array, place: IntArray, extent: IntArray | None = None) -> Array:
    """Product ``C A C^T`` (k, k) of sparse rows C (k, b) and a matrix A whose column j is ``columns[place[j]]``.

    Only the columns that the rows use are read, and within them only the ``extent`` (r, 2), beyond which they are zero.

    Examples
    --------
    >>> columns = np.array([[0.5, 3.0, 9.0], [1.0, 0.5, 9.0]])
    >>> congruence_of_columns(sp.csr_array([[1.0, 2.0, 0.0]]), columns, np.array([1, 0, -1])).tolist()
    [[15.0]]
    """
    some = np.zeros(rows.shape[1], bool)
    some[rows.indices] = True
    used, column = np.flatnonzero(some), (np.cumsum(some) - 1)[rows.indices]
    own = _all(columns) if extent is None else extent
    return _congruence((rows.data, column, rows.indptr), columns, place[used], used, own[place[used]])


def _all(matrix: Array) -> IntArray:
    """Extents (r, 2) of whole rows."""
    return np.tile([0, matrix.shape[1]], (len(matrix), 1))


def _congruence(
    rows: tuple[Array, IntArray, IntArray], matrix: Array, row: IntArray, place: IntArray, extent: IntArray
) -> Array:
    """Product of sparse rows with the dense matrix of the ``row`` (b,) and columns ``place`` (b,), transposed."""
    k = len(rows[2]) - 1
    half, out = np.empty((len(row), k)), np.empty((k, k), order="F")
    products_with_rows(matrix, row, place, extent, *rows, half)
    products_with_rows(half.T, np.arange(k), np.arange(len(row)), _all(half.T), *rows, out)
    return out


@unfused_kernel
def products_with_rows(matrix, row, place, extent, value, column, first, out):
    """Write ``M C^T`` (m, k) into ``out``, for the ``row`` (m,) and the columns ``place`` (b,) of a dense matrix, zero
    beyond the ``extent`` (m, 2) of its rows, and sparse rows C (k, b) with the entries ``value`` in ``column``, from
    ``first`` (k + 1,) on.

    Where a column is zero in a whole block, as between bodies, nothing is added.
    """
    m, b, k = len(row), len(place), len(first) - 1
    block, total, live = np.zeros((b, WIDTH)), np.empty(WIDTH), np.empty(b, np.bool_)
    for start in range(0, m, WIDTH):
        width = min(WIDTH, m - start)
        low, high = extent[start, 0], extent[start, 1]
        for w in range(1, width):
            low, high = min(low, extent[start + w, 0]), max(high, extent[start + w, 1])
        for a in range(b):
            live[a] = low <= place[a] < high
            if live[a]:
                for w in range(width):
                    block[a, w] = matrix[row[start + w], place[a]]
        for i in range(k):
            total[:] = 0.0
            for q in range(first[i], first[i + 1]):
                if live[column[q]]:
                    amount, part = value[q], block[column[q]]
                    for w in range(WIDTH):
                        total[w] += amount * part[w]
            for w in range(width):
                out[start + w, i] = total[w]
