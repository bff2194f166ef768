"""Rows of a nodal matrix on a rank: complete at the nodes that it owns, empty at its copies of others."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.ranks.partition import Holding
from softway.ranks.space import RankSpace


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OwnRows:
    """Matrix (n, n) of local nodes in place of one of all nodes.

    Parameters
    ----------
    rows
        (n, n) the rows of own nodes; the others are empty.
    main, totals
        (n,) diagonal, and sums of the rows, at all local nodes.
    filling
        Space that fills products, where they are motions; None for products that are forces.
    """

    rows: sp.csr_array
    main: Array
    totals: Array
    filling: RankSpace | None = None

    def __matmul__(self, field: Array) -> Array:
        """Product (n, ...) with a field that is the same in all copies; zero at copies of others, or filled."""
        found = np.asarray(self.rows @ field)
        return found if self.filling is None else self.filling.filled(found)

    def diagonal(self) -> Array:
        """Diagonal (n,)."""
        return self.main

    def sum(self, axis: int) -> Array:
        """Sums (n,) of the rows."""
        assert axis == 1
        return self.totals


def own_rows(matrix: sp.csr_array, held: Holding, filling: RankSpace | None = None) -> OwnRows:
    """Rows of a matrix (N, N) of all nodes on a rank that holds all nodes of the columns of its own rows."""
    out = sp.csr_array(matrix[held.nodes[held.own]])
    out.sort_indices()
    n, count = len(held.nodes), np.zeros(len(held.nodes), np.int64)
    count[held.own] = np.diff(out.indptr)
    start = np.concatenate([[0], np.cumsum(count)])
    rows = sp.csr_array((out.data, held.local(out.indices), start), shape=(n, n))
    totals = np.asarray(matrix.sum(axis=1)).ravel()[held.nodes]
    return OwnRows(rows=rows, main=np.asarray(matrix.diagonal())[held.nodes], totals=totals, filling=filling)


def columns(matrix: sp.csr_array, rows: IntArray) -> IntArray:
    """Columns (k,) with entries in the ``rows`` of a matrix."""
    return np.unique(matrix[rows].indices)
