"""Sparse tables that gather nodal values at quadrature points and assemble cell matrices."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array

from softway.arrays import Array, IntArray
from softway.kernels.assembly.node_pairs import expanded, node_pairs
from softway.kernels.jit.compilation import SMALL, interpreted


def gather_table(cells: IntArray, rows: Array, nodes: int) -> csr_array:
    """Matrix (e q k, n) that maps nodal values to the k rows at each quadrature point of the cells.

    Parameters
    ----------
    cells
        (e, a) node numbers.
    rows
        (e, q, a, k) coefficients of the nodes, such as gradients of shape functions.
    nodes
        Number of nodes n.

    Examples
    --------
    >>> table = gather_table(np.array([[0, 2]]), np.array([[[[-1.0], [1.0]]]]), 3)
    >>> table @ np.array([1.0, 5.0, 4.0])
    array([3.])
    """
    e, q, a, k = rows.shape
    columns = np.broadcast_to(cells[:, None, None, :], (e, q, k, a))
    data = np.ascontiguousarray(np.swapaxes(rows, -1, -2))
    starts = np.arange(0, data.size + 1, a)
    return csr_array((data.ravel(), columns.ravel().astype(np.int32), starts), (e * q * k, nodes))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Assembler:
    """Assembly of cell matrices into a sparse matrix with a fixed pattern.

    Parameters
    ----------
    sums
        (p, sum e a a) matrix that adds the node pairs of all cells to the p pairs of the pattern.
    order
        Position of each stored entry of the matrix among the (p, d, d) entries of the pairs.
    indices, indptr
        Sparsity pattern of the matrix.
    """

    sums: csr_array
    order: IntArray
    indices: IntArray
    indptr: IntArray

    def assemble(self, blocks: list[Array]) -> csc_array:
        """Symmetric matrix (n d, n d) assembled from cell matrices (e, a, a, d, d), one array for each type of cell."""
        pairs = np.concatenate([block.reshape(-1, block.shape[-1] ** 2) for block in blocks])
        data = (self.sums @ pairs).ravel()[self.order]
        return self.matrix(data)

    def matrix(self, data: Array) -> csc_array:
        """Matrix (n d, n d) with the stored entries ``data``."""
        size = len(self.indptr) - 1
        return csc_array((data, self.indices, self.indptr), (size, size))

    def nodal(self, blocks: list[Array], components: int) -> csr_array:
        """Matrix (n, n) on the nodes assembled from cell matrices (e, a, a), one array for each type of cell."""
        values = self.sums @ np.concatenate([block.ravel() for block in blocks])
        ends = self.indptr[::components]
        stored = np.diff(self.indptr)[::components]
        first = np.repeat(ends[:-1], stored // components)
        own = first + components * (np.arange(len(first)) - np.repeat(ends[:-1] // components**2, stored // components))
        n = len(ends) - 1
        return csr_array((values, self.indices[own] // components, ends // components**2), (n, n))

    def pair_of(self) -> IntArray:
        """Pair of the pattern, (sum e a a,), to which each node pair of each cell belongs."""
        out = np.empty(self.sums.shape[1], np.int64)
        out[self.sums.indices] = np.repeat(np.arange(self.sums.shape[0]), np.diff(self.sums.indptr))
        return out

    def places(self, components: int) -> tuple[IntArray, IntArray]:
        """Positions of the entries of the pairs: entry (i, j) of pair p is stored at ``at[p] + i step[p] + j``."""
        place = np.empty(len(self.order), np.int32)
        place[self.order] = np.arange(len(self.order), dtype=np.int32)
        at = place[:: components**2].astype(np.int64)
        return at, place[components :: components**2] - at


def assembler(cells: list[IntArray], nodes: int, components: int) -> Assembler:
    """Build the :class:`Assembler` of blocks of cells (e, a) on n nodes with d components each.

    Examples
    --------
    >>> line = assembler([np.array([[0, 1], [1, 2]])], 3, 1)
    >>> spring = np.array([[1.0, -1.0], [-1.0, 1.0]]).reshape(1, 2, 2, 1, 1)
    >>> line.assemble([np.concatenate([spring, spring])]).toarray().tolist()
    [[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]]
    """
    widths = np.concatenate([[0], *(np.full(len(block), block.shape[1]) for block in cells)])
    numbers = np.concatenate([np.asarray(block, np.int64).ravel() for block in cells])
    small = sum(block.size * block.shape[1] for block in cells) < SMALL
    rows, columns, starts, members = interpreted(node_pairs, small)(numbers, np.cumsum(widths), nodes)
    sums = csr_array((np.ones(len(members)), members, starts.copy()), (len(columns), len(members)))
    order, indices, indptr = interpreted(expanded, small)(rows, columns, components)
    return Assembler(sums=sums, order=order, indices=indices, indptr=indptr)
