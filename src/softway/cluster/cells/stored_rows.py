"""Stored rows of the tangent at the own nodes of a rank, summed in the order of the cells."""

from collections.abc import Iterable, Sequence
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
        (k,) pairs of nodes of the cells of each material, in their order, whose rows belong to own nodes.
    places
        (k,) block of the pattern to which each pair is added.
    """

    indices: IntArray
    indptr: IntArray
    pairs: tuple[IntArray, ...]
    places: tuple[IntArray, ...]

    def rows(self, matrices: Iterable[Array], d: int) -> sp.bsr_array:
        """Rows (n d, n d) from the matrices of the cells (e, a, d, a, d) of each material, column before row."""
        n, z = len(self.indptr) - 1, len(self.indices)
        data = np.zeros((z, d, d))
        for each, pairs, places in zip(matrices, self.pairs, self.places, strict=True):
            row_sums(each, pairs, places, data)
        return sp.bsr_array((data, self.indices, self.indptr), shape=(n * d, n * d))


def row_table(nodes: Sequence[IntArray], own: BoolArray) -> RowTable:
    """Table of the rows of ``own`` (n,) nodes from the local nodes (e, a) of the cells of each material.

    Examples
    --------
    >>> table = row_table([np.array([[0, 1], [1, 2]])], np.array([False, True, False]))
    >>> table.indices.tolist(), table.indptr.tolist()
    ([0, 1, 2], [0, 0, 3, 3])
    >>> spring = np.array([[1.0, -1.0], [-1.0, 1.0]]).reshape(1, 2, 1, 2, 1)
    >>> table.rows([np.concatenate([spring, spring])], 1).toarray()[1].tolist()
    [-1.0, 2.0, -1.0]
    """
    n, keys, pairs = len(own), [], []
    for some in nodes:
        row, column = np.broadcast_arrays(some[:, :, None], some[:, None, :])
        pairs.append(np.flatnonzero(own[row].ravel()))
        keys.append(row.ravel()[pairs[-1]] * n + column.ravel()[pairs[-1]])
    every, places = np.unique(np.concatenate(keys), return_inverse=True)
    short = np.int32 if max(len(every), *(some.size * some.shape[1] for some in nodes)) < 2**31 else np.int64
    ends = np.cumsum([len(some) for some in keys])[:-1]
    return RowTable(
        indices=every % n,
        indptr=np.searchsorted(every, np.arange(n + 1) * n),
        pairs=tuple(some.astype(short) for some in pairs),
        places=tuple(np.split(np.asarray(places, short), ends)),
    )
