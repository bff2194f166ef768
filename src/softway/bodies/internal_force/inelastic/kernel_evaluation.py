"""Internal force of path-dependent laws by fused kernels, for elements of the dimension of space."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from softway.arrays import Array
from softway.bodies.elements.kernel_cells import Block, KernelCells
from softway.bodies.internal_force.material_state import MaterialState
from softway.kernels.fused import inelastic, mean_dilatation, mean_tangent
from softway.kernels.jit.compilation import Stage
from softway.laws.kernel_laws import CompiledRateLaw, resting


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RateKernelEvaluation:
    """Evaluation of a slab in one pass over the elements; results do not depend on the number of threads, bit by bit.

    The slab starts from the material state ``state`` and ends at the displacement u (n, d) [m].  The state keeps its
    arrays in the order of the points: a pass reads them once, and arrays in the order of the kernels would have to be
    rebuilt for every slab.

    Parameters
    ----------
    law
        Compiled stages of the law.
    cells
        Elements in the order of the kernels.
    volume
        (p,) reference volume of each point [m^3].
    mean
        Number of dimensions of the mean dilatation of an element; 0 for the dilatation of each point.
    """

    law: CompiledRateLaw
    cells: KernelCells
    volume: Array
    mean: int = 0

    def energy_and_force(self, u: Array, state: MaterialState, span: float) -> tuple[float, Array]:
        """Stored energy plus the energy dissipated in the slab [J], and the force (n, d) [N] at the end of the slab."""
        return self._force(self.law.law, u, state)

    def stored_force(self, state: MaterialState) -> tuple[float, Array, Array | None]:
        """Stored energy [J] and force (n, d) [N] of a committed state; None for the viscous part."""
        return *self._force(resting(), state.displacement, state), None

    def end_force(self, u: Array, state: MaterialState, span: float) -> tuple[float, Array, Array | None]:
        """:meth:`energy_and_force`, and None: the law has no viscosity."""
        return *self.energy_and_force(u, state, span), None

    def tangent(self, u: Array, state: MaterialState, span: float) -> csc_array:
        """Derivative of the force, made symmetric, (n d, n d) [N/m]."""
        given, d = self._given(u, state), u.shape[1]
        out = self.cells.entries(d)
        for block in self.cells.blocks:
            kernel = partial(mean_tangent.tangent, self.mean) if self.mean else inelastic.tangent
            self._share(kernel, block, *given, block.pairs, self.cells.at, self.cells.step, out, moduli=True)
        return self.cells.matrix(out, d)

    def secant(self, u: Array, state: MaterialState, span: float) -> csc_array:
        """:meth:`tangent` (n d, n d) [N/m]: the law has no viscosity."""
        return self.tangent(u, state, span)

    def tangent_product(self, u: Array, state: MaterialState, span: float, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        given, change = self._given(u, state), self.cells.rows(w)
        out = np.zeros_like(change)
        for block in self.cells.blocks:
            kernel = partial(mean_tangent.product, self.mean) if self.mean else inelastic.product
            self._share(kernel, block, *given, change, out, moduli=True)
        return self.cells.folded(out, len(u))

    def tangent_diagonal_blocks(self, u: Array, state: MaterialState, span: float) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        given = self._given(u, state)
        out = np.zeros((*given[0].shape, u.shape[1]))
        for block in self.cells.blocks:
            kernel = partial(mean_tangent.diagonal, self.mean) if self.mean else inelastic.diagonal
            self._share(kernel, block, *given, out, moduli=True)
        return self.cells.folded(out, len(u))

    def committed(self, u: Array, state: MaterialState, span: float) -> MaterialState:
        """Material state at the end of the slab."""
        rows, step, past = self._given(u, state)
        after = tuple(np.empty_like(a) for a in past)
        for block in self.cells.blocks:
            kernel = partial(mean_dilatation.settle, self.mean) if self.mean else inelastic.settle
            self._share(kernel, block, rows, step, past, after)
        law = {name: after[k] for k, name in enumerate(_NAMES, 1) if name in state.law}
        return MaterialState(
            displacement=np.array(u),
            stress=after[0],
            law=law,
            lateral=state.lateral,
            stored=after[3],
            dissipated=after[4],
        )

    def _force(self, law: Stage, u: Array, state: MaterialState) -> tuple[float, Array]:
        given = self._given(u, state)
        energies = [np.zeros(len(block.starts) - 1) for block in self.cells.blocks]
        out = np.zeros_like(given[0])
        for block, energy in zip(self.cells.blocks, energies, strict=True):
            kernel = partial(mean_dilatation.force, self.mean) if self.mean else inelastic.force
            self._share(kernel, block, *given, out, energy, law=law)
        total = float(np.einsum("p,p->", self.volume, state.stored)) + float(np.concatenate(energies).sum())
        return total if np.isfinite(total) else np.inf, self.cells.folded(out, len(u))

    def _given(self, u: Array, state: MaterialState) -> tuple[Array, Array, tuple[Array, ...]]:
        """Displacement, its change in the slab, and the history variables, for kernels."""
        history = (state.law.get(name, empty) for name, empty in _NAMES.items())
        past = state.stress, *history, state.stored, state.dissipated
        return self.cells.rows(u), self.cells.rows(u - state.displacement), tuple(_fixed(a) for a in past)

    def _share(
        self, kernel: Callable[..., None], block: Block, *arrays: Any, moduli: bool = False, law: Stage | None = None
    ) -> None:
        motion, law, numbers = self.law.motion, self.law.law if law is None else law, self.law.numbers(moduli)
        cells = block.rows, block.points, block.table, block.geometry, block.starts

        def task(first: int, last: int) -> None:
            kernel(motion.address, law.address, numbers, *cells, first, last, *arrays)

        block.share(task)


_NAMES = {"plastic_strain": np.empty(0), "back_stress": np.empty((0, 3, 3))}
"""History variables of the compiled laws, in the order of the kernels, and empty arrays for laws without them."""


def _fixed(array: NDArray[np.float64]) -> Array:
    """Array as kernels expect it: read-only and contiguous."""
    view = np.ascontiguousarray(array).view()
    view.flags.writeable = False
    return view
