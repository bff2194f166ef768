"""Adapted meshes: conforming refinements of a base mesh by bisection, as a function of the wanted levels."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.adaptive.leaf_nodes import FirstPlaces, leaf_nodes, located
from softway.meshes.adaptive.leaves import DEPTH, MOST_CELLS, Leaves, finest, roots
from softway.meshes.adaptive.middles import Middles
from softway.meshes.adaptive.squares.balanced import BALANCED, balanced
from softway.meshes.adaptive.squares.square_nodes import square_nodes
from softway.meshes.adaptive.tags import refined_tags
from softway.meshes.adaptive.tree_cells import TreeCells, base_cells, children, joined
from softway.meshes.mesh import Mesh
from softway.meshes.topology import HangingNodes

BISECTED = ("bar2", "bar3", "tri3", "tri6", "tet4", "tet10", *BALANCED)
"""Cells that bisection refines, quadrilaterals and hexahedra in all directions at once."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AdaptedMesh:
    """Conforming refinement of a base mesh.

    Parameters
    ----------
    base
        Base mesh.
    mesh
        The refined mesh; its cells are in the order of the leaves, its first nodes are those of the base mesh.
    leaves
        Keys of its cells.
    place
        (e, c, c) barycentric coordinates of the corners of each cell in its base cell; in quadrilaterals and hexahedra
        the values of the linear shape functions of the base cell.
    """

    base: Mesh
    mesh: Mesh
    leaves: Leaves
    place: Array

    @property
    def cell(self) -> str:
        """Name of the cells."""
        return next(iter(self.mesh.blocks))

    @property
    def step(self) -> int:
        """Levels by which a cell that is cut becomes finer: one; two for quadrilaterals and three for hexahedra."""
        return self.mesh.cell_dim if self.cell in BALANCED else 1


def refined(base: Mesh, want: IntArray, on: Leaves | None = None) -> AdaptedMesh:
    """Coarsest conforming refinement of a base mesh in which no cell is coarser than wanted.

    The mesh is a function of the base mesh and the wanted levels at each place; it has no history, so that a mesh is
    made coarser by wanting less.  Triangles and tetrahedra share whole facets; levels of bars that share a node differ
    by one at most.  Quadrilaterals and hexahedra are cut into four and eight, and nodes hang in the middle of edges and
    faces of larger cells.  Cells of second order keep the exact shape of the base cell, also where it is curved.

    Parameters
    ----------
    base
        Mesh of one type of cell: ``bar2 bar3 tri3 tri6 tet4 tet10 quad4 quad8 quad9 hex8 hex20 hex27``.
    want
        (e,) wanted levels, 0 to 40: of the base cells, or on the leaves ``on``.  A level more halves a cell;
        quadrilaterals have even levels, hexahedra multiples of three.
    on
        Leaves (e,) of an adapted mesh of the same base.

    Raises
    ------
    InputError
        For other cells, several types of cells, or levels that are no such numbers.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> fine = refined(interval(1.0, cells=2), np.array([2, 0]))
    >>> sorted(fine.mesh.points[:, 0].tolist()), fine.leaves.level.tolist()
    ([0.0, 0.125, 0.25, 0.375, 0.5, 0.75, 1.0], [2, 2, 2, 2, 1, 1])
    >>> refined(fine.base, np.array([0, 0, 0, 0, 0, 0]), fine.leaves).mesh.n_cells
    2
    """
    _require_bisected(base)
    given = roots(base.n_cells) if on is None else on
    level = np.asarray(want)
    if (
        level.shape != given.level.shape
        or level.dtype.kind not in "iu"
        or not (level >= 0).all()
        or not (level <= DEPTH).all()
    ):
        problem = f"array of shape {level.shape} and type {level.dtype}"
        raise InputError("want", problem, f"whole numbers from 0 to {DEPTH} for {len(given.level)} cells")
    if next(iter(base.blocks)) in BALANCED:
        cells, cuts = balanced(base, given, level)
        return _adapted(base, cells, cells.place, square_nodes(base, cells, cuts))
    cells, middles = _bisected(base_cells(base), Middles.none(base.n_nodes), given, level)
    corners, place = _oriented(cells)
    return _adapted(base, cells, place, (*leaf_nodes(base, corners, middles), None))


def _require_bisected(base: Mesh) -> None:
    """Refuse meshes that bisection cannot refine."""
    names = list(base.blocks)
    if len(names) > 1 or names[0] not in BISECTED:
        raise InputError(
            "mesh", f"cells {', '.join(names)}", f"one type of cell that can be bisected: {', '.join(BISECTED)}"
        )
    if base.n_cells > MOST_CELLS:
        raise InputError("mesh", f"{base.n_cells} cells", f"a base mesh of at most {MOST_CELLS} cells")


def _bisected(cells: TreeCells, middles: Middles, given: Leaves, level: IntArray) -> tuple[TreeCells, Middles]:
    """Cells of the refinement, and the nodes in the middle of edges that it has cut."""
    while True:
        cut = finest(cells.leaves, given, level) > cells.level
        cut |= _too_coarse(cells) if cells.corners.shape[1] == 2 else middles.on_edges(cells.corners)
        if not cut.any():
            return cells, middles
        chosen = cells.some(cut)
        middles, middle = middles.with_middles(chosen.corners[:, :2])
        cells = joined(cells.some(~cut), *children(chosen, middle))


def _too_coarse(bars: TreeCells) -> BoolArray:
    """Bars (e,) that share a node with one that is finer by two levels or more."""
    greatest = np.zeros(int(bars.corners.max()) + 1, dtype=np.int64)
    np.maximum.at(greatest, bars.corners, bars.level[:, None])
    return np.asarray(greatest[bars.corners].max(axis=1) > bars.level + 1)


def _adapted(
    base: Mesh, cells: TreeCells, place: Array, numbered: tuple[IntArray, FirstPlaces, HangingNodes | None]
) -> AdaptedMesh:
    """Adapted mesh of the leaves ``cells``, from the places (e, c, c) of their corners, their nodes (e, a), where the
    new ones occur first, and the hanging ones.
    """
    name, rows = next(iter(base.blocks.items()))
    nodes, first, hanging = numbered
    points, carriers = located(base, rows[cells.start >> DEPTH], place, first)
    leaves = Leaves(np.array(cells.start), np.array(cells.level))
    regions = {region: np.flatnonzero(np.isin(leaves.root, own)) for region, own in base.regions.items()}
    mesh = Mesh(
        points=np.concatenate([base.points, points]),
        blocks={name: nodes},
        tags=refined_tags(base, carriers),
        regions=regions,
        hanging=hanging,
    )
    return AdaptedMesh(base=base, mesh=mesh, leaves=leaves, place=place)


def _oriented(cells: TreeCells) -> tuple[IntArray, Array]:
    """Corners (e, c) in the order of VTK, and their barycentric coordinates (e, c, c); base cells as they are."""
    count, c = cells.corners.shape
    order = np.tile(np.arange(c), (count, 1))
    order[np.linalg.det(cells.place) < 0.0, -2:] = (c - 1, c - 2)
    whole = cells.level == 0
    order[whole] = np.argsort(cells.place[whole].argmax(axis=2), axis=1)
    return np.take_along_axis(cells.corners, order, 1), np.take_along_axis(cells.place, order[:, :, None], 1)
