"""Nodes around the new nodes of a tree of bisections."""

import numpy as np

from softway.arrays import IntArray
from softway.meshes.adaptive.nodes.middles import SHIFT, Middles
from softway.meshes.adaptive.rounded.placing import Origins
from softway.meshes.adaptive.squares.cut_nodes import CutNodes
from softway.meshes.cells import FACETS


def origins_of(nodes: Middles | CutNodes) -> Origins:
    """Nodes around those in the middle of what has been cut.

    Examples
    --------
    >>> cuts = CutNodes.none(4)
    >>> for group in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)):
    ...     cuts, _ = cuts.of(np.array([[0, 1, 2, 3]]), group)
    >>> origins_of(cuts).faces.tolist()
    [[8, 4, 5, 6, 7]]
    """
    if isinstance(nodes, Middles):
        return Origins(edges=_edges(nodes), faces=np.zeros((0, 5), np.int64), cubes=np.zeros((0, 7), np.int64))
    faces, cubes = (_around(nodes, corners) for corners in (4, 8))
    around = [(0, 1), (1, 2), (2, 3), (3, 0)]
    sides = [local for _, local in FACETS["hex8"]]
    return Origins(
        edges=_edges(nodes.edges),
        faces=np.column_stack([faces[:, 0], *(nodes.found(faces[:, 1:], pair) for pair in around)]),
        cubes=np.column_stack([cubes[:, 0], *(nodes.found(cubes[:, 1:], side) for side in sides)]),
    )


def _edges(middles: Middles) -> IntArray:
    """Nodes (k, 3) in the middle of edges, and their ends."""
    return np.column_stack([middles.nodes, middles.codes >> SHIFT, middles.codes & ((1 << SHIFT) - 1)])


def _around(nodes: CutNodes, corners: int) -> IntArray:
    """Nodes (k, 1 + c) in the middle of faces or hexahedra, and their corners."""
    rows = [rows for rows in nodes.around if rows.shape[1] == 1 + corners]
    every = np.concatenate([np.zeros((0, 1 + corners), np.int64), *rows])
    return every[np.unique(every[:, 0], return_index=True)[1]]
