"""Pattern of a sparse matrix."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import IntArray
from softway.errors import InputError


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """Pattern of the entries of a matrix (f, f) by columns: ``starts`` (f + 1,) and row ``indices`` (z,).

    Examples
    --------
    >>> Pattern.of(sp.csc_array(np.eye(2))).require(sp.csc_array(2.0 * np.eye(2)))
    """

    starts: IntArray
    indices: IntArray

    @classmethod
    def of(cls, matrix: sp.csc_array) -> "Pattern":
        """Pattern of a matrix (f, f)."""
        return cls(matrix.indptr.copy(), matrix.indices.copy())

    def require(self, matrix: sp.csc_array) -> None:
        """Raise :class:`InputError` unless a matrix (f, f) has this pattern."""
        if not (np.array_equal(matrix.indptr, self.starts) and np.array_equal(matrix.indices, self.indices)):
            raise InputError("matrix", "its pattern differs from the analysed one", "a new analysis")


def sum_within(matrix: sp.csc_array, other: sp.csc_array) -> sp.csc_array:
    """Sum (f, f) of two matrices, on the pattern of the first if it has all entries of the ``other``.

    Examples
    --------
    >>> full = sp.csc_array(np.array([[1.0, 2.0], [2.0, 3.0]]))
    >>> sum_within(full, sp.csc_array(np.diag([-1.0, 1.0]))).nnz
    4
    """
    ours, theirs = _places(matrix), _places(other)
    order = np.argsort(ours, kind="stable")
    found = order[np.minimum(np.searchsorted(ours, theirs, sorter=order), len(order) - 1)]
    if not np.array_equal(ours[found], theirs):
        return sp.csc_array(matrix + other)
    data = matrix.data.copy()
    np.add.at(data, found, other.data)
    return sp.csc_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


def _places(matrix: sp.csc_array) -> IntArray:
    """Numbers (z,) of the entries of a matrix in a full one, by columns."""
    columns = np.repeat(np.arange(matrix.shape[1], dtype=np.int64), np.diff(matrix.indptr))
    return columns * matrix.shape[0] + matrix.indices
