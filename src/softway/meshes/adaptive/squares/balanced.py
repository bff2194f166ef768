"""Balanced trees of quadrilaterals and hexahedra: cells cut in all directions at once.

A cell is cut at the middles of its edges and faces into four or eight.  Leaves that share an edge, or a part of one,
differ by one cut at most, so that the parents of hanging nodes do not hang.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.meshes.adaptive.leaves import DEPTH, Leaves, finest, roots
from softway.meshes.adaptive.nodes.middles import Middles
from softway.meshes.adaptive.squares.cut_nodes import CutNodes, middle
from softway.meshes.adaptive.tree_cells import TreeCells, joined
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.mesh import Mesh

BALANCED = ("quad4", "quad8", "quad9", "hex8", "hex20", "hex27")
"""Cells that are cut in all directions at once."""
WHOLE = {2: "bar2", 4: "quad4", 8: "hex8"}
"""Linear cells by their number of corners."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lattice:
    """Points of a cell that is cut, with those in the middle of its edges and faces.

    Parameters
    ----------
    groups
        Corners whose mean each point is, those of faces in order around.
    parts
        Points at the corners of each part.
    """

    groups: tuple[tuple[int, ...], ...]
    parts: tuple[tuple[int, ...], ...]


def lattice(corners: int) -> Lattice:
    """Lattice of a bar, quadrilateral or hexahedron.

    Examples
    --------
    >>> lattice(2)
    Lattice(groups=((0,), (0, 1), (1,)), parts=((0, 1), (1, 2)))
    """
    name = WHOLE[corners]
    own = CELLS[name].nodes.astype(int)
    points = np.stack(np.meshgrid(*[range(3)] * own.shape[1], indexing="ij"), axis=-1).reshape(-1, own.shape[1])
    inside = ((points[:, None] == 1) | (points[:, None] == 2 * own)).all(axis=2)
    around = {tuple(sorted(local)): local for _, local in FACETS[name] if len(local) == 4}
    every = [tuple(np.flatnonzero(row).tolist()) for row in inside]
    number = 3 ** np.arange(own.shape[1])[::-1]
    return Lattice(
        groups=tuple(around.get(group, group) for group in every),
        parts=tuple(tuple(((corner + own) @ number).tolist()) for corner in own),
    )


def cut(cells: TreeCells, nodes: CutNodes) -> tuple[CutNodes, tuple[TreeCells, ...]]:
    """Nodes in the middle of what has been cut, and the four or eight parts of each cell, one in each corner."""
    found = lattice(cells.corners.shape[1])
    columns, places = [], []
    for group in found.groups:
        nodes, column = nodes.of(cells.corners, group)
        columns.append(column)
        places.append(cells.place[:, list(group)].mean(axis=1))
    corner, place = np.stack(columns, axis=1), np.stack(places, axis=1)
    level, parts = cells.level + CELLS[WHOLE[cells.corners.shape[1]]].dim, []
    for k, own in enumerate(found.parts):
        start = cells.start + k * np.left_shift(np.int64(1), DEPTH - level)
        parts.append(replace(cells, corners=corner[:, own], place=place[:, own], start=start, level=level))
    return nodes, tuple(parts)


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
    edges = np.array(CELLS[next(iter(base.blocks))].edges)
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
    between = middle(edges, middles)
    out, chosen = np.zeros(between.shape, dtype=bool), between >= 0
    for end in (0, 1):
        half = np.column_stack([edges[..., end][chosen], between[chosen]])
        out[chosen] |= middle(half, middles) >= 0
    return np.asarray(out.any(axis=1))
