"""Balanced trees of quadrilaterals and hexahedra: cells cut in all directions at once, with hanging nodes.

A cell is cut at the middles of its edges and faces into four or eight.  Leaves that share an edge, or a part of one,
differ by one cut at most, so that an edge or a face has one hanging node in its middle, whose parents do not hang.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.meshes.adaptive.hanging_nodes import HangingNodes
from softway.meshes.adaptive.leaves import DEPTH, Leaves, finest, roots
from softway.meshes.adaptive.middles import Middles, edge_codes
from softway.meshes.adaptive.tree_cells import TreeCells, joined
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.mesh import Mesh

BALANCED = ("quad4", "hex8")
"""Cells that are cut in all directions at once."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CutNodes:
    """Nodes in the middle of edges and of faces that have been cut.

    Parameters
    ----------
    edges
        Middles of edges.
    faces
        Middles of faces, in the codes of their diagonals.
    count
        Number of nodes so far.
    """

    edges: Middles
    faces: Middles
    count: int

    @classmethod
    def none(cls, count: int) -> "CutNodes":
        """No cuts, in a mesh of ``count`` nodes."""
        return cls(edges=Middles.none(count), faces=Middles.none(count), count=count)

    def of(self, corners: IntArray, group: tuple[int, ...]) -> tuple["CutNodes", IntArray]:
        """Nodes with those in the middle of a ``group`` of the ``corners`` (e, c), and the node (e,) of each cell."""
        if len(group) == 1:
            return self, corners[:, group[0]]
        if len(group) == 2:
            found, node = replace(self.edges, count=self.count).with_middles(corners[:, group])
            return replace(self, edges=found, count=found.count), node
        if len(group) < corners.shape[1]:
            pair = _diagonals(corners[:, group])
            found, node = replace(self.faces, count=self.count).with_middles(pair)
            return replace(self, faces=found, count=found.count), node
        return replace(self, count=self.count + len(corners)), self.count + np.arange(len(corners))


def cut(cells: TreeCells, nodes: CutNodes) -> tuple[CutNodes, tuple[TreeCells, ...]]:
    """Nodes in the middle of what has been cut, and the four or eight parts of each cell, one in each corner."""
    lattice = _lattice(cells.corners.shape[1])
    dim = (cells.corners.shape[1] - 1).bit_length()
    columns, places = [], []
    for group in lattice.groups:
        nodes, column = nodes.of(cells.corners, group)
        columns.append(column)
        places.append(cells.place[:, list(group)].mean(axis=1))
    corner, place = np.stack(columns, axis=1), np.stack(places, axis=1)
    level = cells.level + dim
    parts = []
    for k, own in enumerate(lattice.parts):
        start = cells.start + k * np.left_shift(np.int64(1), DEPTH - level)
        parts.append(replace(cells, corners=corner[:, own], place=place[:, own], start=start, level=level))
    return nodes, tuple(parts)


@dataclass(frozen=True, slots=True, kw_only=True)
class Lattice:
    """Points of a cell that is cut: the corners whose mean each of them is, and the corners of each part."""

    groups: tuple[tuple[int, ...], ...]
    parts: tuple[tuple[int, ...], ...]


def _lattice(corners: int) -> Lattice:
    """Lattice of a square or a cube; the corners of faces of cubes are in order around."""
    name = "quad4" if corners == 4 else "hex8"
    own = CELLS[name].nodes.astype(int)
    around = {tuple(sorted(local)): local for _, local in FACETS[name] if len(local) == 4}
    points = np.stack(np.meshgrid(*[range(3)] * own.shape[1], indexing="ij"), axis=-1).reshape(-1, own.shape[1])
    inside = ((points[:, None] == 1) | (points[:, None] == 2 * own)).all(axis=2)
    every = [tuple(np.flatnonzero(row).tolist()) for row in inside]
    number = 3 ** np.arange(own.shape[1])[::-1]
    return Lattice(
        groups=tuple(around.get(group, group) for group in every),
        parts=tuple(tuple(((corner + own) @ number).tolist()) for corner in own),
    )


