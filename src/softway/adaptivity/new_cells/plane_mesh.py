"""Mesh of triangles for the present shape of a body in the plane."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.adaptivity.new_cells.filling import Filled, filled
from softway.adaptivity.new_cells.outline import Outline, outline
from softway.adaptivity.new_cells.sizes import SizeField
from softway.adaptivity.new_cells.swaps import regular
from softway.adaptivity.rezoning.rezone import between
from softway.adaptivity.rezoning.smoothing import moved
from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.generators.lattice import quadratic_simplices
from softway.meshes.mesh import Mesh

Filler = Callable[[Array, IntArray, SizeField], Filled | None]
"""Triangles inside closed polygons: corners (k, 2), sides (s, 2) and lengths of the edges."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NewMesh:
    """Mesh with other cells.

    Parameters
    ----------
    mesh
        The mesh.
    sizes
        (n,) lengths of the edges asked for at its nodes [m].
    touching, kept
        (n,) nodes of the boundary in contact, and those that may not move.
    """

    mesh: Mesh
    sizes: Array
    touching: BoolArray
    kept: BoolArray

    def divided(self, mesh: Mesh) -> "NewMesh":
        """The same with the mesh after the division of cells: more nodes at the end, which stay on the boundary."""
        more = mesh.n_nodes - self.mesh.n_nodes
        near = cKDTree(self.mesh.points).query(mesh.points[self.mesh.n_nodes :])[1] if more else np.zeros(0, np.int64)
        sizes, ones = np.concatenate([self.sizes, self.sizes[near]]), np.ones(more, dtype=bool)
        touching = np.concatenate([self.touching, ~ones])
        return NewMesh(mesh=mesh, sizes=sizes, touching=touching, kept=np.concatenate([self.kept, ones]))

    def with_boundary(self, places: Array) -> Mesh | None:
        """The mesh with its boundary at the places (n, d), the nodes inside in those of least distortion; None if a
        cell folds.
        """
        mesh = self.mesh
        boundary = mesh.nodes("surface")
        (cells,) = mesh.blocks.values()
        found = moved(regular(cells[:, : mesh.dim + 1]), mesh.points, boundary, places[boundary])
        return None if found is None else moved_mesh(mesh, between(mesh.blocks, found, boundary))


def plane_mesh(
    old: Mesh, places: Array, sizes: Array, closed: BoolArray, kept: BoolArray, fill: Filler = filled
) -> NewMesh | None:
    """Mesh of triangles for the present shape of a mesh of triangles, with its tags; None if its boundary crosses
    itself.

    Parameters
    ----------
    old
        The old mesh, of tri3 or tri6.
    places, sizes
        (n, 2) present places of its nodes, and lengths (n,) of the edges asked for there [m].
    closed, kept
        (n,) nodes in contact, and those that may not move.
    fill
        What makes the triangles.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((1.0, 1.0), cells=(2, 2), cell="tri6")
    >>> none = np.zeros(mesh.n_nodes, dtype=bool)
    >>> new = plane_mesh(mesh, mesh.points, np.full(mesh.n_nodes, 0.5), none, none).mesh
    >>> len(new.nodes("left")), round(float(new.points[new.nodes("left"), 0].max()), 12)
    (5, 0.0)
    """
    border = outline(old, places, sizes, closed, kept)
    field = SizeField(blocks=old.blocks, places=places, sizes=sizes, points=border.points, limits=border.limits)
    found = fill(border.points, border.sides, field)
    if found is None:
        return None
    cell = next(iter(old.blocks))
    curved, straight = (_meshed(cell, found, border, bent) for bent in (True, False))
    mesh, middles = curved if curved[0] is not None else straight
    if mesh is None:
        return None
    count = mesh.n_nodes
    asked = SizeField(blocks=old.blocks, places=places, sizes=sizes, points=places, limits=np.full(len(places), np.inf))

    def spread(nodes: BoolArray, sides: BoolArray) -> BoolArray:
        out = np.zeros(count, dtype=bool)
        out[: len(nodes)] = nodes
        if len(middles):
            out[middles[sides]] = True
        return out

    tags = {t: np.flatnonzero(spread(nodes, border.side_tags[t])) for t, nodes in border.node_tags.items()}
    surface = np.isin(np.arange(old.n_nodes), old.nodes("surface"))
    near = cKDTree(mesh.points)
    for tag, nodes in old.tags.items():
        if not surface[nodes].any():
            tags[tag] = near.query(places[nodes])[1]
    mesh = Mesh(points=mesh.points, blocks=mesh.blocks, tags=tags, regions=carried_regions(old, places, mesh))
    touching, stays = spread(border.touching, border.touching_sides), spread(border.kept, border.kept_sides)
    return NewMesh(mesh=mesh, sizes=asked.at(mesh.points), touching=touching & ~stays, kept=stays)


def moved_mesh(mesh: Mesh, points: Array) -> Mesh | None:
    """The mesh with its nodes at the points (n, d); None if a cell is degenerate."""
    try:
        return Mesh(points=points, blocks=mesh.blocks, tags=mesh.tags, regions=mesh.regions)
    except InputError:
        return None


def _meshed(cell: str, found: Filled, border: Outline, bent: bool) -> tuple[Mesh | None, IntArray]:
    """Mesh without tags, and the nodes (s,) in the middles of the sides, none in linear cells; with curved sides if
    ``bent``, and None if that degenerates a cell.
    """
    points, cells, middles = found.points, found.triangles, np.zeros(0, dtype=np.int64)
    if cell == "tri6":
        points, cells, ends = quadratic_simplices(points, cells)
        number = {(int(a), int(b)): k for k, (a, b) in enumerate(np.sort(ends, axis=1))}
        middles = len(found.points) + np.array([number[min(a, b), max(a, b)] for a, b in border.sides.tolist()])
        if bent:
            points = np.array(points)
            points[middles] = border.middles
    try:
        return Mesh(points=points, blocks={cell: cells}), middles
    except InputError:
        return None, middles


def carried_regions(old: Mesh, places: Array, new: Mesh) -> dict[str, IntArray]:
    """Regions of the cells of a new mesh: those of the old cells that are nearest.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> coarse = rectangle((1.0, 1.0), cells=(2, 1)).with_region("left", lambda x: x[:, 0] < 0.5)
    >>> carried_regions(coarse, coarse.points, rectangle((1.0, 1.0), cells=(4, 1)))["left"].tolist()
    [0, 1]
    """
    if not old.regions:
        return {}
    (cells,) = old.blocks.values()
    nearest = cKDTree(places[cells[:, : old.dim + 1]].mean(axis=1)).query(new.centres())[1]
    return {name: np.flatnonzero(np.isin(nearest, numbers)) for name, numbers in old.regions.items()}
