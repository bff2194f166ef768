"""Stored rows of the tangent at the own nodes of a rank, summed in the order of the cells."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.assembly.row_sums import row_sums


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowTable:
    """Pattern of the rows of own nodes, and the places of the blocks of the cells in it.

    Parameters
    ----------
    indices, indptr
        Columns of the blocks (z,), ascending, and the first block of each of the n rows.
    pairs
        (k,) pairs of nodes of the cells, in their order, whose rows belong to own nodes.
    places
        (k,) block of the pattern to which each pair is added.
    """

    indices: IntArray
    indptr: IntArray
    pairs: IntArray
    places: IntArray

    def rows(self, blocks: Array) -> sp.bsr_array:
        """Rows (n d, n d) from the matrices of the cells (e, a, d, a, d), column before row."""
        d, n, z = blocks.shape[-1], len(self.indptr) - 1, len(self.indices)
        data = np.zeros((z, d, d))
        row_sums(blocks, self.pairs, self.places, data)
        return sp.bsr_array((data, self.indices, self.indptr), shape=(n * d, n * d))


def row_table(nodes: IntArray, own: BoolArray) -> RowTable:
    """Table of the rows of ``own`` (n,) nodes from the local ``nodes`` (e, a) of the cells.

    Examples
    --------
    >>> table = row_table(np.array([[0, 1], [1, 2]]), np.array([False, True, False]))
    >>> table.indices.tolist(), table.indptr.tolist()
    ([0, 1, 2], [0, 0, 3, 3])
    >>> spring = np.array([[1.0, -1.0], [-1.0, 1.0]]).reshape(1, 2, 1, 2, 1)
    >>> table.rows(np.concatenate([spring, spring])).toarray()[1].tolist()
    [-1.0, 2.0, -1.0]
    """
    n = len(own)
    row, column = np.broadcast_arrays(nodes[:, :, None], nodes[:, None, :])
    pairs = np.flatnonzero(own[row].ravel())
    keys, places = np.unique(row.ravel()[pairs] * n + column.ravel()[pairs], return_inverse=True)
    indptr = np.searchsorted(keys, np.arange(n + 1) * n)
    short = np.int32 if row.size < 2**31 else np.int64
    return RowTable(indices=keys % n, indptr=indptr, pairs=pairs.astype(short), places=np.asarray(places, short))
