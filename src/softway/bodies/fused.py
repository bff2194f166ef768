"""Internal force by fused kernels, for the laws that have compiled stages and cells that fill their space."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.fused_cells import Block, FusedCells
from softway.kernels import fused
from softway.laws.compiled import CompiledLaw
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fused:
    """Energy, force and tangent in one pass over the cells; the same bits for every number of threads.

    Parameters
    ----------
    law
        Stages of the material.
    cells
        The cells in the order of the kernels.
    """

    law: CompiledLaw
    cells: FusedCells

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative to the displacement, (n, d) [N]."""
        energies = [np.zeros(len(block.starts) - 1) for block in self.cells.blocks]
        rows = self.cells.rows(u)
        out = np.zeros_like(rows)
        for block, energy in zip(self.cells.blocks, energies, strict=True):
            self._share(fused.force, block, rows, out, energy)
        return float(np.concatenate(energies).sum()), self.cells.folded(out, len(u))

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        rows, d = self.cells.rows(u), u.shape[1]
        out = self.cells.entries(d)
        for block in self.cells.blocks:
            self._share(fused.tangent, block, rows, block.pairs, self.cells.at, self.cells.step, out)
        return self.cells.matrix(out, d)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        rows, change = self.cells.rows(u), self.cells.rows(w)
        out = np.zeros_like(rows)
        for block in self.cells.blocks:
            self._share(fused.product, block, rows, change, out)
        return self.cells.folded(out, len(u))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        rows, d = self.cells.rows(u), u.shape[1]
        out = np.zeros((*rows.shape, d))
        for block in self.cells.blocks:
            self._share(fused.diagonal, block, rows, out)
        return self.cells.folded(out, len(u))

    def _share(self, kernel: Callable[..., None], block: Block, *arrays: Array | IntArray) -> None:
        law = self.law
        cells = block.rows, block.table, block.geometry, block.starts

        def task(first: int, last: int) -> None:
            kernel(law.measure.address, law.law.address, law.moduli, *cells, first, last, *arrays)

        block.share(task)
