"""Strain operator: displacement derivatives at the quadrature points, nodal forces and matrices from the points."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array

from softway.arrays import Array
from softway.bodies.elements.mean_dilatation import MeanDilatation
from softway.bodies.elements.section import Section, derivatives, row_flux, row_moduli
from softway.kernels.assembly.assembler import Assembler


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StrainOperator:
    """Operator from nodal displacements to displacement derivatives at the quadrature points, and its transpose.

    The displacement u (n, d) [m] is sampled by one sparse product, ``A = table u``.  The section turns A into
    derivatives, and the transpose of the table turns a flux at the points into nodal forces.

    Parameters
    ----------
    section
        Section of the elements.
    volume
        (p,) reference volume of each point [m^3].
    table
        Sparse table (p k, n) of the samples.
    rows
        Rows (e, q, a, k) of the table, for each cell type.
    pattern
        Sparsity pattern of the tangent.
    dilatation
        Averaged volume change of the elements; None for the volume change of each point.
    """

    section: Section
    volume: Array
    table: csr_array
    rows: tuple[Array, ...]
    pattern: Assembler
    dilatation: MeanDilatation | None = None

    def derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) at the points, with the averaged volume change where there is one."""
        H = self.plain_derivatives(u)
        return H if self.dilatation is None else self.dilatation.applied(H)

    def plain_derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) of the shape functions."""
        A = (self.table @ u).reshape(len(self.volume), -1, u.shape[1])
        return derivatives(self.section, A)

    def nodal(self, flux: Array, u: Array) -> Array:
        """Nodal forces (n, d) [N] of the flux (p, m, D) [Pa] conjugate to :meth:`derivatives` at u (n, d)."""
        if self.dilatation is not None:
            flux = self.dilatation.returned(flux, self.plain_derivatives(u))
        return self.unweighted(flux)

    def unweighted(self, flux: Array) -> Array:
        """Nodal forces (n, d) [N] of the flux (p, m, D) [Pa] conjugate to :meth:`plain_derivatives`."""
        q = row_flux(self.section, flux) * self.volume[:, None, None]
        return np.asarray(self.table.T @ q.reshape(-1, q.shape[-1]))

    def matrix(self, moduli: Array, flux: Array, u: Array) -> csc_array:
        """Derivative (n d, n d) [N/m] of :meth:`nodal` for moduli (p, m, D, m, D) and flux (p, m, D) [Pa]."""
        if self.dilatation is not None:
            H = self.plain_derivatives(u)
            return self.dilatation.matrix(self.pattern, moduli, flux, H)
        D = row_moduli(self.section, moduli)
        D *= self.volume[:, None, None, None, None]
        blocks, start = [], 0
        for G in self.rows:
            e, q, _, _ = G.shape
            blocks.append(_cell_matrices(G, D[start : start + e * q]))
            start += e * q
        return self.pattern.assemble(blocks)

    def cell_means(self, values: Array, weight: Array) -> Array:
        """Averages (e, ...) over each element of values (p, ...) at the points with weights (p,)."""
        points_of = np.concatenate([np.full(len(G), G.shape[1]) for G in self.rows])
        starts = np.cumsum(points_of) - points_of
        total = np.add.reduceat((weight * values.T).T, starts)
        return np.asarray((total.T / np.add.reduceat(weight, starts)).T)


def diagonal_blocks(matrix: csc_array, shape: tuple[int, int]) -> Array:
    """Diagonal blocks (n, d, d) of a matrix (n d, n d), one for each node.

    Examples
    --------
    >>> diagonal_blocks(csc_array(np.diag([1.0, 2.0])), (1, 2)).tolist()
    [[[1.0, 0.0], [0.0, 2.0]]]
    """
    n, d = shape
    blocks = matrix.tobsr((d, d))
    node = np.repeat(np.arange(n), np.diff(blocks.indptr))
    out = np.zeros((n, d, d))
    same = node == blocks.indices
    out[node[same]] = blocks.data[same]
    return out


def _cell_matrices(G: Array, D: Array) -> Array:
    """Element matrices ``sum_q G_qar D_qrisj G_qbs`` (e, a, b, d, d) of rows (e, q, a, k), moduli (e q, k, d, k, d)."""
    e, q, a, k = G.shape
    d = D.shape[2]
    half = (G @ D.reshape(e, q, k, d * k * d)).reshape(e, q, a, d, k, d)
    left = half.transpose(0, 2, 3, 5, 1, 4).reshape(e, a * d * d, q * k)
    right = np.swapaxes(G, 2, 3).reshape(e, q * k, a)
    return (left @ right).reshape(e, a, d, d, a).transpose(0, 1, 4, 2, 3)
