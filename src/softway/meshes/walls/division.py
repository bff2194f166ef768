"""Division of cells at the middles of some of their edges (docs/theory/bodies/mass.md)."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import BoolArray, IntArray
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.meshes.walls.simplices import bisected
from softway.meshes.walls.wall_edges import WALLS, parallel_edges


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Division:
    """Mesh with more nodes, and where they come from.

    Parameters
    ----------
    mesh
        The divided mesh: old nodes first, with their numbers.
    weights
        (n, m) values at its n nodes from those at the m old ones: means of the corners that a new node lies between.
    """

    mesh: Mesh
    weights: sp.csr_array


def divided_at(mesh: Mesh, edges: IntArray) -> Division:
    """Mesh with a node in the middle of some edges (k, 2) between corners of linear cells.

    Quadrilaterals and hexahedra are cut into layers: with an edge all edges opposite to it in a cell get a node, and so
    on through the mesh.  Triangles and tetrahedra are bisected, at their longest edge first.  A new node is in the tags
    that all its corners are in, a new cell in the regions of the old one.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> found = divided_at(rectangle((2.0, 0.5), (2, 1)), np.array([[0, 3]]))
    >>> found.mesh.points[6:].tolist(), found.mesh.n_cells
    ([[0.0, 0.25], [1.0, 0.25], [2.0, 0.25]], 4)
    """
    marked = _with_opposite(mesh, edges)
    lattices = {cell: _lattice(mesh, cell, marked) for cell in mesh.blocks if cell in WALLS and _is_block(cell)}
    keys = _unique_keys([_padded(marked, mesh.dim), *(key for table in lattices.values() for key, _ in table)])
    places = {cell: [(_numbers(key, keys, mesh.n_nodes), mask) for key, mask in t] for cell, t in lattices.items()}
    middle = _numbers(_padded(marked, mesh.dim), keys, mesh.n_nodes)
    length = np.linalg.norm(mesh.points[marked[:, 1]] - mesh.points[marked[:, 0]], axis=1)
    blocks, parents, first = {}, [], 0
    for cell, cells in mesh.blocks.items():
        if cell in places:
            blocks[cell], parent = _pieces(cell, cells, places[cell])
        elif cell in WALLS:
            blocks[cell], parent = bisected(cells, np.array(CELLS[cell].edges), marked, middle, length)
        else:
            blocks[cell], parent = cells, np.arange(len(cells))
        parents.append(parent + first)
        first += len(cells)
    return _division(mesh, blocks, np.concatenate(parents), keys)


def _division(mesh: Mesh, blocks: Mapping[str, IntArray], parent: IntArray, keys: IntArray) -> Division:
    """Divided mesh of new cells with their ``parent``, with new nodes between the corners ``keys`` (k, c)."""
    n, held = mesh.n_nodes, keys >= 0
    row = np.repeat(np.arange(len(keys)), held.sum(axis=1))
    new = sp.csr_array((1.0 / np.repeat(held.sum(axis=1), held.sum(axis=1)), (row, keys[held])), shape=(len(keys), n))
    weights = sp.csr_array(sp.vstack([sp.eye_array(n), new], format="csr"))
    tags = {}
    for name, nodes in mesh.tags.items():
        inside = np.zeros(n, bool)
        inside[nodes] = True
        tags[name] = np.concatenate([nodes, n + np.flatnonzero((inside[keys] | ~held).all(axis=1))])
    regions = {name: np.flatnonzero(np.isin(parent, cells)) for name, cells in mesh.regions.items()}
    points = np.concatenate([mesh.points, new @ mesh.points])
    return Division(mesh=Mesh(points=points, blocks=blocks, tags=tags, regions=regions), weights=weights)


def _is_block(cell: str) -> bool:
    """True for linear quadrilaterals and hexahedra."""
    return not CELLS[cell].simplex


def _with_opposite(mesh: Mesh, edges: IntArray) -> IntArray:
    """The edges (k, 2), and those that are opposite to them in quadrilaterals and hexahedra, and so on."""
    rows = [np.sort(edges, axis=1)]
    links = [np.zeros((0, 2), int)]
    for cell, cells in mesh.blocks.items():
        if cell in WALLS and _is_block(cell):
            for axis in parallel_edges(cell):
                start, own = sum(map(len, rows)), np.sort(cells[:, axis], axis=2)
                number = start + np.arange(own.shape[0] * own.shape[1]).reshape(own.shape[:2])
                links += [number[:, [0, k]] for k in range(1, own.shape[1])]
                rows.append(own.reshape(-1, 2))
    every, number = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    pair = number.ravel()[np.concatenate(links)]
    graph = sp.coo_array((np.ones(len(pair)), (pair[:, 0], pair[:, 1])), shape=(len(every),) * 2)
    label = connected_components(graph, directed=False)[1]
    return every[np.isin(label, label[number.ravel()[: len(edges)]])]


def _lattice(mesh: Mesh, cell: str, marked: IntArray) -> list[tuple[IntArray, tuple[bool, ...]]]:
    """For each set of axes, one item: corners (e, p, c) that the nodes of the divided cells lie between, and the axes.

    Cells that are not divided along these axes have rows of -1.
    """
    cells, n = mesh.blocks[cell], mesh.n_nodes
    codes = marked[:, 0] * n + marked[:, 1]
    cut = []
    for axis in parallel_edges(cell):
        pair = np.sort(cells[:, axis[0]], axis=1)
        cut.append(np.isin(pair[:, 0] * n + pair[:, 1], codes))
    along, out = np.column_stack(cut), []
    for axes in product((False, True), repeat=mesh.dim):
        chosen = (along == np.array(axes)).all(axis=1)
        between = _corners(cell, axes)
        key = np.where(between >= 0, cells[:, between], -1)
        out.append((np.where(chosen[:, None, None], np.sort(key, axis=2)[:, :, ::-1], -1), axes))
    return out


def _places(axes: tuple[bool, ...]) -> list[tuple[float, ...]]:
    """Reference coordinates of the nodes of a cell that is divided along some axes."""
    return list(product(*((0.0, 0.5, 1.0) if cut else (0.0, 1.0) for cut in axes)))


def _corners(cell: str, axes: tuple[bool, ...]) -> IntArray:
    """Local corners (p, c) that each node of a divided cell lies between, filled with -1."""
    nodes, out = CELLS[cell].nodes, []
    for place in _places(axes):
        fixed = np.array(place) != 0.5
        own = np.flatnonzero((nodes[:, fixed] == np.array(place)[fixed]).all(axis=1))
        out.append(np.concatenate([own, np.full(len(nodes) - len(own), -1)]))
    return np.array(out)


def _pieces(cell: str, cells: IntArray, places: list[tuple[IntArray, tuple[bool, ...]]]) -> tuple[IntArray, IntArray]:
    """Cells (f, a) that the old ones are divided into, in their order, and the numbers (f,) of the old ones."""
    out, parent = [], []
    for number, axes in places:
        at, own = _places(axes), np.flatnonzero(number[:, 0] >= 0)
        for start in product(*((0.0, 0.5) if cut else (0.0,) for cut in axes)):
            size = np.where(axes, 0.5, 1.0)
            local = [at.index(tuple(float(v) for v in np.array(start) + size * c)) for c in CELLS[cell].nodes]
            out.append(number[own][:, local])
            parent.append(own)
    order = np.argsort(np.concatenate(parent), kind="stable")
    return np.concatenate(out)[order], np.concatenate(parent)[order]


def _padded(pairs: IntArray, dim: int) -> IntArray:
    """Pairs (k, 2) of corners as keys (k, 1, 2^d): the corners in falling order, filled with -1."""
    key = np.full((len(pairs), 1, 2**dim), -1)
    key[:, 0, :2] = np.sort(pairs, axis=1)[:, ::-1]
    return key


def _unique_keys(keys: list[IntArray]) -> IntArray:
    """Keys (k, c) of new nodes, each once: those with two corners or more."""
    rows = np.concatenate([key.reshape(-1, key.shape[2]) for key in keys])
    return np.asarray(np.unique(rows[rows[:, 1] >= 0], axis=0))


def _numbers(key: IntArray, keys: IntArray, first: int) -> IntArray:
    """Numbers (e, p) of nodes by their keys (e, p, c); those between corners are numbered from ``first``."""
    rows = key.reshape(-1, key.shape[2])
    new: BoolArray = rows[:, 1] >= 0
    out = rows[:, 0].copy()
    both = np.unique(np.concatenate([keys, rows[new]]), axis=0, return_inverse=True)[1].ravel()
    order = np.empty(len(keys), int)
    order[both[: len(keys)]] = np.arange(len(keys))
    out[new] = first + order[both[len(keys) :]]
    return out.reshape(key.shape[:2])
