"""Internal force of compiled stored energies by fused kernels, for elements of the dimension of space."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.kernel_cells import Block, KernelCells
from softway.kernels.fused import elastic, mean_elastic, mean_tangent
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
    mean
        Number of dimensions of the mean dilatation of an element; 0 for the dilatation of each point.
    small
        True for the linear theory.
    """

    law: CompiledLaw
    cells: KernelCells
    mean: int = 0
    small: bool = False

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
            kernel = mean_elastic.small_force if self.small else mean_elastic.force
            kernel = partial(kernel, self.mean) if self.mean else elastic.force
            self._share(kernel, block, rows, out, energies[-1])
        return np.concatenate([e.ravel() for e in energies]), self.cells.folded(out, len(u))

    @property
    def lanes(self) -> IntArray:
        """Lanes (b LANES,) in the order of the cells, then the empty ones."""
        return np.argsort(np.concatenate([block.points.ravel() for block in self.cells.blocks]), kind="stable")

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        rows, d = self._linearised(u), u.shape[1]
        out = self.cells.entries(d)
        for block in self.cells.blocks:
            target = block.pairs, self.cells.at, self.cells.step, out
            if self.mean:
                self._share_mean(mean_tangent.tangent, block, rows, *target)
            else:
                self._share(elastic.tangent, block, rows, *target)
        return self.cells.matrix(out, d)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        rows, change = self._linearised(u), self.cells.rows(w)
        out = np.zeros_like(rows)
        for block in self.cells.blocks:
            if self.mean:
                self._share_mean(mean_tangent.product, block, rows, change, out)
            else:
                self._share(elastic.product, block, rows, change, out)
        return self.cells.folded(out, len(u))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        rows, d = self._linearised(u), u.shape[1]
        out = np.zeros((*rows.shape, d))
        for block in self.cells.blocks:
            if self.mean:
                self._share_mean(mean_tangent.diagonal, block, rows, out)
            else:
                self._share(elastic.diagonal, block, rows, out)
        return self.cells.folded(out, len(u))

    def _linearised(self, u: Array) -> Array:
        """Displacement of the tangent, for the kernels."""
        return self.cells.rows(np.zeros_like(u) if self.small else u)

    def _share_mean(self, kernel: Callable[..., None], block: Block, rows: Array, *arrays: Any) -> None:
        law, cells = self.law, (block.rows, block.points, block.table, block.geometry, block.starts)

        def task(first: int, last: int) -> None:
            stages = law.measure.address, law.law.address, law.moduli
            kernel(self.mean, *stages, *cells, first, last, rows, None, None, *arrays)

        block.share(task)

    def _share(self, kernel: Callable[..., None], block: Block, *arrays: Array | IntArray) -> None:
        law = self.law
        cells = block.rows, block.table, block.geometry, block.starts

        def task(first: int, last: int) -> None:
            kernel(law.measure.address, law.law.address, law.moduli, *cells, first, last, *arrays)

        block.share(task)
