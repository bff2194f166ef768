"""From the nodes of a body to its points and back: what every law meets in the same way."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array

from softway.bodies.dilatation import Dilatation
from softway.bodies.section import Section, derivatives, row_flux, row_moduli
from softway.kernels.gather import Assembler
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sampling:
    """Displacement derivatives at the points of a body, and the nodal forces of a flux there.

    Sampling the displacement u (n, d) [m] is one sparse product, ``A = table u``; the section makes derivatives of A,
    and the transpose of the table brings a flux back to the nodes.

    Parameters
    ----------
    section
        How the cells fill space.
    volume
        (p,) reference volume of each point [m^3].
    table, transposed
        Sampling (p k, n) and its transpose.
    rows
        Per block of cells (e, q, a, k), the same numbers as the table.
    pattern
        Sparsity of the tangent.
    dilatation
        The means that replace the change of volume at the points, if any.
    """

    section: Section
    volume: Array
    table: csr_array
    transposed: csr_array
    rows: tuple[Array, ...]
    pattern: Assembler
    dilatation: Dilatation | None = None

    def derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) at the points, with the mean dilatation of the cells."""
        H = self.plain_derivatives(u)
        return H if self.dilatation is None else self.dilatation.applied(H)

    def plain_derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) as the shape functions have them."""
        A = (self.table @ u).reshape(len(self.volume), -1, u.shape[1])
        return derivatives(self.section, A)

    def nodal(self, flux: Array, u: Array) -> Array:
        """Nodal forces (n, d) [N] of the flux (p, m, D) [Pa] on :meth:`derivatives` at the displacement u."""
        if self.dilatation is not None:
            flux = self.dilatation.returned(flux, self.plain_derivatives(u))
        return self.unweighted(flux)

    def unweighted(self, flux: Array) -> Array:
        """Nodal forces (n, d) [N] of the flux (p, m, D) [Pa] on :meth:`plain_derivatives`."""
        q = row_flux(self.section, flux) * self.volume[:, None, None]
        return self.transposed @ q.reshape(-1, q.shape[-1])

    def matrix(self, moduli: Array, flux: Array, u: Array) -> csc_array:
        """Derivative (n d, n d) [N/m] of :meth:`nodal`, of moduli (p, m, D, m, D) and flux (p, m, D) [Pa]."""
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
        """Means (e, ...) over each cell of values (p, ...) at its points, by a weight (p,)."""
        points_of = np.concatenate([np.full(len(G), G.shape[1]) for G in self.rows])
        starts = np.cumsum(points_of) - points_of
        total = np.add.reduceat((weight * values.T).T, starts)
        return np.asarray((total.T / np.add.reduceat(weight, starts)).T)


def diagonal_blocks(matrix: csc_array, shape: tuple[int, int]) -> Array:
    """Blocks (n, d, d) of a matrix (n d, n d) that couple each node with itself.

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
    """``sum_q G_qar D_qrisj G_qbs`` of rows (e, q, a, k) and moduli (e q, k, d, k, d), (e, a, b, d, d)."""
    e, q, a, k = G.shape
    d = D.shape[2]
    half = (G @ D.reshape(e, q, k, d * k * d)).reshape(e, q, a, d, k, d)
    left = half.transpose(0, 2, 3, 5, 1, 4).reshape(e, a * d * d, q * k)
    right = np.swapaxes(G, 2, 3).reshape(e, q * k, a)
    return (left @ right).reshape(e, a, d, d, a).transpose(0, 1, 4, 2, 3)
