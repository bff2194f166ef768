"""Nodes of the leaves of a balanced tree, and which of them hang."""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from softway.arrays import IntArray
from softway.meshes.adaptive.nodes.leaf_nodes import FirstPlaces, node_places, numbered, shape_functions
from softway.meshes.adaptive.squares.balanced import WHOLE, lattice
from softway.meshes.adaptive.squares.cut_nodes import CutNodes
from softway.meshes.adaptive.tree_cells import TreeCells
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.mesh import Mesh
from softway.meshes.topology import HangingNodes

Scalar = TypeVar("Scalar", bound=np.generic)
Group = tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Divided:
    """Nodes in the middle of edges, faces and cells: of those that have been ``cut``, and with those of second order,
    ``full``.
    """

    cut: CutNodes
    full: CutNodes


def groups(name: str) -> tuple[Group, ...]:
    """Corners around each node of a cell, in the order of its nodes.

    Examples
    --------
    >>> groups("quad8")
    ((0,), (1,), (2,), (3,), (0, 1), (1, 2), (2, 3), (3, 0))
    """
    it = CELLS[name]
    every = (*((k,) for k in range(it.corners)), *it.edges)
    if it.dim == 3:
        every = (*every, *(local for _, local in FACETS[WHOLE[it.corners]]))
    if it.dim > 1:
        every = (*every, tuple(range(it.corners)))
    return every[: len(it.nodes)]


def square_nodes(base: Mesh, cells: TreeCells, cuts: CutNodes) -> tuple[IntArray, FirstPlaces, HangingNodes | None]:
    """Nodes (e, a) of leaves, where the new ones occur first, and the hanging ones; None without.

    Nodes of the base mesh keep their numbers; new ones follow in the order of the leaves.
    """
    name, nodes = next(iter(base.blocks)), cuts
    columns = []
    for group in groups(name):
        nodes, column = nodes.of(cells.corners, group)
        columns.append(column)
    known = _known(base, nodes)
    raw = known[np.stack(columns, axis=1)]
    rows, first = numbered(raw, base.n_nodes)
    number = np.zeros(nodes.count, dtype=np.int64)
    number[raw] = rows
    return rows, first, _hanging(name, cells.corners, Divided(cut=cuts, full=nodes), number[known])


def _known(base: Mesh, nodes: CutNodes) -> IntArray:
    """Node of the base mesh for each node (n,) in the middle of one of its edges, faces or cells; others themselves."""
    name, cells = next(iter(base.blocks.items()))
    known = np.arange(nodes.count)
    for group, column in zip(groups(name), cells.T, strict=True):
        found = nodes.found(cells, group)
        known[found[found >= 0]] = column[found >= 0]
    return known


def _hanging(name: str, corners: IntArray, nodes: Divided, number: IntArray) -> HangingNodes | None:
    """Hanging nodes of leaves with given ``corners`` (e, c), by the final ``number`` (n,) of each node."""
    found = []
    for kind in _kinds(name):
        edge = CELLS[kind].dim == 1
        local = np.array(CELLS[name].edges if edge else [own for _, own in FACETS[WHOLE[corners.shape[1]]]])
        found.append(_on(kind, corners[:, local].reshape(-1, local.shape[1]), nodes))
    node, first = np.unique(np.concatenate([one.node for one in found]), return_index=True)
    if not len(node):
        return None
    width = max(one.parents.shape[1] for one in found)
    parents = np.concatenate([_wide(number[one.parents], width, -1) for one in found])[first]
    weights = np.concatenate([_wide(one.weights, width, 0.0) for one in found])[first]
    order = np.argsort(number[node])
    return HangingNodes(
        node=number[node][order], parents=parents[order], weights=weights[order], inner=number[found[-1].inner]
    )


def _kinds(name: str) -> tuple[str, ...]:
    """Edges of a cell, and faces in space; facets last."""
    facet = FACETS[name][0][0]
    return (facet,) if CELLS[name].dim == 2 else (FACETS[facet][0][0], facet)


def _on(kind: str, every: IntArray, nodes: Divided) -> HangingNodes:
    """Nodes that hang on some of the edges or faces (f, c) of leaves, in the numbers before the final ones; some occur
    more than once.
    """
    corners = every.shape[1]
    form, own = lattice(corners), groups(kind)
    whole = every[nodes.cut.found(every, tuple(range(corners))) >= 0]
    points = np.stack([nodes.full.found(whole, group) for group in form.groups], axis=1)
    means = np.array([np.eye(corners)[list(group)].mean(axis=0) for group in form.groups])
    parents = np.stack([nodes.full.found(whole, group) for group in own], axis=1)
    node, weights = [], []
    for part in form.parts:
        for group, shape in zip(own, shape_functions(kind, node_places(kind, means[list(part)])), strict=True):
            if shape.max() != 1.0:  # exact: a node of the larger cell
                node.append(nodes.full.found(points[:, part], group))
                weights.append(shape)
    count, most = len(whole), len(node)
    inner = np.concatenate([whole, *(points[:, part] for part in form.parts)])
    return HangingNodes(
        node=np.concatenate(node),
        parents=np.tile(parents, (most, 1)),
        weights=np.repeat(np.array(weights), count, axis=0),
        inner=inner,
    )


def _wide(table: NDArray[Scalar], width: int, fill: float) -> NDArray[Scalar]:
    """Table (k, width) with more columns."""
    return np.pad(table, ((0, 0), (0, width - table.shape[1])), constant_values=fill)
