"""Fine cells around places and around other fine cells (docs/theory/bodies/adaptive.md#indicator).

Cells are bisected without regard to their neighbours first, and the conforming mesh is made once.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray
from softway.meshes.adaptive.leaves import Leaves, among
from softway.meshes.adaptive.tree import Tree
from softway.meshes.adaptive.tree_cells import TreeCells

Mark = tuple[int, Array]
"""A level, and points (k, d) around which cells have it or a finer one [m]."""


def marks_of(tree: Tree) -> list[Mark]:
    """Levels of the finer cells of a tree, with their corners: marks of buffers in which cells are as fine as they.

    Examples
    --------
    >>> from softway.meshes.adaptive.tree import tree_of
    >>> from softway.meshes.generators.shapes import interval
    >>> sharp = tree_of(interval(1.0, cells=4))
    >>> sharp = sharp.grown(sharp.leaves, np.array([3, 0, 0, 0]))
    >>> len(sharp.leaves.level), len(grown_near(sharp, marks_of(sharp), 0.1).leaves.level)
    (13, 17)
    """
    marks: list[Mark] = []
    for level in np.unique(tree.cells.level)[1:]:
        cells = tree.cells.some(tree.cells.level == level)
        _, first = np.unique(cells.corners, return_index=True)
        marks.append((int(level), tree.corners(cells).reshape(-1, tree.base.dim)[first]))
    return marks


def grown_near(tree: Tree, marks: Sequence[Mark], reach: float) -> Tree:
    """Tree in which cells that come within a distance ``reach`` [m] of a point of a mark have its level or more.

    Distances are those from the ball around a cell.

    Examples
    --------
    >>> from softway.meshes.adaptive.tree import tree_of
    >>> from softway.meshes.generators.shapes import interval
    >>> whole = tree_of(interval(1.0, cells=1))
    >>> grown_near(whole, [(3, np.array([[1.0]]))], 0.05).leaves.level.tolist()
    [1, 2, 3, 3]
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
