"""Tree of bisections of a base mesh: its cells and the middles of edges, without a mesh of them."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.geometry.bisection import bisected
from softway.meshes.adaptive.leaves import Leaves
from softway.meshes.adaptive.nodes.leaf_nodes import shape_functions
from softway.meshes.adaptive.nodes.middles import Middles
from softway.meshes.adaptive.squares.balanced import BALANCED, balanced, cut, square_cells
from softway.meshes.adaptive.squares.cut_nodes import CutNodes
from softway.meshes.adaptive.tree_cells import TreeCells, base_cells, joined
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Tree:
    """Cells of a conforming refinement of a base mesh, in rising order of their keys, and the middles of cut edges."""

    base: Mesh
    cells: TreeCells
    middles: Middles | CutNodes

    @property
    def leaves(self) -> Leaves:
        """Keys of the cells."""
        return self.cells.leaves

    @property
    def step(self) -> int:
        """Levels by which a cell that is cut becomes finer: one; two for quadrilaterals and three for hexahedra."""
        return self.base.cell_dim if isinstance(self.middles, CutNodes) else 1

    def parts(self, cells: TreeCells) -> TreeCells:
        """Parts of cells that are cut, without numbers of their nodes: halves; quarters, eighths of squares, cubes."""
        return joined(*cut(cells, CutNodes.none(0))[1]) if isinstance(self.middles, CutNodes) else halved(cells)

    def corners(self, cells: TreeCells) -> Array:
        """Places (e, c, d) of the corners of cells [m]."""
        name, nodes = next(iter(self.base.blocks.items()))
        functions = shape_functions(name, cells.place)
        return np.asarray(np.einsum("ecn,end->ecd", functions, self.base.points[nodes[cells.leaves.root]]))

    def grown(self, given: Leaves, level: IntArray) -> "Tree":
        """The coarsest conforming refinement of this one in which no cell is coarser than the ``level`` (e,) wanted on
        the leaves ``given``.

        Examples
        --------
        >>> from softway.meshes.generators.shapes import interval
        >>> tree = tree_of(interval(1.0, cells=2))
        >>> tree.grown(tree.leaves, np.array([2, 0])).leaves.level.tolist()
        [2, 2, 2, 2, 1, 1]
        """
        if isinstance(self.middles, CutNodes):
            found, cuts = balanced(self.base, given, level)
            return Tree(base=self.base, cells=found, middles=cuts)
        cells, middles = _bisected(self.cells, self.middles, given, level, True)
        return Tree(base=self.base, cells=cells, middles=middles)


def tree_of(base: Mesh) -> Tree:
    """Tree of the cells of a base mesh, of one type of cell."""
    if next(iter(base.blocks)) in BALANCED:
        return Tree(base=base, cells=square_cells(base), middles=CutNodes.none(base.n_nodes))
    return Tree(base=base, cells=base_cells(base), middles=Middles.none(base.n_nodes))


def halved(cells: TreeCells) -> TreeCells:
    """Both halves of each cell, without numbers of their nodes."""
    return _bisected(cells, Middles.none(int(cells.corners.max()) + 1), cells.leaves, cells.level + 1, False)[0]


def _bisected(
    cells: TreeCells, middles: Middles, given: Leaves, level: IntArray, closed: bool
) -> tuple[TreeCells, Middles]:
    """Cells bisected as far as wanted, and the middles."""
    keys = cells.flag, cells.start, cells.level
    rows = np.column_stack([cells.corners, cells.apex, *keys]).astype(np.int64, copy=False)
    place = np.ascontiguousarray(cells.place)
    start, wanted = np.array(given.start), np.array(level, dtype=np.int64)  # compiled once: writable ones and others
    out, places, codes, nodes, count = bisected(
        rows, place, middles.codes, middles.nodes, middles.count, start, wanted, closed
    )
    c = place.shape[1]
    found = TreeCells(
        corners=out[:, :c],
        place=places,
        apex=out[:, c : c + 2],
        flag=out[:, c + 2] != 0,
        start=np.ascontiguousarray(out[:, c + 3]),
        level=np.ascontiguousarray(out[:, c + 4]),
    )
    return found, Middles(codes=codes, nodes=nodes, count=count)
