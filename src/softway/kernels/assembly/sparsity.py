"""Sums of sparse matrices with a fixed pattern."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.assembly.merged_pattern import merged_pattern
from softway.kernels.jit.compilation import SMALL, interpreted


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sum:
    """Constant matrix plus a multiple of a matrix with changing values, restricted to the kept rows and columns.

    Parameters
    ----------
    constant
        (z,) values of the constant matrix on the common pattern.
    picked
        Indices of the stored values of the other matrix that are kept, or all.
    place
        Their positions among the z entries of the common pattern, or all.
    indices, indptr
        Common pattern (f, f) in compressed columns with sorted rows.
    """

    constant: Array
    picked: IntArray | slice
    place: IntArray | slice
    indices: IntArray
    indptr: IntArray

    def of(self, values: Array, factor: float) -> csc_array:
        """``constant + factor * other`` (f, f), where ``values`` are the stored values of the other matrix."""
        data = self.constant.copy()
        data[self.place] += factor * values[self.picked]
        size = len(self.indptr) - 1
        return csc_array((data, self.indices, self.indptr), (size, size))


def sum_of(constant: csc_array, other: csc_array, keep: BoolArray) -> Sum:
    """Prepare the :class:`Sum` of a constant and a changing matrix, both (m, m), on the components ``keep`` (m,).

    Examples
    --------
    >>> inertia = csc_array(np.diag([1.0, 0.0, 2.0]))
    >>> stiffness = csc_array(np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 0.0]]))
    >>> total = sum_of(inertia, stiffness, np.array([True, True, False]))
    >>> total.of(stiffness.data, 10.0).toarray().tolist()
    [[11.0, -10.0], [-10.0, 20.0]]
    """
    number = np.where(keep, np.cumsum(keep) - 1, -1)
    one, two, entries = constant.sorted_indices(), other, None
    if not other.has_sorted_indices:
        entries = csc_array((np.arange(other.nnz), other.indices, other.indptr), other.shape).sorted_indices()
        two = entries
    pattern = one.indptr, one.indices, one.data, two.indptr, two.indices
    values, picked, place, indices, indptr = interpreted(merged_pattern, one.nnz + two.nnz < SMALL)(*pattern, number)
    kept = picked if entries is None else entries.data[picked]
    return Sum(
        constant=values.copy(),
        picked=_short(kept, other.nnz),
        place=_short(place, len(values)),
        indices=indices.copy(),
        indptr=indptr,
    )


def _short(numbers: IntArray, size: int) -> IntArray | slice:
    """Numbers (k,) of entries, as all where they are the first to the last of ``size``."""
    return slice(None) if np.array_equal(numbers, np.arange(size)) else numbers.copy()
