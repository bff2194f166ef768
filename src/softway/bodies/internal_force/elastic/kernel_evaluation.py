"""Internal force of compiled stored energies by fused kernels, for elements of the dimension of space."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.kernel_cells import Block, KernelCells
from softway.kernels.fused import elastic
from softway.laws.kernel_laws import CompiledLaw


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KernelEvaluation:
    """Energy, force and tangent in one pass over the elements.

    Results do not depend on the number of threads, bit by bit.  The displacement u is (n, d) [m].

    Parameters
    ----------
    law
        Compiled stages of the law.
    cells
        Elements in the order of the kernels.
    """

    law: CompiledLaw
    cells: KernelCells

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative with respect to the displacement, (n, d) [N]."""
        energies, force = self.energies_and_force(u)
        return float(energies.sum()), force

    def energies_and_force(self, u: Array) -> tuple[Array, Array]:
        """Stored energy (b LANES,) of each lane [J], zero in empty ones, and force (n, d) [N]."""
        rows = self.cells.rows(u)
        out, energies = np.zeros_like(rows), []
        for block in self.cells.blocks:
            energies.append(np.zeros(block.points.shape))
            self._share(elastic.force, block, rows, out, energies[-1])
        return np.concatenate([e.ravel() for e in energies]), self.cells.folded(out, len(u))

    @property
    def lanes(self) -> IntArray:
        """Lanes (b LANES,) in the order of the cells, then the empty ones."""
        return np.argsort(np.concatenate([block.points.ravel() for block in self.cells.blocks]), kind="stable")

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        rows, d = self.cells.rows(u), u.shape[1]
        out = self.cells.entries(d)
        for block in self.cells.blocks:
            self._share(elastic.tangent, block, rows, block.pairs, self.cells.at, self.cells.step, out)
        return self.cells.matrix(out, d)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        rows, change = self.cells.rows(u), self.cells.rows(w)
        out = np.zeros_like(rows)
        for block in self.cells.blocks:
            self._share(elastic.product, block, rows, change, out)
        return self.cells.folded(out, len(u))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        rows, d = self.cells.rows(u), u.shape[1]
        out = np.zeros((*rows.shape, d))
        for block in self.cells.blocks:
            self._share(elastic.diagonal, block, rows, out)
        return self.cells.folded(out, len(u))

    def _share(self, kernel: Callable[..., None], block: Block, *arrays: Array | IntArray) -> None:
        law = self.law
        cells = block.rows, block.table, block.geometry, block.starts

        def task(first: int, last: int) -> None:
            kernel(law.measure.address, law.law.address, law.moduli, *cells, first, last, *arrays)

        block.share(task)
