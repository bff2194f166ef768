"""Cells of a tree of bisections, and the labels of the cells of a base mesh.

A cell has its refinement edge between its corners 0 and 1.  Bars are halved; the triangle (a, b, c) with its newest
corner c has the children (c, a, m) and (b, c, m) with the middle m of its refinement edge; tetrahedra are those of
Arnold, Mukherjee and Pouly, SIAM J. Sci. Comput. 22 (2000) 431, which need no special base mesh
(:mod:`softway.kernels.geometry.bisection`).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.leaves import Leaves, roots
from softway.meshes.cells import CELLS, linear
from softway.meshes.mesh import Mesh

TIE = 1e-9
"""Relative difference below which lengths of edges are taken as equal."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TreeCells:
    """Cells of a tree of bisections, of c corners.

    Parameters
    ----------
    corners
        (e, c) nodes, the refinement edge first.
    place
        (e, c, c) barycentric coordinates of the corners in the base cell, multiples of powers of two.
    apex
        (e, 2) for tetrahedra: the corner off the marked edge of the faces opposite to corners 0 and 1; else zeros.
    flag
        (e,) for tetrahedra: True for the first generation of planar marks; else False.
    start, level
        (e,) keys of the cells.
    """

    corners: IntArray
    place: Array
    apex: IntArray
    flag: BoolArray
    start: IntArray
    level: IntArray

    @property
    def leaves(self) -> Leaves:
        """Keys of the cells, in the order of the cells."""
        return Leaves(self.start, self.level)

    def some(self, chosen: BoolArray | IntArray) -> "TreeCells":
        """The chosen cells."""
        parts = {name: getattr(self, name)[chosen] for name in self.__slots__}
        return TreeCells(**parts)


def joined(*parts: TreeCells) -> TreeCells:
    """Cells of all parts, in rising order of their keys."""
    every = TreeCells(**{n: np.concatenate([getattr(p, n) for p in parts]) for n in TreeCells.__slots__})
    return every.some(np.argsort(every.start, kind="stable"))


def base_cells(mesh: Mesh) -> TreeCells:
    """Cells of a base mesh of one type: bars in their direction, others with the longest edge of each face marked.

    Of edges with the same length but for rounding that with the greatest numbers of nodes counts as the longest.
    """
    (name, cells) = next(iter(mesh.blocks.items()))
    count = CELLS[name].corners
    corners = np.array(cells[:, :count])
    keys = roots(len(corners))
    apex = np.zeros((len(corners), 2), dtype=np.int64)
    order = np.tile(np.arange(count), (len(corners), 1))
    if count > 2:
        rank = _edge_ranks(mesh, corners, np.array(CELLS[linear(name)].edges))
        order = _longest_first(rank)
        if count == 4:
            apex = _marks(np.take_along_axis(np.take_along_axis(rank, order[:, :, None], 1), order[:, None, :], 2))
    return TreeCells(
        corners=np.take_along_axis(corners, order, axis=1),
        place=np.eye(count)[order],
        apex=apex,
        flag=np.zeros(len(corners), bool),
        start=np.array(keys.start),
        level=np.array(keys.level),
    )


def _edge_ranks(mesh: Mesh, corners: IntArray, edges: IntArray) -> IntArray:
    """Ranks (e, c, c) of the edges between the corners of each cell in one order of all edges, -1 on the diagonal."""
    ends = np.sort(corners[:, edges], axis=2)
    pairs, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    length = np.linalg.norm(mesh.points[pairs[:, 1]] - mesh.points[pairs[:, 0]], axis=1)
    by_length = np.argsort(length, kind="stable")
    ordered = length[by_length]
    group = np.empty(len(pairs), dtype=np.int64)
    group[by_length] = np.concatenate([[0], np.cumsum(np.diff(ordered) > TIE * ordered[1:])])
    rank = np.empty(len(pairs), dtype=np.int64)
    rank[np.lexsort((pairs[:, 1], pairs[:, 0], group))] = np.arange(len(pairs))
    table = np.full((len(corners), corners.shape[1], corners.shape[1]), -1, dtype=np.int64)
    own = rank[number.ravel()].reshape(len(corners), len(edges))
    table[:, edges[:, 0], edges[:, 1]] = table[:, edges[:, 1], edges[:, 0]] = own
    return table


def _longest_first(rank: IntArray) -> IntArray:
    """Order (e, c) of the corners with those of the edge of the greatest rank first."""
    count, c = rank.shape[:2]
    ends = np.column_stack(np.unravel_index(rank.reshape(count, -1).argmax(axis=1), (c, c)))
    position = np.full((count, c), 2)
    position[np.arange(count), ends.min(axis=1)], position[np.arange(count), ends.max(axis=1)] = 0, 1
    return np.argsort(position, axis=1, kind="stable")


def _marks(rank: IntArray) -> IntArray:
    """Corners (e, 2) off the edge of the greatest rank (e, 4, 4) of the faces opposite to corners 0 and 1."""
    out = []
    for face in ((1, 2, 3), (0, 2, 3)):
        edges = np.column_stack([rank[:, face[(k + 1) % 3], face[(k + 2) % 3]] for k in range(3)])
        out.append(np.array(face)[edges.argmax(axis=1)])
    return np.column_stack(out)
