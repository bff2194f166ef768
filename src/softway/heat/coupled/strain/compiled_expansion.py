"""Free expansion of the elements of one law by fused kernels, for elements of the dimension of space."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.heat_functions import heat_functions
from softway.bodies.elements.kernel_cells import FUSED_SECTIONS, Block, KernelCells, kernel_cells
from softway.bodies.elements.quadrature import Cells, sampled_cells
from softway.bodies.elements.strain_operator import StrainOperator
from softway.kernels.fused import expansion
from softway.kernels.jit.lanes import LANES


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CompiledExpansion:
    """Energies and forces of free strains in one pass over the elements, with the change of volume of each point.

    Results do not depend on the number of threads, bit by bit.

    Parameters
    ----------
    cells
        Elements in the order of the kernels.
    functions
        (1 or b, q, a LANES) functions of heat at the points of each cell type.
    modulus, small
        Stress of a free strain of one where it is held [Pa], and True for a law of the linear theory.
    """

    cells: KernelCells
    functions: tuple[Array, ...]
    modulus: float
    small: bool

    def held(self, u: Array) -> Array:
        """Energies (k,) that a free strain of one of each node would take at ``u`` (k, d) [J]."""
        rows = self.cells.rows(u)
        out = np.zeros((len(rows), 1))
        self._share(expansion.held, rows, out[:, 0])
        return self.cells.folded(out, len(u))[:, 0]

    def forces(self, u: Array, free: Array) -> Array:
        """Nodal forces (c, k, d) [N] of each of the free strains (c, k) at ``u`` (k, d)."""
        rows = self.cells.rows(u)
        strains = self.cells.rows(np.ascontiguousarray(free.T)).T.copy()
        out = np.zeros((len(free), *rows.shape))
        self._share(expansion.forces, rows, strains, out)
        return np.stack([self.cells.folded(one, len(u)) for one in out])

    def _share(self, kernel: Callable[..., None], *arrays: NDArray[np.float64]) -> None:
        """Call a kernel on all cells."""
        for block, functions in zip(self.cells.blocks, self.functions, strict=True):
            _shared(kernel, block, (self.modulus, self.small, functions), arrays)


def _shared(
    kernel: Callable[..., None], block: Block, law: tuple[float, bool, Array], arrays: tuple[NDArray[np.float64], ...]
) -> None:
    cells = block.rows, block.table, block.geometry, block.starts

    def task(first: int, last: int) -> None:
        kernel(*law, *cells, first, last, *arrays)

    block.share(task)


def compiled_expansion(
    part: DiscreteSolid, sampling: StrainOperator, cells: IntArray, nodes: IntArray, modulus: float, small: bool
) -> CompiledExpansion | None:
    """Kernels for the elements ``cells`` (e,) of a solid on its ``nodes`` (k,); None where there are none for them."""
    section = part.internal.section
    if not isinstance(section, FUSED_SECTIONS) or sampling.dilatation is not None:
        return None
    kinds = _chosen(list(sampled_cells(part.mesh, section, "point", small=False).kinds), cells, nodes)
    found = kernel_cells(section, kinds, sampling.pattern, len(nodes))
    return CompiledExpansion(
        cells=found,
        functions=tuple(_functions(kind, block) for kind, block in zip(kinds, found.blocks, strict=True)),
        modulus=modulus,
        small=small,
    )


def _chosen(kinds: list[Cells], cells: IntArray, nodes: IntArray) -> list[Cells]:
    """Some ``cells`` (e,) of all cell types, with the numbers of their nodes among ``nodes`` (k,)."""
    out, first = [], 0
    for kind in kinds:
        mine = cells[(cells >= first) & (cells < first + len(kind.nodes))] - first
        first += len(kind.nodes)
        if len(mine):
            own = np.searchsorted(nodes, kind.nodes[mine])
            out.append(replace(kind, nodes=own, corners=kind.corners[mine], volume=kind.volume[mine]))
    return out


def _functions(kind: Cells, block: Block) -> Array:
    """Functions (1 or b, q, a LANES) of heat at the points of a cell type, in the order of the kernels."""
    found = heat_functions(kind)
    if (found == found[:1]).all():
        return np.ascontiguousarray(np.repeat(found[:1], LANES, axis=2))
    points = found.shape[1]
    last = len(found) - 1
    element = np.minimum((block.points.astype(np.int64) - block.points.min()) // points, last)
    lanes = np.moveaxis(found[element], 1, -1)  # (b, q, a, LANES)
    return np.ascontiguousarray(lanes.reshape(len(element), points, -1))
