"""Coefficients of contact rows along the contact directions: unit rows or linear combinations."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class UnitRows:
    """Rows that are directions themselves: row i is the direction ``index[i]`` of ``count``, or none if that is -1."""

    index: IntArray
    count: int

    @property
    def used(self) -> IntArray:
        """Directions (k,) that the rows use."""
        return self.index[self.index >= 0]

    def from_basis(self, values: Array) -> Array:
        """Values (m,) of the rows from those of the directions (b,)."""
        return np.where(self.index >= 0, values[self.index], 0.0) if len(values) else np.zeros(len(self.index))

    def spread(self, amounts: Array) -> Array:
        """Forces (b,) along the directions from those of the rows (m,)."""
        out = np.zeros(self.count)
        own = self.index >= 0
        out[self.index[own]] = amounts[own]
        return out

    def subset(self, which: IntArray) -> "UnitRows":
        """Subset of the rows."""
        return UnitRows(self.index[which], self.count)

    def folded(self, compliance: Array) -> Array:
        """Compliance (m, m) of the rows from that of the used directions (k, k)."""
        own = self.index >= 0
        if own.all():
            return compliance
        out = np.zeros((len(own), len(own)))
        out[np.ix_(own, own)] = compliance
        return out


@dataclass(frozen=True, slots=True, eq=False)
class CombinedRows:
    """Rows with coefficients C (m, b) along the directions."""

    matrix: sp.csr_array

    @property
    def used(self) -> IntArray:
        """Directions (k,) that the rows use."""
        some = np.zeros(self.matrix.shape[1], bool)
        some[self.matrix.indices] = True
        return np.flatnonzero(some)

    def from_basis(self, values: Array) -> Array:
        """Values (m,) of the rows from those of the directions (b,)."""
        return np.asarray(self.matrix @ values)

    def spread(self, amounts: Array) -> Array:
        """Forces (b,) along the directions from those of the rows (m,)."""
        rows = self.matrix
        weights = rows.data * np.repeat(amounts, np.diff(rows.indptr))
        return np.asarray(np.bincount(rows.indices, weights, minlength=rows.shape[1]), float)

    def subset(self, which: IntArray) -> "CombinedRows":
        """Subset of the rows."""
        return CombinedRows(self.matrix[which])


RowCoefficients = UnitRows | CombinedRows


def joined_entries(
    matrix: sp.csr_array, column: IntArray, kept: BoolArray, units: tuple[IntArray, IntArray], width: int
) -> sp.csr_array:
    """Rows (m, width) of the entries ``kept`` (z,) of a matrix (m, f), in the ``column`` (z,), and of a unit in each of
    the rows ``units[0]`` (k,), of which nothing is kept, in the column ``units[1]``.

    Examples
    --------
    >>> matrix = sp.csr_array([[1.0, 2.0], [3.0, 4.0]])
    >>> column, kept = np.array([1, 2, -1, -1]), np.array([True, True, False, False])
    >>> joined_entries(matrix, column, kept, (np.array([1]), np.array([0])), 3).toarray().tolist()
    [[0.0, 1.0, 2.0], [1.0, 0.0, 0.0]]
    """
    own, unit = units
    count = np.concatenate([[0], np.cumsum(kept)])[matrix.indptr]
    single = np.zeros(matrix.shape[0], np.int64)
    single[own] = 1
    first = count + np.concatenate([[0], np.cumsum(single)])
    value, place, rest = np.ones(first[-1]), np.empty(first[-1], np.int64), np.ones(first[-1], bool)
    rest[first[own]] = False
    value[rest], place[rest], place[first[own]] = matrix.data[kept], column[kept], unit
    return sp.csr_array((value, place, first), shape=(matrix.shape[0], width))
