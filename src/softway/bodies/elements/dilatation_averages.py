"""Averages of the volume change: over each element, or around the corner nodes of the elements."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from softway.arrays import Array, IntArray
from softway.bodies.elements.mean_dilatation import Varied, both
from softway.kernels.assembly.assembler import Assembler


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CellMean:
    """Average over each element; the points of an element are consecutive.

    Parameters
    ----------
    starts
        (e,) first point of each element.
    cell
        (p,) element of each point.
    volume
        (p,) reference volume of each point [m^3].
    """

    starts: IntArray
    cell: IntArray
    volume: Array

    def mean(self, values: Array) -> Array:
        """Averages (p,) over the element of each point."""
        total = np.add.reduceat(self.volume * values, self.starts) / np.add.reduceat(self.volume, self.starts)
        return np.asarray(total[self.cell])

    def matrix(self, pattern: Assembler, varied: Varied) -> csc_array:
        """Second derivative (n d, n d) of the energy; theta of an element depends on its own nodes alone."""
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
    """Averages around the corner nodes, interpolated linearly.

    Parameters
    ----------
    volume
        (p,) reference volume of each point [m^3].
    spread
        (p, c) linear shape functions of the corner nodes at the points.
    around
        (c,) reciprocal volume around each corner node [1/m^3].
    columns
        Components (p, x) of the nodes of the element of each point, for each cell type.
    size
        Number of displacement components of the body.
    keys
        Sorted numbers ``column * size + row`` of the entries of the tangent.
    """

    volume: Array
    spread: csr_array
    around: Array
    columns: tuple[IntArray, ...]
    size: int
    keys: IntArray

    def mean(self, values: Array) -> Array:
        """Averages (p,) at the points."""
        return np.asarray(self.spread @ (self.around * (self.spread.T @ (self.volume * values))))

    def matrix(self, pattern: Assembler, varied: Varied) -> csc_array:
        """Second derivative (n d, n d) of the energy: element matrices, and the coupling of elements by theta."""
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
        """Sparse rows (p, size) with the values (p, x) at the components of the elements, for each cell type."""
        width = [np.full(len(r), r.shape[1]) for r in rows]
        indptr = np.concatenate([[0], np.cumsum(np.concatenate(width))])
        data = np.concatenate([r.ravel() for r in rows])
        columns = np.concatenate([c.ravel() for c in self.columns])
        return csr_array((data, columns, indptr), shape=(len(indptr) - 1, self.size))

    def on_pattern(self, matrices: list[csc_array]) -> csc_array:
        """Sum of matrices (size, size) on the pattern of the tangent, with explicit zeros."""
        data = np.zeros(len(self.keys))
        for matrix in matrices:
            coo = matrix.tocoo()
            at = np.searchsorted(self.keys, coo.coords[1].astype(np.int64) * self.size + coo.coords[0])
            data += np.bincount(at, weights=coo.data, minlength=len(data))
        column, row = np.divmod(self.keys, self.size)
        indptr = np.searchsorted(column, np.arange(self.size + 1)).astype(np.int32)
        return csc_array((data, row.astype(np.int32), indptr), shape=(self.size, self.size))


def cell_mean(rows: tuple[Array, ...], volume: Array) -> CellMean:
    """Build the :class:`CellMean` of elements with the rows (e, q, a, k) of the strain operator."""
    points = np.concatenate([np.full(len(G), G.shape[1]) for G in rows])
    cell = np.repeat(np.arange(len(points)), points)
    return CellMean(starts=np.cumsum(points) - points, cell=cell, volume=volume)


def corner_mean(cells: list[IntArray], corners: list[Array], volume: Array, nodes: int, components: int) -> CornerMean:
    """Build the :class:`CornerMean` of elements.

    Parameters
    ----------
    cells
        (e, a) node numbers of each cell type, corner nodes first.
    corners
        (q, c) linear shape functions of the corners at the points of each cell type.
    volume
        (p,) reference volume of each point [m^3].
    nodes, components
        Number n of nodes, and number d of displacement components of a node.
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
    """Element matrices (e, x, x) from the matrices (p, x, x) of the points."""
    return np.asarray(local.reshape(cells[0], cells[1], *local.shape[1:]).sum(axis=1))
