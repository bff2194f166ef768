"""Internal force of laws with a history by fused kernels, for cells that fill their space."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from softway.bodies.fused_cells import Block, FusedCells
from softway.bodies.memory import Memory
from softway.kernels import fused_mean, fused_past
from softway.kernels.compiled import Stage
from softway.laws.compiled import CompiledRateLaw, resting
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RateFused:
    """What a body answers to a slab, in one pass over its cells; the same bits for every number of threads.

    The memory is read and written as it is, point after point: a pass reads it once, in the order of the cells, and
    arrays in the order of the kernels would have to be made anew for every slab.

    Parameters
    ----------
    law
        Stages of the material.
    cells
        The cells in the order of the kernels.
    volume
        (p,) reference volume of each point [m^3].
    mean
        Number of dimensions whose change of volume is the mean of the cell; 0 where it is that of the point.  Tangents
        are those of the point.
    """

    law: CompiledRateLaw
    cells: FusedCells
    volume: Array
    mean: int = 0

    def energy_and_force(self, u: Array, memory: Memory, span: float) -> tuple[float, Array]:
        """Energy [J] stored since the start, with what the slab dissipates, and the force (n, d) [N] at its end."""
        return self._force(self.law.law, u, memory)

    def remembered(self, memory: Memory) -> tuple[float, Array, Array | None]:
        """Stored energy [J] and force (n, d) [N] at the time of a memory; nothing is viscous."""
        return *self._force(resting(), memory.displacement, memory), None

    def viscous_force(self, u: Array, memory: Memory, span: float) -> Array | None:
        """None: nothing is viscous."""
        return None

    def tangent(self, u: Array, memory: Memory, span: float) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m], made symmetric."""
        given, d = self._given(u, memory), u.shape[1]
        out = self.cells.entries(d)
        for block in self.cells.blocks:
            self._share(
                fused_past.tangent, block, *given, block.pairs, self.cells.at, self.cells.step, out, moduli=True
            )
        return self.cells.matrix(out, d)

    def secant(self, u: Array, memory: Memory, span: float) -> csc_array:
        """The tangent: nothing is viscous."""
        return self.tangent(u, memory, span)

    def tangent_product(self, u: Array, memory: Memory, span: float, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        given, change = self._given(u, memory), self.cells.rows(w)
        out = np.zeros_like(change)
        for block in self.cells.blocks:
            self._share(fused_past.product, block, *given, change, out, moduli=True)
        return self.cells.folded(out, len(u))

    def tangent_diagonal_blocks(self, u: Array, memory: Memory, span: float) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        given = self._given(u, memory)
        out = np.zeros((*given[0].shape, u.shape[1]))
        for block in self.cells.blocks:
            self._share(fused_past.diagonal, block, *given, out, moduli=True)
        return self.cells.folded(out, len(u))

    def settled(self, u: Array, memory: Memory, span: float) -> Memory:
        """The memory at the end of the slab."""
        rows, step, past = self._given(u, memory)
        after = tuple(np.empty_like(a) for a in past)
        for block in self.cells.blocks:
            kernel = partial(fused_mean.settle, self.mean) if self.mean else fused_past.settle
            self._share(kernel, block, rows, step, past, after)
        law = {name: after[k] for k, name in enumerate(_NAMES, 1) if name in memory.law}
        return Memory(
            displacement=np.array(u),
            stress=after[0],
            law=law,
            lateral=memory.lateral,
            stored=after[3],
            dissipated=after[4],
        )

    def _force(self, law: Stage, u: Array, memory: Memory) -> tuple[float, Array]:
        given = self._given(u, memory)
        energies = [np.zeros(len(block.starts) - 1) for block in self.cells.blocks]
        out = np.zeros_like(given[0])
        for block, energy in zip(self.cells.blocks, energies, strict=True):
            kernel = partial(fused_mean.force, self.mean) if self.mean else fused_past.force
            self._share(kernel, block, *given, out, energy, law=law)
        total = float(np.einsum("p,p->", self.volume, memory.stored)) + float(np.concatenate(energies).sum())
        return total if np.isfinite(total) else np.inf, self.cells.folded(out, len(u))

    def _given(self, u: Array, memory: Memory) -> tuple[Array, Array, tuple[Array, ...]]:
        """Displacement, its change, and the past, for kernels."""
        known = (memory.law.get(name, empty) for name, empty in _NAMES.items())
        past = memory.stress, *known, memory.stored, memory.dissipated
        return self.cells.rows(u), self.cells.rows(u - memory.displacement), tuple(_fixed(a) for a in past)

    def _share(
        self, kernel: Callable[..., None], block: Block, *arrays: Any, moduli: bool = False, law: Stage | None = None
    ) -> None:
        motion, law, numbers = self.law.motion, self.law.law if law is None else law, self.law.numbers(moduli)
        cells = block.rows, block.points, block.table, block.geometry, block.starts

        def task(first: int, last: int) -> None:
            kernel(motion.address, law.address, numbers, *cells, first, last, *arrays)

        block.share(task)


_NAMES = {"plastic_strain": np.empty(0), "back_stress": np.empty((0, 3, 3))}
"""What the compiled laws remember, in the order of the kernels, and that they do not."""


def _fixed(array: NDArray[np.float64]) -> Array:
    """The array as kernels expect it: read-only, without gaps."""
    view = np.ascontiguousarray(array).view()
    view.flags.writeable = False
    return view
