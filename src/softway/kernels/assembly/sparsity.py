"""Sums of sparse matrices with a fixed pattern."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sum:
    """Constant matrix plus a multiple of a matrix with changing values, restricted to the kept rows and columns.

    Parameters
    ----------
    constant
        (z,) values of the constant matrix on the common pattern.
    picked
        Indices of the stored values of the other matrix that are kept.
    place
        Their positions among the z entries of the common pattern.
    indices, indptr
        Common pattern (f, f) in compressed columns with sorted rows.
    """

    constant: Array
    picked: IntArray
    place: IntArray
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
    size = int(keep.sum())
    number = np.cumsum(keep) - 1
    first, second = (_keys(matrix, keep, number, size) for matrix in (constant, other))
    lone = first[0][~_among(first[0], second[0])]
    keys = np.sort(np.concatenate([second[0], lone]), kind="stable")
    values = np.zeros(len(keys))
    values[np.searchsorted(keys, first[0])] = constant.data[first[1]]
    column, row = np.divmod(keys, max(size, 1))
    return Sum(
        constant=values,
        picked=second[1],
        place=np.searchsorted(keys, second[0]),
        indices=row.astype(np.int32),
        indptr=np.searchsorted(column, np.arange(size + 1)).astype(np.int32),
    )


def _among(keys: IntArray, ordered: IntArray) -> BoolArray:
    """True (k,) for the keys that occur among the ordered ones (z,)."""
    place = np.minimum(np.searchsorted(ordered, keys), max(len(ordered) - 1, 0))
    return ordered[place] == keys if len(ordered) else np.zeros(len(keys), bool)


def _keys(matrix: csc_array, keep: BoolArray, number: IntArray, size: int) -> tuple[IntArray, IntArray]:
    """Sorted keys ``column * size + row`` of the kept entries, and the indices of their stored values."""
    columns = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    kept = np.flatnonzero(keep[columns] & keep[matrix.indices])
    keys = number[columns[kept]] * size + number[matrix.indices[kept]]
    if not matrix.has_sorted_indices:
        order = np.argsort(keys, kind="stable")
        keys, kept = keys[order], kept[order]
    return keys, kept
