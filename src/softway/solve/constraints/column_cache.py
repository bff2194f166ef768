"""Cache of the columns of a matrix that are computed on demand."""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.kernels.linalg.weighted_rows import add_rows, find_extents

ROOM = 64
"""Initial capacity in columns; it doubles when it is used up."""
GROWTH = 256
"""Greatest growth of the capacity at a time beyond the request, in columns."""

SPARSE = 2
"""Places of all columns for each one between the first and the last entry, above which zeros are left out."""


class ColumnCache:
    """Cache of columns in the order in which they were added; ``batches`` lists the columns added together, and
    ``extent`` (count, 2) the places of their first and last entries that are not zero.

    Examples
    --------
    >>> table = ColumnCache()
    >>> table.add(np.array([3, 1]), np.array([[1.0, 2.0], [3.0, 4.0]]))
    >>> table.missing(np.array([1, 2])).tolist(), table.product(np.array([1, 3]), np.array([1.0, 10.0])).tolist()
    ([2], [13.0, 24.0])
    """

    __slots__ = ("batches", "count", "extent", "place", "room", "stored")

    def __init__(self) -> None:
        self.count, self.room = 0, ROOM
        self.batches: tuple[IntArray, ...] = ()
        self.place = np.full(0, -1)
        self.stored = np.zeros((0, 0))
        self.extent = np.zeros((0, 2), np.int64)

    def missing(self, which: IntArray) -> IntArray:
        """Subset of the columns ``which`` (k,) that are not stored yet."""
        inside = which < len(self.place)
        return which[~inside | (self.place[np.where(inside, which, 0)] < 0)] if len(self.place) else which

    def reserve(self, more: int) -> None:
        """Reserve memory for ``more`` columns."""
        need = self.count + more
        if self.count and need > len(self.stored):
            self._move(max(need, min(2 * self.count, self.count + GROWTH)), self.stored.shape[1])
        self.room = max(need, ROOM)

    def _move(self, room: int, length: int) -> None:
        stored = np.empty((room, length), self.stored.dtype)
        stored[: self.count] = self.stored[: self.count]
        self.stored = stored

    def add(self, which: IntArray, columns: Array) -> None:
        """Store new columns (k, m), given as rows."""
        if len(which) and which.max() >= len(self.place):
            self.place = np.concatenate([self.place, np.full(which.max() + 1 - len(self.place), -1)])
        end = self.count + len(which)
        if not self.count:
            self.stored = np.empty((max(end, self.room), columns.shape[1]), columns.dtype)
        elif end > len(self.stored):
            self._move(max(end, min(2 * self.count, self.count + GROWTH)), columns.shape[1])
        self.stored[self.count : end] = columns
        self.place[which] = np.arange(self.count, end)
        self.count = end
        extent = np.empty((len(which), 2), np.int64)
        find_extents(np.asarray(columns), extent)
        self.extent = np.concatenate([self.extent, extent])
        self.batches = (*self.batches, which)

    def square(self, which: IntArray) -> Array:
        """Rows and columns (k, k) of a symmetric matrix, of stored columns."""
        return np.asarray(np.take(self.stored[self.place[which]], which, axis=1).T)

    def product(self, which: IntArray, amounts: Array, length: int | None = None) -> Array:
        """Sum (m,) of columns times amounts (k,), or its first values up to a ``length``.

        Where columns are zero in most places, as those of many bodies, only the others are read.
        """
        m = self.stored.shape[1] if length is None else length
        extent = self.extent[self.place[which]]
        if SPARSE * int(np.sum(extent[:, 1] - extent[:, 0])) < self.count * m:
            out = np.zeros(m)
            add_rows(self.stored, self.place[which], np.asarray(amounts, float), extent, out)
            return out
        full = np.zeros(self.count, self.stored.dtype)
        full[self.place[which]] = amounts
        if 2 * len(which) > self.count:
            return np.asarray(full @ self.stored[: self.count, :length], float)
        used = self.place[which]
        return np.asarray(full[used] @ self.stored[used, :length], float)

    def combined(self, amounts: sp.csr_array) -> Array:
        """Sums (k, m) of columns times the amounts (k, b), whose columns are all stored."""
        stored = sp.csr_array(
            (amounts.data, self.place[amounts.indices], amounts.indptr), shape=(amounts.shape[0], self.count)
        )
        return np.asarray(stored @ self.stored[: self.count], float)
