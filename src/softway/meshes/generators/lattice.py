"""Blocks of cells on integer lattices: squares and cubes, simplices, quadratic cells.

A lattice point is a row of integers. Cells are made from the nodes of their reference cell, so that one routine serves
every dimension and order. Points shared by several blocks are merged exactly.
"""

from collections.abc import Callable
from decimal import Decimal
from itertools import permutations
from math import prod

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS

SIMPLEX = {1: ("bar2", "bar3"), 2: ("tri3", "tri6"), 3: ("tet4", "tet10")}
"""Dimension -> names of the linear and the quadratic simplex."""
MOST = 20_000_000
"""Greatest number of cells of a mesh."""


def require_few(*cells: int) -> None:
    """Raise an error if a mesh would have more than ``MOST`` cells.

    Examples
    --------
    >>> require_few(100_000, 100_000)
    Traceback (most recent call last):
    softway.errors.InputError: cells: 1e+10 cells are more than 2e+07
      try: fewer cells
    """
    total = prod(cells)
    if total > MOST:
        raise InputError("cells", f"{Decimal(total):.0e} cells are more than {MOST:.0e}", "fewer cells")


def corners_of(shape: tuple[int, ...]) -> IntArray:
    """Lowest lattice points (e, d) of the cells of a grid of ``shape`` cells.

    Examples
    --------
    >>> corners_of((2, 1)).tolist()
    [[0, 0], [1, 0]]
    """
    grid = np.indices(shape[::-1]).reshape(len(shape), -1)
    return np.ascontiguousarray(grid[::-1].T).astype(np.int64)


def tensor_cells(shape: tuple[int, ...], cell: str) -> IntArray:
    """Lattice points (e, a, d) of a grid of bars, squares or cubes; a cell of order p is p lattice steps wide.

    Examples
    --------
    >>> tensor_cells((2,), "bar3")[..., 0].tolist()
    [[0, 2, 1], [2, 4, 3]]
    """
    order = CELLS[cell].order
    local = np.rint(CELLS[cell].nodes * order).astype(np.int64)
    return order * corners_of(shape)[:, None, :] + local[None, :, :]


def kuhn_cells(shape: tuple[int, ...], mirrored: Callable[[IntArray], IntArray]) -> IntArray:
    """Lattice points (e, d+1, d) of a grid split into simplices.

    Each cell is split into d! simplices, along the paths from one corner to the opposite one. ``mirrored`` maps the
    lowest points (e, d) of the cells to (e, d) zeros and ones, with ones for the axes along which the split of a cell
    is reflected. Neighbouring cells split their common facet in the same way if they differ at most in the reflection
    across it.

    Reference: Freudenthal, Ann. of Math. 43 (1942) 580; Kuhn, IBM J. Res. Dev. 4 (1960) 518.

    Examples
    --------
    >>> kuhn_cells((1, 1), lambda low: 0 * low).tolist()
    [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]]
    """
    d = len(shape)
    low = corners_of(shape)
    flip = mirrored(low)
    parts = []
    for path in permutations(range(d)):
        steps = np.vstack([np.zeros(d, dtype=np.int64), np.cumsum(np.eye(d, dtype=np.int64)[list(path)], axis=0)])
        local = np.where(flip[:, None, :] == 1, 1 - steps, steps)
        parts.append(low[:, None, :] + local)
    cells = np.stack(parts, axis=1).reshape(-1, d + 1, d)
    return upright(cells.astype(float), cells)


def upright(corners: Array, cells: IntArray) -> IntArray:
    """Simplices (e, d+1, ...) with the last two nodes exchanged where the volume of the corners is negative."""
    negative = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0.0
    turned = cells.copy()
    turned[negative, -1], turned[negative, -2] = cells[negative, -2], cells[negative, -1]
    return turned


def merged(cells: IntArray) -> tuple[IntArray, IntArray]:
    """Distinct lattice points (n, k) of ``cells`` (e, a, k), and the node numbers (e, a).

    The points are sorted by the last coordinate, then by the one before it, and so on.

    Examples
    --------
    >>> lattice, nodes = merged(tensor_cells((2,), "bar2"))
    >>> lattice[:, 0].tolist(), nodes.tolist()
    ([0, 1, 2], [[0, 1], [1, 2]])
    """
    flat = cells.reshape(-1, cells.shape[-1])[:, ::-1]
    lattice, inverse = np.unique(flat, axis=0, return_inverse=True)
    return np.ascontiguousarray(lattice[:, ::-1]), inverse.reshape(cells.shape[:2])


def quadratic_simplices(points: Array, cells: IntArray) -> tuple[Array, IntArray, IntArray]:
    """Straight quadratic simplices from linear ones (e, d+1).

    Returns
    -------
    points, cells, parents
        (n, d) corners, then the midpoints of the edges; (e, a) cells; (m, 2) ends of the edge of each midpoint.
    """
    linear, quadratic = SIMPLEX[cells.shape[1] - 1]
    edges = np.sort(cells[:, np.array(CELLS[linear].edges)], axis=2)
    parents, inverse = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
    middles = len(points) + inverse.reshape(len(cells), -1)
    assert len(CELLS[quadratic].nodes) == cells.shape[1] + middles.shape[1]
    return np.vstack([points, points[parents].mean(axis=1)]), np.hstack([cells, middles]), parents


def boundary_edges(cells: IntArray, parents: IntArray, rim: IntArray) -> IntArray:
    """Numbers of the edges ``parents`` (m, 2) on facets of the linear simplices ``cells`` with all nodes in ``rim``."""
    name = SIMPLEX[cells.shape[1] - 1][0]
    on_rim = np.isin(cells, rim)
    pairs = []
    for facet, local in FACETS[name]:
        whole = cells[on_rim[:, local].all(axis=1)][:, local]
        pairs += [np.sort(whole[:, edge], axis=1) for edge in CELLS[facet].edges]
    top = int(cells.max()) + 1
    found = np.concatenate([pair[:, 0] * top + pair[:, 1] for pair in pairs])
    return np.flatnonzero(np.isin(parents[:, 0] * top + parents[:, 1], found))
