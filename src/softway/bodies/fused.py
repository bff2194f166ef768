"""Internal force by fused kernels, for the laws that have compiled stages and cells that fill their space."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.cells import Cells
from softway.bodies.section import Axisymmetric, PlaneStrain, Section, Volume
from softway.kernels import fused
from softway.kernels.gather import Assembler
from softway.kernels.parts import Parts, not_first, own_rows, parts
from softway.kernels.threads import share
from softway.laws.compiled import CompiledLaw
from softway.typing import Array, IntArray

FUSED_SECTIONS = (Volume, PlaneStrain, Axisymmetric)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Block:
    """Cells of one kind, in the order of the kernels; shapes as in :mod:`softway.kernels.fused`.

    Parameters
    ----------
    starts
        First block of lanes of each part.
    rows, pairs
        Rows of nodal arrays, and numbers of the pairs of nodes.
    table, geometry
        What the quadrature points know of the reference cell, and of each cell.
    """

    starts: IntArray
    rows: IntArray
    pairs: IntArray
    table: Array
    geometry: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fused:
    """Energy, force and tangent in one pass over the cells; the same bits for every number of threads.

    Parameters
    ----------
    law
        Stages of the material.
    blocks
        Cells, kind by kind.
    pattern
        Sparsity of the tangent.
    extra
        (h,) node of each row of nodal arrays beyond the nodes, where a part sums what another part sums too.
    at, step
        Places of the pairs of nodes among the entries of the tangent, then of the extra pairs, then of none.
    extra_places
        (h2 d d,) the entry of the tangent for each of the extra entries.
    """

    law: CompiledLaw
    blocks: tuple[Block, ...]
    pattern: Assembler
    extra: IntArray
    at: IntArray
    step: IntArray
    extra_places: IntArray

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative to the displacement, (n, d) [N]."""
        energies = [np.zeros(len(block.starts) - 1) for block in self.blocks]
        rows, out = self._rows(u), self._zeros(u)
        for block, energy in zip(self.blocks, energies, strict=True):
            self._share(fused.force, block, rows, out, energy)
        return float(np.concatenate(energies).sum()), self._folded(out, len(u))

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        rows, d = self._rows(u), u.shape[1]
        stored = len(self.pattern.indices)
        out = np.zeros(stored + len(self.extra_places) + d * d)
        for block in self.blocks:
            self._share(fused.tangent, block, rows, block.pairs, self.at, self.step, out)
        np.add.at(out, self.extra_places, out[stored : -d * d])
        return self.pattern.matrix(out[:stored])

    def tangent_product(self, u: Array, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        rows, change, out = self._rows(u), self._rows(w), self._zeros(u)
        for block in self.blocks:
            self._share(fused.product, block, rows, change, out)
        return self._folded(out, len(u))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        rows, d = self._rows(u), u.shape[1]
        out = np.zeros((*rows.shape, d))
        for block in self.blocks:
            self._share(fused.diagonal, block, rows, out)
        return self._folded(out, len(u))

    def _share(self, kernel: Callable[..., None], block: Block, *arrays: Array | IntArray) -> None:
        law = self.law
        cells = block.rows, block.table, block.geometry, block.starts

        def task(first: int, last: int) -> None:
            kernel(law.measure.address, law.law.address, law.moduli, *cells, first, last, *arrays)

        share(task, len(block.starts) - 1)

    def _rows(self, u: Array) -> Array:
        """Nodal values with the extra rows, and a row of zeros for lanes without a cell."""
        n = len(u)
        out = np.empty((n + len(self.extra) + 1, u.shape[1]))
        out[:n] = u
        out[n:-1] = u[self.extra]
        out[-1] = 0.0
        return out

    def _zeros(self, u: Array) -> Array:
        return np.zeros((len(u) + len(self.extra) + 1, u.shape[1]))

    def _folded(self, out: Array, n: int) -> Array:
        """The nodal values, with the extra rows added in their order."""
        if len(self.extra):
            fused.fold(self.extra, n, out)
        return out[:n]


def fused_force(law: CompiledLaw, section: Section, kinds: list[Cells], pattern: Assembler, n: int) -> Fused:
    """The :class:`Fused` form of the internal force of a body on n nodes."""
    d = kinds[0].corners.shape[2]
    at, step = pattern.places(d)
    extra, again = np.empty(0, np.int64), np.empty(0, np.int64)
    pair_of, numbered = pattern.pair_of(), []
    for cells in kinds:
        it, (e, a) = parts(cells.nodes, cells.corners.mean(axis=1), cells.volume.shape[1]), cells.nodes.shape
        rows, more = own_rows(it.part, cells.nodes, not_first(it.part, cells.nodes), n + len(extra))
        other = rows >= n
        pair, pair_of = pair_of[: e * a * a].reshape(e, a, a), pair_of[e * a * a :]
        pairs, twice = own_rows(it.part, pair, other[:, :, None] & other[:, None, :], len(at) + len(again))
        numbered.append((it, rows, pairs))
        extra, again = np.concatenate([extra, more]), np.concatenate([again, twice])
    entry = step[again, None, None] * np.arange(d)[:, None] + np.arange(d)
    beyond = len(pattern.indices) + d * d * np.arange(len(again) + 1)
    return Fused(
        law=law,
        blocks=tuple(
            _block(cells, section, it, rows, pairs, (n + len(extra), len(at) + len(again)))
            for cells, (it, rows, pairs) in zip(kinds, numbered, strict=True)
        ),
        pattern=pattern,
        extra=extra,
        at=np.concatenate([at, beyond]),
        step=np.concatenate([step, np.full(len(beyond), d)]),
        extra_places=(at[again, None, None] + entry).ravel(),
    )


def _block(cells: Cells, section: Section, it: Parts, rows: IntArray, pairs: IntArray, empty: tuple[int, int]) -> Block:
    element, (e, q) = cells.element, cells.volume.shape
    d = cells.corners.shape[2]
    table = np.zeros((*element.N.shape, 3))
    table[:, :, :d] = element.dN
    inverse = np.zeros((e, q, 3, 3))
    inverse[:, :, :d, :d] = np.linalg.inv(np.einsum("ead,qar->eqrd", cells.corners, element.dN))
    if isinstance(section, Axisymmetric):
        table[:, :, 2] = element.N
        inverse[:, :, 2, 2] = 1.0 / np.einsum("qa,ea->eq", element.N, cells.corners[:, :, 0])
    geometry = it.lanes(np.concatenate([inverse.reshape(e, q, 9), cells.volume[:, :, None]], axis=2), 0.0)
    return Block(
        starts=it.starts,
        rows=it.lanes(rows.astype(np.uint32), empty[0]),  # unsigned: kernels need not ask whether to count from the end
        pairs=it.lanes(pairs.astype(np.uint32), empty[1]),
        table=table,
        geometry=geometry.reshape(*geometry.shape[:2], -1),
    )
