"""Nodes in the middle of edges, faces and cells that have been cut, or that are of second order."""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import IntArray
from softway.meshes.adaptive.nodes.middles import Middles, edge_codes

OPPOSITE = {4: np.array([2, 3, 0, 1]), 8: np.array([6, 7, 4, 5, 2, 3, 0, 1])}
"""Corner opposite to each corner of a quadrilateral, in order around, and of a hexahedron."""
KINDS = {2: "edges", 4: "faces", 8: "cubes"}
"""Tables of the nodes in the middle of 2, 4 and 8 corners."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CutNodes:
    """Nodes in the middle of edges, faces and hexahedra; a quadrilateral is a face.

    Parameters
    ----------
    edges
        Those of edges.
    faces, cubes
        Those of faces and hexahedra, by the diagonal at their corner with the smallest number.
    count
        Number of nodes so far.
    around
        Nodes in the middle of faces (f, 5) and hexahedra (e, 9) with their corners, some of them more than once.

    Examples
    --------
    >>> nodes, middle = CutNodes.none(4).of(np.array([[0, 1, 2, 3]]), (0, 1, 2, 3))
    >>> middle.tolist(), nodes.found(np.array([[3, 2, 1, 0], [0, 1, 3, 2]]), (0, 1, 2, 3)).tolist()
    ([4], [4, -1])
    """

    edges: Middles
    faces: Middles
    cubes: Middles
    count: int
    around: tuple[IntArray, ...] = ()

    @classmethod
    def none(cls, count: int) -> "CutNodes":
        """No such nodes, in a mesh of ``count`` nodes."""
        none = Middles.none(count)
        return cls(edges=none, faces=none, cubes=none, count=count)

    def of(self, corners: IntArray, group: tuple[int, ...]) -> tuple["CutNodes", IntArray]:
        """Nodes with those in the middle of a ``group`` of the ``corners`` (e, c), and the node (e,) of each cell.

        Groups of four are in order around.
        """
        if len(group) == 1:
            return self, corners[:, group[0]]
        kind = KINDS[len(group)]
        found, node = replace(getattr(self, kind), count=self.count).with_middles(_pair(corners[:, group]))
        around = self.around
        if len(group) > 2:
            around = (*around, np.column_stack([node, corners[:, group]]))
        return replace(self, count=found.count, around=around, **{kind: found}), node

    def found(self, corners: IntArray, group: tuple[int, ...]) -> IntArray:
        """Node (e,) in the middle of a ``group`` of the ``corners`` (e, c); -1 where there is none."""
        if len(group) == 1:
            return corners[:, group[0]]
        return middle(_pair(corners[:, group]), getattr(self, KINDS[len(group)]))


def middle(edges: IntArray, middles: Middles) -> IntArray:
    """Node (...) in the middle of ``edges`` (..., 2); -1 where there is none."""
    if not len(middles.codes):
        return np.full(edges.shape[:-1], -1)
    code = edge_codes(edges)
    at = np.minimum(np.searchsorted(middles.codes, code), len(middles.codes) - 1)
    return np.where(middles.codes[at] == code, middles.nodes[at], -1)


def _pair(corners: IntArray) -> IntArray:
    """Ends (e, 2) of an edge, or of the diagonal of a face or cube (e, c) at its corner with the smallest number."""
    if corners.shape[1] == 2:
        return corners
    first = corners.argmin(axis=1)[:, None]
    both = np.concatenate([first, OPPOSITE[corners.shape[1]][first]], axis=1)
    return np.take_along_axis(corners, both, axis=1)
