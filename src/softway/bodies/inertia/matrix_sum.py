"""Sum of a constant and a changing matrix, on the unknowns of a map."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray


class MatrixSum(Protocol):
    """Constant matrix plus a multiple of a changing one, on the unknowns."""

    def of(self, values: Array, factor: float) -> sp.csc_array:
        """``constant + factor * other`` (f, f), where ``values`` are the stored values of the other matrix."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CombinedSum:
    """Sum of matrices (n d, n d) on the nodes, restricted to the unknowns with the ``jacobian`` (n d, f).

    Its pattern does not depend on the values, although products of sparse matrices leave out zeros.

    Examples
    --------
    >>> inertia, stiffness = sp.csc_array(np.eye(2)), sp.csc_array(np.array([[1.0, -1.0], [-1.0, 1.0]]))
    >>> total = CombinedSum(jacobian=sp.csr_array(np.ones((2, 1))), constant=inertia, other=stiffness)
    >>> total.of(stiffness.data, 3.0).toarray().tolist(), total.of(stiffness.data, -1.0).nnz
    ([[2.0]], 1)
    """

    jacobian: sp.csr_array
    constant: sp.csc_array
    other: sp.csc_array
    indices: IntArray = field(init=False)
    indptr: IntArray = field(init=False)

    def __post_init__(self) -> None:
        filled = sp.csc_array(_ones(self.constant) + _ones(self.other))
        pattern = sp.csc_array(_ones(self.jacobian).T @ filled @ _ones(self.jacobian))
        pattern.sort_indices()
        object.__setattr__(self, "indices", pattern.indices.astype(np.int32))
        object.__setattr__(self, "indptr", pattern.indptr.astype(np.int32))

    def of(self, values: Array, factor: float) -> sp.csc_array:
        """``J^T (constant + factor other) J`` (f, f)."""
        other = sp.csc_array((values, self.other.indices, self.other.indptr), shape=self.other.shape)
        made = sp.csc_array(self.jacobian.T @ (self.constant + factor * other) @ self.jacobian)
        f, data = made.shape[0], np.zeros(len(self.indices))
        places = _keys(self.indices, self.indptr, f).searchsorted(_keys(made.indices, made.indptr, f))
        data[places] = made.data
        return sp.csc_array((data, self.indices, self.indptr), shape=made.shape)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BondedSum:
    """:class:`MatrixSum` of a stiffness of solids and stiffnesses (m, d, d) of jumps between them, one after the other
    among the values.

    Parameters
    ----------
    plain
        Sum with the pattern of both stiffnesses.
    jumps
        (m d, n d) jumps from the displacement.
    solids
        (z,) places of the values of the solids in the common pattern.
    keys
        Number of the place of each entry of the common pattern, ascending.
    """

    plain: MatrixSum
    jumps: sp.csr_array
    solids: IntArray
    keys: IntArray

    def of(self, values: Array, factor: float) -> sp.csc_array:
        """``constant + factor * (solids + jumps)`` (f, f)."""
        data, z = np.zeros(len(self.keys)), len(self.solids)
        data[self.solids] = values[:z]
        rows = self.jumps.shape[0]
        d = (len(values) - z) // rows
        each = sp.bsr_array(
            (values[z:].reshape(-1, d, d), np.arange(rows // d), np.arange(rows // d + 1)), shape=(rows, rows)
        )
        made = sp.csc_array(self.jumps.T @ each @ self.jumps)
        made.sort_indices()
        data[self.keys.searchsorted(_keys(made.indices, made.indptr, made.shape[0]))] += made.data
        return self.plain.of(data, factor)


class Summing(Protocol):
    """Map of unknowns that sums matrices."""

    def sum(self, constant: sp.csc_array, other: sp.csc_array) -> MatrixSum:
        """Sum of a constant and a changing matrix, both (n d, n d) on the nodes."""
        ...


def bonded_sum(dofs: Summing, constant: sp.csc_array, solids: sp.csc_array, rows: sp.csr_array) -> BondedSum:
    """Prepare the sum of a constant matrix, the stiffness of ``solids``, both (n d, n d), and that of jumps with
    ``rows`` (m, n) on the nodes.

    Examples
    --------
    >>> from softway.bodies.dof_map import NodalDofs
    >>> none, one = sp.csc_array((2, 2)), sp.csr_array(np.array([[1.0, -1.0]]))
    >>> total = bonded_sum(NodalDofs(np.ones((2, 1), bool)), none, sp.csc_array(np.eye(2)), one)
    >>> total.of(np.array([1.0, 1.0, 5.0]), 2.0).toarray().tolist()
    [[12.0, -10.0], [-10.0, 12.0]]
    """
    size = constant.shape[0]
    d = size // rows.shape[1]
    met = sp.csr_array(_ones(rows).T @ _ones(rows))
    filled = sp.csc_array(_ones(solids) + sp.csr_array(sp.kron(met, np.ones((d, d)), format="csr")))
    filled.sort_indices()
    keys = _keys(filled.indices, filled.indptr, size)
    places = keys.searchsorted(_keys(solids.indices, solids.indptr, size))
    jumps = sp.csr_array(sp.kron(rows, sp.eye_array(d), format="csr"))
    return BondedSum(plain=dofs.sum(constant, filled), jumps=jumps, solids=places, keys=keys)


def _ones(matrix: sp.sparray) -> sp.csr_array:
    """Matrix of ones at the stored entries of another."""
    made = sp.csr_array(matrix)
    return sp.csr_array((np.ones(made.nnz), made.indices, made.indptr), shape=made.shape)


def _keys(indices: IntArray, indptr: IntArray, f: int) -> IntArray:
    """Number (z,) of the place of each entry of a matrix (f, f), column after column."""
    return np.repeat(np.arange(f, dtype=np.int64), np.diff(indptr)) * f + indices
