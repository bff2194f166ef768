"""Fine cells around places and around other fine cells (docs/theory/bodies/adaptive.md#indicator).

Cells are bisected without regard to their neighbours first, and the conforming mesh is made once.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray
from softway.meshes.adaptive.leaves import Leaves, among, same
from softway.meshes.adaptive.refinement import AdaptedMesh, adapted_mesh
from softway.meshes.adaptive.tree import Tree, tree_of
from softway.meshes.adaptive.tree_cells import TreeCells

Mark = tuple[int, Array]
"""A level, and points (k, d) around which cells have it or a finer one [m]."""


def buffered(adapted: AdaptedMesh, reach: float) -> AdaptedMesh:
    """Mesh in which a cell that comes within a distance ``reach`` [m] of a finer one of ``adapted`` is as fine as it.

    Distances are those of the corners of the finer cell from the ball around the coarser one.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import interval
    >>> sharp = refined(interval(1.0, cells=4), np.array([3, 0, 0, 0]))
    >>> sharp.mesh.n_cells, buffered(sharp, 0.1).mesh.n_cells
    (13, 17)
    """
    return _mesh(adapted, grown_around(_tree(adapted), reach))


def refined_near(adapted: AdaptedMesh, marks: Sequence[Mark], reach: float) -> AdaptedMesh:
    """Mesh in which cells that come within a distance ``reach`` [m] of a point of a mark have its level or more.

    Distances are those from the ball around a cell.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import interval
    >>> whole = refined(interval(1.0, cells=1), np.array([0]))
    >>> refined_near(whole, [(3, np.array([[1.0]]))], 0.05).leaves.level.tolist()
    [1, 2, 3, 3]
    """
    return _mesh(adapted, grown_near(_tree(adapted), marks, reach))


def _tree(adapted: AdaptedMesh) -> Tree:
    """Tree of the cells of a mesh."""
    return tree_of(adapted.base).grown(adapted.leaves, adapted.leaves.level)


def _mesh(adapted: AdaptedMesh, tree: Tree) -> AdaptedMesh:
    """Mesh of a tree; the ``adapted`` one if it has the same leaves."""
    return adapted if same(tree.leaves, adapted.leaves) else adapted_mesh(tree)


def grown_around(tree: Tree, reach: float) -> Tree:
    """Tree in which a cell that comes within a distance ``reach`` [m] of a finer one is as fine as it, see
    :func:`buffered`.
    """
    return grown_near(tree, marks_of(tree), reach)


def marks_of(tree: Tree) -> list[Mark]:
    """Levels of the finer cells of a tree, with their corners."""
    marks: list[Mark] = []
    for level in np.unique(tree.cells.level)[1:]:
        cells = tree.cells.some(tree.cells.level == level)
        _, first = np.unique(cells.corners, return_index=True)
        marks.append((int(level), tree.corners(cells).reshape(-1, tree.base.dim)[first]))
    return marks


def grown_near(tree: Tree, marks: Sequence[Mark], reach: float) -> Tree:
    """Tree in which cells that come within a distance ``reach`` [m] of a point of a mark have its level or more, see
    :func:`refined_near`.
    """
    step = tree.step
    points = [(level - level % step, cKDTree(places)) for level, places in marks if len(places)]
    fresh = np.ones(len(tree.cells.level), dtype=bool)
    while points and fresh.any():
        wanted = _bisected_near(tree, fresh, points, reach)
        if wanted is None:
            break
        tree = tree.grown(wanted, wanted.level)
        fresh = ~among(tree.leaves, wanted)
    return tree


def _bisected_near(tree: Tree, fresh: BoolArray, points: Sequence[tuple[int, cKDTree]], reach: float) -> Leaves | None:
    """Leaves of a tree with its ``fresh`` ones (e,) bisected near the points of the marks, without regard to their
    neighbours; None if none is.
    """
    done, cells = [tree.cells.some(~fresh)], tree.cells.some(fresh)
    while (late := _late(tree, cells, points, reach)).any():
        done.append(cells.some(~late))
        cells = tree.parts(cells.some(late))
    if len(done) == 1:
        return None
    start, level = (np.concatenate([getattr(part, name) for part in (*done, cells)]) for name in ("start", "level"))
    order = np.argsort(start)
    return Leaves(start[order], level[order])


def _late(tree: Tree, cells: TreeCells, points: Sequence[tuple[int, cKDTree]], reach: float) -> BoolArray:
    """True (e,) for cells that are coarser than the level of a mark near them."""
    own = tree.corners(cells)
    centre = own.mean(axis=1)
    near = np.linalg.norm(own - centre[:, None], axis=2).max(axis=1, initial=0.0) + reach
    late = np.zeros(len(near), dtype=bool)
    for level, places in points:
        some = np.flatnonzero((cells.level < level) & ~late)
        if len(some):
            distance = places.query(centre[some], distance_upper_bound=1.01 * float(near[some].max()))[0]
            late[some] = distance < near[some]
    return late
