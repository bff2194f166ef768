"""Mesh of tetrahedra for the present shape of a body, within its boundary."""

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from softway.adaptivity.new_cells.plane_mesh import NewMesh, carried_regions
from softway.adaptivity.new_cells.sizes import SizeField
from softway.adaptivity.new_cells.swaps import regular
from softway.adaptivity.new_cells.tet_swaps import FACES, Tets, collapsed, edges_swapped, faces_swapped, halved
from softway.adaptivity.rezoning.smoothing import moved
from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.meshes.generators.lattice import quadratic_simplices
from softway.meshes.mesh import Mesh

Improver = Callable[[Array, IntArray, IntArray, Array], tuple[Array, IntArray]]
"""Points and tetrahedra from others with the same boundary, whose points come first; and lengths of the edges."""
ROUNDS = 8
"""Greatest number of rounds of changes and motions."""
LONG, SHORT = 2.0, 0.5
"""Lengths of edges, relative to those asked for, that are halved and collapsed."""


def improved_tetrahedra(points: Array, tetrahedra: IntArray, kept: IntArray, sizes: Array) -> tuple[Array, IntArray]:
    """Points (m, 3) and tetrahedra (t, 4) within the same boundary, whose points are the first ones.

    Rounds of halved and collapsed edges, swaps of faces and edges, and motion of the points inside towards least
    distortion.

    Parameters
    ----------
    points, tetrahedra
        (n, 3) points [m] and tetrahedra (t, 4).
    kept
        (k,) numbers of the points on the boundary.
    sizes
        (n,) lengths of the edges asked for [m].

    Examples
    --------
    >>> from softway.meshes.generators.shapes import box
    >>> mesh = box((1.0, 1.0, 1.0), cells=(2, 2, 2), cell="tet4")
    >>> new = improved_tetrahedra(mesh.points, mesh.blocks["tet4"], mesh.nodes("surface"), np.full(27, 0.5))
    >>> bool(np.array_equal(new[0][:26], mesh.points[mesh.nodes("surface")]))
    True
    """
    rest = np.setdiff1d(np.arange(len(points)), kept)
    order = np.concatenate([kept, rest])
    place = np.empty(len(points), dtype=np.int64)
    place[order] = np.arange(len(points))
    x, cells, lengths = points[order], place[tetrahedra], sizes[order].tolist()
    rim, surface = np.arange(len(kept)), _surface_edges(cells)
    for k in range(ROUNDS):
        tets = Tets.of(x, cells)
        changes = 0
        if 0 < k < 3:
            changes += halved(tets, surface, LONG, lengths) + collapsed(tets, set(rim.tolist()), SHORT, lengths)
        changes += faces_swapped(tets) + edges_swapped(tets, surface)
        used = sorted({corner for cell in tets.cells.values() for corner in cell})
        lengths = [lengths[n] for n in used]
        x, cells = tets.arrays()
        found = moved(regular(cells), x, rim, x[rim])
        x = x if found is None else found
        if k > 2 and not changes:
            break
    return x, cells


def _surface_edges(cells: IntArray) -> set[tuple[int, int]]:
    """Edges on the boundary, rising."""
    faces = np.sort(cells[:, np.array(FACES)].reshape(-1, 3), axis=1)
    single, count = np.unique(faces, axis=0, return_counts=True)
    return {edge for a, b, c in single[count == 1].tolist() for edge in ((a, b), (b, c), (a, c))}


def space_mesh(
    old: Mesh, places: Array, sizes: Array, closed: BoolArray, kept: BoolArray, improve: Improver = improved_tetrahedra
) -> NewMesh | None:
    """Mesh of tetrahedra for the present shape of a mesh of tetrahedra, with its boundary and its tags; None if its
    cells do not fit.

    Parameters
    ----------
    old
        The old mesh, of tet4 or tet10.
    places, sizes
        (n, 3) present places of its nodes, and lengths (n,) of the edges asked for there [m].
    closed, kept
        (n,) nodes in contact, and those that may not move.
    improve
        What makes the tetrahedra.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import box
    >>> mesh = box((1.0, 1.0, 1.0), cells=(2, 2, 2), cell="tet10")
    >>> none = np.zeros(mesh.n_nodes, dtype=bool)
    >>> new = space_mesh(mesh, mesh.points, np.full(mesh.n_nodes, 0.5), none, none).mesh
    >>> len(new.nodes("left")) == len(mesh.nodes("left"))
    True
    """
    ((cell, nodes),) = old.blocks.items()
    corners, surface = np.unique(nodes[:, :4]), old.nodes("surface")
    number = np.full(old.n_nodes, -1)
    number[corners] = np.arange(len(corners))
    rim = np.intersect1d(surface, corners)
    points, cells = improve(places[corners], number[nodes[:, :4]], number[rim], sizes[corners])
    source = np.full(len(points), -1)
    source[: len(rim)] = rim
    if cell == "tet10":
        points, cells, ends = quadratic_simplices(points, cells)
        source = np.concatenate([source, _middles(nodes, surface, source, ends)])
        points[source >= 0] = places[source[source >= 0]]
    try:
        mesh = Mesh(points=points, blocks={cell: cells})
    except InputError:
        return None
    place = np.full(old.n_nodes, -1)
    place[source[source >= 0]] = np.flatnonzero(source >= 0)
    near = cKDTree(points)
    tags = {}
    for tag, tagged in old.tags.items():
        found = place[tagged]
        tags[tag] = found[found >= 0] if (found >= 0).any() else near.query(places[tagged])[1]
    mesh = Mesh(points=points, blocks=mesh.blocks, tags=tags, regions=carried_regions(old, places, mesh))
    free = np.full(old.n_nodes, np.inf)
    field = SizeField(blocks=old.blocks, places=places, sizes=sizes, points=places, limits=free)
    touching, stays = (np.append(flags, False)[source] for flags in (closed & ~kept, kept))
    return NewMesh(mesh=mesh, sizes=field.at(points), touching=touching, kept=stays)


def _middles(nodes: IntArray, surface: IntArray, source: IntArray, ends: IntArray) -> IntArray:
    """Old nodes (m,) on the boundary in the middles of new edges (m, 2); -1 inside."""
    pairs = np.array(CELLS["tet10"].edges)
    outer = np.isin(nodes[:, 4:], surface)
    rows, columns = np.nonzero(outer)
    known = np.sort(nodes[rows[:, None], pairs[columns]], axis=1)
    middle = dict(zip(map(tuple, known.tolist()), nodes[rows, 4 + columns].tolist(), strict=True))
    wanted = np.sort(source[ends], axis=1).tolist()
    return np.array([middle.get((a, b), -1) for a, b in wanted], dtype=np.int64)
