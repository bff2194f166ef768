"""Adapted meshes: conforming refinements of a base mesh by bisection, as a function of the wanted levels."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.kernels.geometry.jacobians import determinants
from softway.meshes.adaptive.leaves import DEPTH, MOST_CELLS, Leaves, roots
from softway.meshes.adaptive.nodes.leaf_nodes import leaf_nodes, located
from softway.meshes.adaptive.nodes.tags import refined_tags
from softway.meshes.adaptive.rounded.origins import origins_of
from softway.meshes.adaptive.rounded.placing import places
from softway.meshes.adaptive.rounded.volumes import filling_of
from softway.meshes.adaptive.squares.balanced import BALANCED
from softway.meshes.adaptive.squares.cut_nodes import CutNodes
from softway.meshes.adaptive.squares.square_nodes import square_nodes
from softway.meshes.adaptive.tree import Tree, tree_of
from softway.meshes.adaptive.tree_cells import TreeCells
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
    def flat(self) -> Array:
        """Places (n, d) of the nodes on the facets of the base mesh, where its boundary is curved [m]."""
        if self.base.rounding is None:
            return self.mesh.points
        nodes = next(iter(self.mesh.blocks.values()))
        out = np.empty_like(self.mesh.points)
        roots = next(iter(self.base.blocks.values()))[self.leaves.root]
        out[nodes] = np.einsum("ecb,ebd->ecd", self.place, self.base.points[roots])
        return out

    @property
    def step(self) -> int:
        """Levels by which a cell that is cut becomes finer: one; two for quadrilaterals and three for hexahedra."""
        return self.mesh.cell_dim if self.cell in BALANCED else 1


def refined(base: Mesh, want: IntArray, on: Leaves | None = None) -> AdaptedMesh:
    """Coarsest conforming refinement of a base mesh in which no cell is coarser than wanted.

    The mesh is a function of the base mesh and the wanted levels at each place; it has no history, so that a mesh is
    made coarser by wanting less.  Triangles and tetrahedra share whole facets; levels of bars that share a node differ
    by one at most.  Quadrilaterals and hexahedra are cut into four and eight, and nodes hang in the middle of edges and
    faces of larger cells.  Cells of second order keep the exact shape of the base cell, also where it is curved; on
    linear cells new nodes lie on the smooth surface of a base mesh
    (:func:`~softway.meshes.adaptive.surfaces.surface.rounded`).

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
    return adapted_mesh(tree_of(base).grown(given, level))


def _require_bisected(base: Mesh) -> None:
    """Refuse meshes that bisection cannot refine."""
    names = list(base.blocks)
    if len(names) > 1 or names[0] not in BISECTED:
        raise InputError(
            "mesh", f"cells {', '.join(names)}", f"one type of cell that can be bisected: {', '.join(BISECTED)}"
        )
    if base.n_cells > MOST_CELLS:
        raise InputError("mesh", f"{base.n_cells} cells", f"a base mesh of at most {MOST_CELLS} cells")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LeafPlaces:
    """Nodes of the leaves of a tree.

    Parameters
    ----------
    points
        (n, d) places of all nodes, first those of the base mesh [m].
    nodes, place
        (e, a) nodes of the leaves, and barycentric coordinates (e, c, c) of their corners in the base cells.
    carriers
        (k, c) corners of the base mesh that each new node lies between.
    hanging
        Hanging nodes; None without.
    """

    points: Array
    nodes: IntArray
    place: Array
    carriers: IntArray
    hanging: HangingNodes | None


def leaf_places(tree: Tree) -> LeafPlaces:
    """Nodes of the leaves of a tree, on the smooth surface of the base mesh if it has one."""
    base, cells = tree.base, tree.cells
    if isinstance(tree.middles, CutNodes):
        corners, place = cells.corners, cells.place
        nodes, first, hanging = square_nodes(base, cells, tree.middles)
    else:
        corners, place = _oriented(cells)
        nodes, first = leaf_nodes(base, corners, tree.middles)
        hanging = None
    roots = next(iter(base.blocks.values()))[cells.start >> DEPTH]
    points, carriers = located(base, roots, place, first)
    points = np.concatenate([base.points, points])
    if base.rounding is not None:
        number = np.zeros(tree.middles.count, dtype=np.int64)
        number[corners] = nodes
        points = places(base.points, base.rounding, carriers, origins_of(tree.middles).numbered(number))
        points = points if hanging is None else hanging.following(points)
    return LeafPlaces(points=points, nodes=nodes, place=place, carriers=carriers, hanging=hanging)


def adapted_mesh(tree: Tree) -> AdaptedMesh:
    """Adapted mesh of the cells of a tree."""
    base, found = tree.base, leaf_places(tree)
    name = next(iter(base.blocks))
    leaves = Leaves(np.array(tree.cells.start), np.array(tree.cells.level))
    regions = {region: np.flatnonzero(np.isin(leaves.root, own)) for region, own in base.regions.items()}
    mesh = Mesh(
        points=found.points,
        blocks={name: found.nodes},
        tags=refined_tags(base, found.carriers),
        regions=regions,
        hanging=found.hanging,
        filling=filling_of(base, found.points, found.nodes, leaves.root),
    )
    return AdaptedMesh(base=base, mesh=mesh, leaves=leaves, place=found.place)


def _oriented(cells: TreeCells) -> tuple[IntArray, Array]:
    """Corners (e, c) in the order of VTK, and their barycentric coordinates (e, c, c); base cells as they are."""
    count, c = cells.corners.shape
    order = np.tile(np.arange(c), (count, 1))
    order[determinants(cells.place[:, 1:, 1:] - cells.place[:, :1, 1:]) < 0.0, -2:] = (c - 1, c - 2)
    whole = cells.level == 0
    order[whole] = np.argsort(cells.place[whole].argmax(axis=2), axis=1)
    return np.take_along_axis(cells.corners, order, 1), np.take_along_axis(cells.place, order[:, :, None], 1)
