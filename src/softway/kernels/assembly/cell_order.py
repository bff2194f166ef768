"""Order of the cells in the fused kernels: lanes, blocks and parts.

A block is a group of ``LANES`` cells that are computed side by side.  A part is a portion of the body that one thread
computes at a time.  Where parts share a node, the first part writes to the row of the node.  The others write to rows
of their own, which are added afterwards.  The order of summation therefore does not depend on the number of threads.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.lanes import LANES

_POINTS, _PARTS = 4096, 64  # least number of points of a part, greatest number of parts of a body


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Parts:
    """Distribution of the cells e over the blocks b.

    Parameters
    ----------
    starts
        (parts + 1,) first block of each part.
    part
        (e,) part of each cell.
    cell
        (b LANES,) cell in each lane; lanes without a cell hold the number of cells.
    """

    starts: IntArray
    part: IntArray
    cell: IntArray

    def lanes(self, values: NDArray[Any], empty: float) -> NDArray[Any]:
        """Values of the cells (e, ...) arranged as (b, ..., LANES), with ``empty`` in lanes without a cell."""
        rest = np.broadcast_to(np.asarray(empty, values.dtype), (1, *values.shape[1:]))
        filled = np.concatenate([values, rest])[self.cell]
        return np.ascontiguousarray(np.moveaxis(filled.reshape(-1, LANES, *values.shape[1:]), 1, -1))


def parts(nodes: IntArray, centres: Array, points: int) -> Parts:
    """Distribute cells with the nodes (e, a), the centres (e, d) [m] and ``points`` quadrature points each over parts.

    Examples
    --------
    >>> few = parts(np.arange(10)[:, None], np.zeros((10, 3)), 8)
    >>> few.starts.tolist(), few.lanes(np.arange(10), -1)[1].tolist()
    ([0, 2], [8, 9, -1, -1, -1, -1, -1, -1])
    """
    e = len(nodes)
    count = min(_PARTS, max(1, e * points // _POINTS))
    part = _divided(nodes, centres, count)
    order = np.argsort(part, kind="stable")
    cells = np.bincount(part, minlength=count)
    starts = np.concatenate([[0], np.cumsum(-(-cells // LANES))])
    cell = np.full(starts[-1] * LANES, e)
    within = np.arange(e) - np.repeat(np.cumsum(cells) - cells, cells)
    cell[np.repeat(starts[:-1] * LANES, cells) + within] = order
    return Parts(starts=starts, part=part, cell=cell)


def _divided(nodes: IntArray, centres: Array, count: int) -> IntArray:
    """Part (e,) of each cell, by number or by halves along the longest sides, whichever shares fewer nodes."""
    e, labels = len(nodes), int(nodes.max()) + 1
    numbered = np.arange(e) * count // e
    if count == 1:
        return numbered
    return min((numbered, halved(centres, count)), key=lambda part: len(np.unique(part[:, None] * labels + nodes)))


def halved(centres: Array, count: int) -> IntArray:
    """Part (e,) of each of the points (e, d): again and again cut in two across the longest side.

    A part shares nodes with its neighbours only: the shared nodes of p parts of a cube with n nodes are about
    ``p^(1/3) n^(2/3)``, those of slabs ``p n^(2/3)``.

    Examples
    --------
    >>> halved(np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 1.0], [3.0, 1.0]]), 4).tolist()
    [0, 2, 1, 3]
    """
    part = np.zeros(len(centres), int)
    groups = [(np.arange(len(centres)), 0, count)]
    while groups:
        cells, first, parts = groups.pop()
        if parts == 1:
            part[cells] = first
            continue
        along = centres[cells, np.argmax(np.ptp(centres[cells], axis=0))]
        order, few = cells[np.argsort(along, kind="stable")], parts // 2
        cut = len(cells) * few // parts
        groups += [(np.sort(order[:cut]), first, few), (np.sort(order[cut:]), first + few, parts - few)]
    return part


def own_rows(part: IntArray, label: IntArray, again: BoolArray, first: int) -> tuple[IntArray, IntArray]:
    """Rows that no two parts share, and the labels that the extra rows stand for.

    Parameters
    ----------
    part
        (e,) part of each cell.
    label
        (e, ...) rows that the cells write to.
    again
        (e, ...) true where a cell needs a row of its own, as another part writes to the same row.
    first
        Number of the first extra row.

    Examples
    --------
    >>> label = np.array([[0, 1], [1, 2]])
    >>> rows, extra = own_rows(np.array([0, 1]), label, np.array([[False, False], [True, False]]), 3)
    >>> rows.tolist(), extra.tolist()
    ([[0, 1], [3, 2]], [1])
    """
    count = int(label.max()) + 1
    keys = part.reshape(-1, *(1,) * (label.ndim - 1)) * count + label
    found, inverse = np.unique(keys[again], return_inverse=True)
    rows = label.copy()
    rows[again] = first + inverse
    return rows, found % count


def not_first(part: IntArray, label: IntArray) -> BoolArray:
    """True (e, ...) where an earlier part than the part of the cell has the same label.

    Examples
    --------
    >>> not_first(np.array([0, 1]), np.array([[0, 1], [1, 2]])).tolist()
    [[False, False], [True, False]]
    """
    of_cell = np.broadcast_to(part.reshape(-1, *(1,) * (label.ndim - 1)), label.shape)
    earliest = np.full(int(label.max()) + 1, part.max())
    np.minimum.at(earliest, label.ravel(), of_cell.ravel())
    return of_cell != earliest[label]
