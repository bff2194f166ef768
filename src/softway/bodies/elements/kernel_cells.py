"""Elements of a body in the order of the fused kernels."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.quadrature import Cells
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, Section, Volume
from softway.kernels.assembly.assembler import Assembler
from softway.kernels.assembly.cell_order import Parts, not_first, own_rows, parts
from softway.kernels.fused import elastic
from softway.kernels.jit.lanes import LANES
from softway.kernels.jit.threads import share

FUSED_SECTIONS = (Volume, PlaneStrain, Axisymmetric)
Rows = Literal["elastic", "natural", "both"]
"""Geometry of the points: that of :mod:`softway.kernels.fused.elastic`, of :mod:`softway.kernels.fused.inelastic`, or
of :mod:`softway.kernels.fused.mean_elastic`.
"""


def averaged(section: Section) -> int:
    """Number of dimensions that an averaged volume change scales."""
    return 2 if isinstance(section, PlaneStrain) else 3


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Block:
    """Elements of one cell type in the order of the kernels; shapes as in :mod:`softway.kernels.fused.elastic`.

    Parameters
    ----------
    starts
        First block of lanes of each part.
    rows, pairs
        Rows of nodal arrays, and numbers of the pairs of nodes.
    points
        (b, LANES) first point of each element; the number of points in lanes without an element.
    table, geometry
        Data of the quadrature points: in the reference element, and in each element.
    """

    starts: IntArray
    rows: IntArray
    pairs: IntArray
    points: IntArray
    table: Array
    geometry: Array

    def share(self, task: Callable[[int, int], object]) -> None:
        """Call ``task(first, last)`` on ranges that cover all parts, see :mod:`softway.kernels.jit.threads`."""
        share(task, len(self.starts) - 1)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KernelCells:
    """Elements of all cell types, and the tables that sum their forces and tangents.

    Nodes and pairs of nodes that several parts add to have extra rows and extra entries, so that parts can be computed
    in parallel.

    Parameters
    ----------
    blocks
        Elements of each cell type.
    pattern
        Sparsity pattern of the tangent.
    extra
        (h,) node of each extra row of nodal arrays.
    at, step
        First entry and stride of each pair of nodes in the entries of the tangent; extra pairs, and the pair of empty
        lanes, follow.
    extra_places
        (h2 d d,) entry of the tangent to which each extra entry is added.
    """

    blocks: tuple[Block, ...]
    pattern: Assembler
    extra: IntArray
    at: IntArray
    step: IntArray
    extra_places: IntArray

    def rows(self, u: Array) -> Array:
        """Nodal values with the extra rows, and a row of zeros for lanes without an element."""
        n = len(u)
        out = np.empty((n + len(self.extra) + 1, u.shape[1]))
        out[:n] = u
        out[n:-1] = u[self.extra]
        out[-1] = 0.0
        return out

    def folded(self, out: Array, n: int) -> Array:
        """Nodal values, with the extra rows added in a fixed order."""
        if len(self.extra):
            elastic.fold(self.extra, n, out)
        return out[:n]

    def entries(self, d: int) -> Array:
        """Zeros for the entries of a tangent in d dimensions, the extra entries, and the entries of empty lanes."""
        return np.zeros(len(self.pattern.indices) + len(self.extra_places) + d * d)

    def matrix(self, out: Array, d: int) -> csc_array:
        """Tangent (n d, n d) from the :meth:`entries` that the kernels have summed."""
        stored = len(self.pattern.indices)
        np.add.at(out, self.extra_places, out[stored : -d * d])
        return self.pattern.matrix(out[:stored])


def kernel_cells(
    section: Section, kinds: list[Cells], pattern: Assembler, n: int, needed: Rows = "elastic"
) -> KernelCells:
    """Elements of a body with n nodes in the order of the kernels, with the geometry that these need."""
    d = kinds[0].corners.shape[2]
    at, step = pattern.places(d)
    extra, repeated = np.empty(0, np.int64), np.empty(0, np.int64)
    pair_of, numbered = pattern.pair_of(), []
    for cells in kinds:
        it, (e, a) = parts(cells.nodes, cells.corners.mean(axis=1), cells.volume.shape[1]), cells.nodes.shape
        rows, more = own_rows(it.part, cells.nodes, not_first(it.part, cells.nodes), n + len(extra))
        other = rows >= n
        pair, pair_of = pair_of[: e * a * a].reshape(e, a, a), pair_of[e * a * a :]
        pairs, twice = own_rows(it.part, pair, other[:, :, None] & other[:, None, :], len(at) + len(repeated))
        numbered.append((it, rows, pairs))
        extra, repeated = np.concatenate([extra, more]), np.concatenate([repeated, twice])
    entry = step[repeated, None, None] * np.arange(d)[:, None] + np.arange(d)
    beyond = len(pattern.indices) + d * d * np.arange(len(repeated) + 1)
    counts = np.cumsum([0] + [cells.volume.size for cells in kinds])
    empty = n + len(extra), len(at) + len(repeated), int(counts[-1])
    return KernelCells(
        blocks=tuple(
            _block(cells, section, it, (rows, pairs, int(first)), empty, needed)
            for cells, (it, rows, pairs), first in zip(kinds, numbered, counts[:-1], strict=True)
        ),
        pattern=pattern,
        extra=extra,
        at=np.concatenate([at, beyond]),
        step=np.concatenate([step, np.full(len(beyond), d)]),
        extra_places=(at[repeated, None, None] + entry).ravel(),
    )


def _block(
    cells: Cells,
    section: Section,
    it: Parts,
    numbers: tuple[IntArray, IntArray, int],
    empty: tuple[int, int, int],
    needed: Rows,
) -> Block:
    element, (e, q) = cells.element, cells.volume.shape
    table = np.zeros((*element.N.shape, 3))
    table[:, :, : cells.corners.shape[2]] = element.dN
    if isinstance(section, Axisymmetric):
        table[:, :, 2] = element.N
    natural = [_natural(cells, section, it)] if needed != "elastic" else []
    inverse = [_inverse(cells, section, it)] if needed != "natural" else []
    geometry = np.concatenate([*natural, *inverse], axis=2)
    rows, pairs, first = numbers
    return Block(
        starts=it.starts,
        rows=it.lanes(rows.astype(np.uint32), empty[0]),  # unsigned: no wrap-around of negative indices
        pairs=it.lanes(pairs.astype(np.uint32), empty[1]),
        points=it.lanes((first + q * np.arange(e)).astype(np.uint32), empty[2]),
        table=table,
        geometry=_aligned(geometry).reshape(*geometry.shape[:2], -1),
    )


def _aligned(values: Array) -> Array:
    """Copy of an array with rows of lanes aligned to cache lines."""
    room = np.empty(values.size + LANES)
    start = -room.ctypes.data // 8 % LANES
    out = room[start : start + values.size].reshape(values.shape)
    out[:] = values
    return out


def _slopes(cells: Cells, section: Section) -> Array:
    """Jacobian (e, q, 3, 3) of the map from the reference element [m]; out of plane 1, or the radius."""
    element, (e, q), d = cells.element, cells.volume.shape, cells.corners.shape[2]
    out = np.zeros((e, q, 3, 3))
    out[:, :, :d, :d] = np.einsum("ead,qar->eqrd", cells.corners, element.dN)
    if isinstance(section, Axisymmetric):
        out[:, :, 2, 2] = np.einsum("qa,ea->eq", element.N, cells.corners[:, :, 0])
    elif d == 2:
        out[:, :, 2, 2] = 1.0
    return out


def _inverse(cells: Cells, section: Section, it: Parts) -> Array:
    """(b, q, 10, LANES) inverse of :func:`_slopes`, zero out of plane, and the volume of the points."""
    inverse = np.linalg.inv(_slopes(cells, section))
    if isinstance(section, PlaneStrain):
        inverse[:, :, 2, 2] = 0.0
    return it.lanes(np.concatenate([inverse.reshape(*cells.volume.shape, 9), cells.volume[:, :, None]], axis=2), 0.0)


def _natural(cells: Cells, section: Section, it: Parts) -> Array:
    """(b, q, 11, LANES) :func:`_slopes`, the volume divided by their determinant, and the volume of the points."""
    slopes = _slopes(cells, section)
    determinant = np.linalg.det(slopes)
    rows = [
        slopes.reshape(*cells.volume.shape, 9),
        (cells.volume / determinant)[:, :, None],
        cells.volume[:, :, None],
    ]
    out = it.lanes(np.concatenate(rows, axis=2), 0.0)
    none = (it.cell == len(cells.nodes)).reshape(-1, 1, 1, out.shape[-1])
    out[:, :, [0, 4, 8, 9, 10]] += none  # empty lanes are unit cubes
    return out