def square_cells(mesh: Mesh) -> TreeCells:
    """Cells of a base mesh of quadrilaterals or hexahedra."""
    (name, cells) = next(iter(mesh.blocks.items()))
    count, keys = CELLS[name].corners, roots(len(cells))
    return TreeCells(
        corners=np.array(cells[:, :count]),
        place=np.tile(np.eye(count), (len(cells), 1, 1)),
        apex=np.zeros((len(cells), 2), dtype=np.int64),
        flag=np.zeros(len(cells), dtype=bool),
        start=np.array(keys.start),
        level=np.array(keys.level),
    )


def balanced(base: Mesh, given: Leaves, level: IntArray) -> tuple[TreeCells, CutNodes]:
    """Leaves of the coarsest balanced refinement with at least the levels ``level`` (e,) on the leaves ``given``."""
    name = next(iter(base.blocks))
    edges = np.array(CELLS[name].edges)
    cells, nodes = square_cells(base), CutNodes.none(base.n_nodes)
    while True:
        coarse = finest(cells.leaves, given, level) > cells.level
        coarse |= _too_coarse(cells.corners[:, edges], nodes.edges)
        if not coarse.any():
            return cells, nodes
        nodes, parts = cut(cells.some(coarse), nodes)
        cells = joined(cells.some(~coarse), *parts)


def _too_coarse(edges: IntArray, middles: Middles) -> BoolArray:
    """True (e,) for cells one of whose ``edges`` (e, k, 2) has been cut twice by others."""
    middle = _middle(edges, middles)
    out = np.zeros(middle.shape, dtype=bool)
    chosen = middle >= 0
    for end in (0, 1):
        half = np.column_stack([edges[..., end][chosen], middle[chosen]])
        out[chosen] |= _middle(half, middles) >= 0
    return np.asarray(out.any(axis=1))


def _middle(edges: IntArray, middles: Middles) -> IntArray:
    """Node (...) in the middle of ``edges`` (..., 2); -1 where there is none."""
    if not len(middles.codes):
        return np.full(edges.shape[:-1], -1)
    code = edge_codes(edges)
    at = np.minimum(np.searchsorted(middles.codes, code), len(middles.codes) - 1)
    return np.where(middles.codes[at] == code, middles.nodes[at], -1)


def hanging(name: str, cells: TreeCells, nodes: CutNodes, rows: IntArray) -> HangingNodes | None:
    """Hanging nodes of leaves, by the final nodes ``rows`` (e, c) of the leaves; None without."""
    number = np.zeros(nodes.count, dtype=np.int64)
    number[cells.corners] = rows
    found = [(cells.corners[:, np.array(CELLS[name].edges)].reshape(-1, 2), nodes.edges)]
    if CELLS[name].dim == 3:
        faces = np.array([local for _, local in FACETS[name]])
        found.append((cells.corners[:, faces].reshape(-1, 4), nodes.faces))
    node, parents, width = [], [], 2 if len(found) == 1 else 4
    for corners, middles in found:
        middle = _middle(corners if corners.shape[1] == 2 else _diagonals(corners), middles)
        own, first = np.unique(middle, return_index=True)
        own, first = own[own >= 0], first[own >= 0]
        node.append(number[own])
        padded = np.full((len(own), width), -1)
        padded[:, : corners.shape[1]] = number[corners[first]]
        parents.append(padded)
    every, above = np.concatenate(node), np.concatenate(parents)
    order = np.argsort(every)
    return HangingNodes(node=every[order], parents=above[order]) if len(every) else None


def _diagonals(faces: IntArray) -> IntArray:
    """The diagonal (f, 2) of each face (f, 4) at its corner with the smallest number; corners are in order around."""
    first = faces.argmin(axis=1)[:, None]
    both = np.concatenate([first, (first + 2) % 4], axis=1)
    return np.take_along_axis(faces, both, axis=1)
