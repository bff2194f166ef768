"""Means of the change of volume: over each cell, or around the corners of the cells."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from softway.bodies.dilatation import Varied, both
from softway.kernels.gather import Assembler
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CellMean:
    """One theta for all the points of a cell; points of a cell follow each other.

    ``starts`` (e,) first point of each cell, ``cell`` (p,) the cell of each point, ``volume`` (p,).
    """

    starts: IntArray
    cell: IntArray
    volume: Array

    def mean(self, values: Array) -> Array:
        """Means (p,) over the cells."""
        total = np.add.reduceat(self.volume * values, self.starts) / np.add.reduceat(self.volume, self.starts)
        return np.asarray(total[self.cell])

    def matrix(self, pattern: Assembler, varied: Varied) -> csc_array:
        """Sum of the cells: theta of a cell varies with its own nodes alone."""
        out, start = [], 0
        for block in varied.blocks():
            e, q = block.cells[:2]
            V, theta = (x[start : start + e * q] for x in (self.volume, varied.ratios[1]))
            x = block.slope.shape[1]
            change = (V[:, None] * block.slope).reshape(e, q, x).sum(axis=1)
            change /= (V * theta).reshape(e, q).sum(axis=1)[:, None]
            mixed, twice = block.mixed.reshape(e, q, x).sum(axis=1), block.twice.reshape(e, q).sum(axis=1)
            stiff = block.local.reshape(e, q, x, x).sum(axis=1) + both(mixed, change)
            stiff += twice[:, None, None] * change[:, :, None] * change[:, None, :]
            out.append(block.shaped(stiff))
            start += e * q
        return pattern.assemble(out)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CornerMean:
    """Means around the corners, linear in between.

    Parameters
    ----------
    volume
        (p,) reference volume of each point [m^3].
    spread
        (p, c) linear shape functions of the corners at the points.
    around
        (c,) reciprocal volume of each corner [1/m^3].
    columns
        Components (p, x) of the nodes of the cell of each point, kind by kind.
    size
        Number of components of the body.
    keys
        Ordered numbers ``column * size + row`` of the entries of the tangent.
    """

    volume: Array
    spread: csr_array
    around: Array
    columns: tuple[IntArray, ...]
    size: int
    keys: IntArray

    def mean(self, values: Array) -> Array:
        """The smoothed values (p,)."""
        return np.asarray(self.spread @ (self.around * (self.spread.T @ (self.volume * values))))

    def matrix(self, pattern: Assembler, varied: Varied) -> csc_array:
        """The cells alone, and what theta couples beyond them."""
        blocks = varied.blocks()
        local = pattern.assemble([b.shaped(_summed(b.local, b.cells)) for b in blocks])
        slope, mixed = (self.sparse([getattr(b, name) for b in blocks]) for name in ("slope", "mixed"))
        twice = np.concatenate([b.twice for b in blocks])
        theta = varied.ratios[1]
        smooth = self.spread.T @ (self.volume[:, None] * slope)
        change = (1.0 / theta)[:, None] * (self.spread @ (self.around[:, None] * smooth))
        wide = mixed.T @ change
        return self.on_pattern([local, wide, wide.T, change.T @ (twice[:, None] * change)])

    def sparse(self, rows: list[Array]) -> csr_array:
        """Rows (p, size) of the values (p, x) on the components of the cells."""
        width = [np.full(len(r), r.shape[1]) for r in rows]
        indptr = np.concatenate([[0], np.cumsum(np.concatenate(width))])
        data = np.concatenate([r.ravel() for r in rows])
        columns = np.concatenate([c.ravel() for c in self.columns])
        return csr_array((data, columns, indptr), shape=(len(indptr) - 1, self.size))

    def on_pattern(self, matrices: list[csc_array]) -> csc_array:
        """Sum of matrices (size, size) with the entries of the tangent, zeros among them."""
        data = np.zeros(len(self.keys))
        for matrix in matrices:
            coo = matrix.tocoo()
            at = np.searchsorted(self.keys, coo.coords[1].astype(np.int64) * self.size + coo.coords[0])
            data += np.bincount(at, weights=coo.data, minlength=len(data))
        column, row = np.divmod(self.keys, self.size)
        indptr = np.searchsorted(column, np.arange(self.size + 1)).astype(np.int32)
        return csc_array((data, row.astype(np.int32), indptr), shape=(self.size, self.size))


def cell_mean(rows: tuple[Array, ...], volume: Array) -> CellMean:
    """The :class:`CellMean` of cells with the sampling ``rows`` (e, q, a, k)."""
    points = np.concatenate([np.full(len(G), G.shape[1]) for G in rows])
    cell = np.repeat(np.arange(len(points)), points)
    return CellMean(starts=np.cumsum(points) - points, cell=cell, volume=volume)


def corner_mean(cells: list[IntArray], corners: list[Array], volume: Array, nodes: int, components: int) -> CornerMean:
    """The :class:`CornerMean` of cells (e, a), kind by kind, with ``corners`` (q, c) shape functions of their corners.

    Parameters
    ----------
    cells
        (e, a) node numbers, corners first.
    corners
        (q, c) linear shape functions of the corners at the points.
    volume
        (p,) of the points [m^3].
    nodes, components
        Number of nodes, and of components of the displacement.
    """
    parts, columns = [], []
    for own, N in zip(cells, corners, strict=True):
        (e, a), (q, c) = own.shape, N.shape
        index = np.repeat(own[:, :c], q, axis=0)
        data = np.tile(N, (e, 1))
        parts.append(csr_array((data.ravel(), index.ravel(), np.arange(0, data.size + 1, c)), shape=(e * q, nodes)))
        wide = (own[:, :, None] * components + np.arange(components)).reshape(e, a * components)
        columns.append(np.repeat(wide, q, axis=0))
    spread = csr_array(vstack(parts, format="csr"))
    weight = spread.T @ volume
    size = nodes * components
    rows = [np.ones(c.shape) for c in columns]
    made = CornerMean(
        volume=volume,
        spread=spread,
        around=np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), 0.0),
        columns=tuple(columns),
        size=size,
        keys=np.zeros(0, np.int64),
    )
    wide = spread @ (spread.T @ made.sparse(rows))
    coupled = (wide.T @ wide).tocoo()
    keys = np.unique(coupled.coords[1].astype(np.int64) * size + coupled.coords[0])
    return replace(made, keys=keys)


def _summed(local: Array, cells: tuple[int, ...]) -> Array:
    """Cell matrices (e, x, x) of those of the points (p, x, x)."""
    return np.asarray(local.reshape(cells[0], cells[1], *local.shape[1:]).sum(axis=1))
