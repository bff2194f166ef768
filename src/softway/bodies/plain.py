"""Internal force by NumPy, for every law and section."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array

from softway.bodies.points import MaterialPoints
from softway.bodies.section import Section, derivatives, row_flux, row_moduli
from softway.kernels.gather import Assembler
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Plain:
    """Energy, force and tangent by arrays over all the points of a body.

    The displacement u is (n, d) [m].  Sampling it at the points is one sparse product, ``A = table u``; the section and
    the law turn A into energy and flux; the transpose of the table brings the flux back to the nodes.

    Parameters
    ----------
    section
        How the cells fill space.
    points
        The material points.
    volume
        (p,) reference volume of each point [m^3].
    table, transposed
        Sampling (p k, n) and its transpose.
    rows
        Per block of cells (e, q, a, k), the same numbers as the table.
    pattern
        Sparsity of the tangent.
    """

    section: Section
    points: MaterialPoints
    volume: Array
    table: csr_array
    transposed: csr_array
    rows: tuple[Array, ...]
    pattern: Assembler

    def derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) at the points."""
        A = (self.table @ u).reshape(len(self.volume), -1, u.shape[1])
        return derivatives(self.section, A)

    def nodal(self, flux: Array) -> Array:
        """Nodal forces (n, d) [N] of the flux (p, m, D) [Pa]."""
        q = row_flux(self.section, flux) * self.volume[:, None, None]
        return self.transposed @ q.reshape(-1, q.shape[-1])

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative to the displacement, (n, d) [N]."""
        energy, flux = self.points.energy_and_flux(self.derivatives(u))
        return float(self.volume @ energy), self.nodal(flux)

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        D = row_moduli(self.section, self.points.moduli(self.derivatives(u)))
        D *= self.volume[:, None, None, None, None]
        blocks, start = [], 0
        for G in self.rows:
            e, q, a, k = G.shape
            blocks.append(_cell_matrices(G, D[start : start + e * q]))
            start += e * q
        return self.pattern.assemble(blocks)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        return (self.tangent(u) @ w.ravel()).reshape(w.shape)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        n, d = u.shape
        blocks = self.tangent(u).tobsr((d, d))
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
