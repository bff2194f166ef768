"""Fine cells around places and around other fine cells (docs/theory/bodies/adaptive.md#indicator).

Cells are bisected without regard to their neighbours first, and the conforming mesh is made once.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray
from softway.meshes.adaptive.leaf_nodes import shape_functions
from softway.meshes.adaptive.leaves import DEPTH, Leaves, finest, same
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.adaptive.squares.balanced import BALANCED, cut, square_cells
from softway.meshes.adaptive.squares.cut_nodes import CutNodes
from softway.meshes.adaptive.tree_cells import TreeCells, base_cells, children, joined
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

Mark = tuple[int, Array]
"""A level, and points (k, d) around which cells have it or a finer one [m]."""


def buffered(adapted: AdaptedMesh, reach: float) -> AdaptedMesh:
    """Mesh in which a cell that comes within a distance ``reach`` [m] of a finer one of ``adapted`` is as fine as it.

    Distances are those of the corners of the finer cell from the ball around the coarser one.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> sharp = refined(interval(1.0, cells=4), np.array([3, 0, 0, 0]))
    >>> sharp.mesh.n_cells, buffered(sharp, 0.1).mesh.n_cells
    (13, 17)
    """
    cells = next(iter(adapted.mesh.blocks.values()))[:, : CELLS[adapted.cell].corners]
    levels = adapted.leaves.level
    marks = [(int(k), adapted.mesh.points[np.unique(cells[levels == k])]) for k in np.unique(levels)[1:]]
    return refined_near(adapted, marks, reach)


def refined_near(adapted: AdaptedMesh, marks: Sequence[Mark], reach: float) -> AdaptedMesh:
    """Mesh in which cells that come within a distance ``reach`` [m] of a point of a mark have its level or more.

    Distances are those from the ball around a cell.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> whole = refined(interval(1.0, cells=1), np.array([0]))
    >>> refined_near(whole, [(3, np.array([[1.0]]))], 0.05).leaves.level.tolist()
    [1, 2, 3, 3]
    """
    step = adapted.step
    trees, found = [(level - level % step, cKDTree(points)) for level, points in marks if len(points)], adapted
    while trees:
        leaves = _bisected_near(adapted.base, found.leaves, trees, reach)
        if same(leaves, found.leaves):
            break
        found = refined(adapted.base, leaves.level, leaves)
    return found


def _bisected_near(base: Mesh, given: Leaves, trees: Sequence[tuple[int, cKDTree]], reach: float) -> Leaves:
    """Leaves ``given`` (e,), bisected near the points of the marks; the result may be no conforming mesh."""
    whole = next(iter(base.blocks)) in BALANCED
    cells, parts = (square_cells(base), _parts) if whole else (base_cells(base), _halves)
    while (coarse := finest(cells.leaves, given, given.level) > cells.level).any():
        cells = joined(cells.some(~coarse), *parts(cells.some(coarse)))
    done = []
    while (late := _late(base, cells, trees, reach)).any():
        done.append(cells.some(~late))
        cells = joined(*parts(cells.some(late)))
    return joined(*done, cells).leaves


def _halves(cells: TreeCells) -> tuple[TreeCells, ...]:
    """Both halves of each cell, without numbers of their nodes."""
    return children(cells, np.zeros(len(cells.level), dtype=np.int64))


def _parts(cells: TreeCells) -> tuple[TreeCells, ...]:
    """The four or eight parts of each cell, without numbers of their nodes."""
    return cut(cells, CutNodes.none(0))[1]


def _late(base: Mesh, cells: TreeCells, trees: Sequence[tuple[int, cKDTree]], reach: float) -> BoolArray:
    """True (e,) for cells that are coarser than the level of a mark near them."""
    name, nodes = next(iter(base.blocks.items()))
    own = np.einsum("ecn,end->ecd", shape_functions(name, cells.place), base.points[nodes[cells.start >> DEPTH]])
    centre = own.mean(axis=1)
    near = np.linalg.norm(own - centre[:, None], axis=2).max(axis=1, initial=0.0) + reach
    late = np.zeros(len(near), dtype=bool)
    for level, points in trees:
        some = np.flatnonzero((cells.level < level) & ~late)
        if len(some):
            distance = points.query(centre[some], distance_upper_bound=1.01 * float(near[some].max()))[0]
            late[some] = distance < near[some]
    return late
