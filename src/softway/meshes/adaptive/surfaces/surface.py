"""Smooth surface through the boundary nodes of a mesh (docs/theory/bodies/adaptive.md#curved-boundaries)."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.adapt import SMOOTH
from softway.meshes.adaptive.nodes.middles import edge_codes
from softway.meshes.adaptive.refinement import BISECTED, leaf_places
from softway.meshes.adaptive.rounded.volumes import moments_by_root, stretches
from softway.meshes.adaptive.surfaces.fitted import fitted_normals
from softway.meshes.adaptive.surfaces.patches import (
    Patches,
    around_nodes,
    corner_normals,
    crease_tangents,
    patches_of,
)
from softway.meshes.adaptive.tree import tree_of
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.meshes.topology import Rounding

FLAT = 1e-9
"""Angle between an edge and the surface below which it is straight [rad]."""
ROUND = float(np.radians(80.0))
"""The same for round shapes of softway, whose coarsest meshes have greater angles than 30 degrees [rad]."""
SQUEEZED = 0.3
"""Volume of a leaf, relative to that in the straight base cell, below which the curve of its base cell is left out."""


def rounded(mesh: Mesh, smooth: float = SMOOTH, radial: bool = False) -> Mesh:
    """Base mesh whose refinements follow a smooth surface through its boundary nodes; itself where nothing is curved.

    Facets of linear cells that meet at angles of at most ``smooth`` form a smooth surface.  Edges that would squeeze
    a cell stay straight.

    Parameters
    ----------
    mesh
        The mesh.
    smooth
        Greatest angle [rad].
    radial
        True for a body of revolution about the axis y.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import disc
    >>> fine = refined(rounded(disc(1.0, 4, cell="tri3")), np.full(32, 4)).mesh
    >>> np.linalg.norm(fine.points[fine.nodes("boundary")], axis=1).round(12).tolist() == [1.0] * 64
    True
    """
    name = next(iter(mesh.blocks))
    if len(mesh.blocks) > 1 or name not in BISECTED or CELLS[name].order > 1 or mesh.cell_dim == 1 or smooth <= 0.0:
        return mesh
    rounding = _surface(mesh, smooth, radial)
    while len(rounding.edges) + len(rounding.facets):
        cells = _curved(mesh, rounding)
        some, kept = _part(mesh, rounding, cells)
        squeezed, moments, bulge = _examined(replace(some, rounding=kept), radial)
        if not squeezed.any():
            whole = np.full((mesh.n_cells, 1 + mesh.dim), np.nan)
            whole[cells] = moments
            most = np.zeros(mesh.n_cells)
            most[cells] = bulge
            return replace(mesh, rounding=replace(rounding, moments=whole, bulge=most))
        rounding = _without(mesh, rounding, cells[squeezed])
    return mesh


def _surface(mesh: Mesh, smooth: float, radial: bool) -> Rounding:
    """Smooth surface of a mesh."""
    found = patches_of(mesh, smooth)
    node, patch, number = around_nodes(found)
    normals = _normals(mesh, found, node, number)
    n, d = mesh.points.shape
    slot = np.arange(len(node)) - np.searchsorted(node, node)
    slots = int(slot.max()) + 1
    patches, by_slot = np.full((n, slots), -1), np.full((n, slots, d), np.nan)
    patches[node, slot], by_slot[node, slot] = patch, normals
    rims = found.rims[(found.pairs >= 0).all(axis=1)] if d == 3 else np.zeros((0, 2), dtype=np.int64)
    two = found.patch[found.pairs[(found.pairs >= 0).all(axis=1)]] if d == 3 else np.zeros((0, 2), dtype=np.int64)
    crease = two[:, 0] != two[:, 1]
    tangents = crease_tangents(mesh.points, rims[crease], smooth)
    bent = _bent(mesh, found, normals, number)
    if d == 2:
        edges, sides = found.facets[bent], np.column_stack([found.patch, np.full(len(found.patch), -1)])[bent]
        facets, on = np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=np.int64)
    else:
        curved = _curved_edges(mesh, found, (rims, two), bent, tangents)
        edges, sides = rims[curved], np.where((crease[:, None]) | (np.arange(2) == 0), two, -1)[curved]
        facets, on = found.facets[bent], found.patch[bent]
    return Rounding(
        patches=patches, normals=by_slot, tangents=tangents, edges=np.sort(edges, axis=1)[:, ::-1], sides=sides,
        facets=np.sort(facets, axis=1)[:, ::-1], on=on, moments=np.full((mesh.n_cells, 1 + d), np.nan),
        bulge=np.zeros(mesh.n_cells), radial=radial,
    )  # fmt: skip


def _normals(mesh: Mesh, found: Patches, node: IntArray, number: IntArray) -> Array:
    """Normals (p, d) at the pairs of a node and a patch; not a number at ends of patches in the plane."""
    total = np.zeros((len(node), mesh.dim))
    np.add.at(total, number.ravel(), corner_normals(mesh.points[found.facets]).reshape(-1, mesh.dim))
    total /= np.linalg.norm(total, axis=1, keepdims=True)
    if mesh.dim == 3:
        return fitted_normals(mesh.points, node, number, total)
    inner = found.rims[found.joined].ravel()
    total[~np.isin(node, inner)] = np.nan
    return total


def _bent(mesh: Mesh, found: Patches, normals: Array, number: IntArray) -> BoolArray:
    """True (f,) for facets with normals that are not all those of a plane."""
    apart = np.abs(normals[number] - found.normals[:, None]).max(axis=2)
    return np.asarray((apart > FLAT).any(axis=1))


def _curved_edges(
    mesh: Mesh, found: Patches, rims: tuple[IntArray, IntArray], bent: BoolArray, tangents: Array
) -> BoolArray:
    """True (r,) for the edges ``rims``, nodes and patches (r, 2), that are curved: in bent facets, or in a line with a
    bend.
    """
    ends, two = rims
    along = mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    beside = 1.0 - np.abs((tangents[ends] * along[:, None]).sum(axis=2))
    line = np.nan_to_num(beside, nan=0.0).max(axis=1) > 0.5 * FLAT**2
    pairs = found.pairs[(found.pairs >= 0).all(axis=1)]
    return np.where(two[:, 0] != two[:, 1], line, bent[pairs].any(axis=1))


def _curved(mesh: Mesh, rounding: Rounding) -> IntArray:
    """Cells (k,) with a curved edge or facet."""
    name, cells = next(iter(mesh.blocks.items()))
    edges = np.array(CELLS[name].edges)
    known = [rounding.edges]
    c = rounding.facets.shape[1]
    known += [rounding.facets[:, [i, j]] for i in range(c) for j in range(i)] if mesh.dim == 3 else []
    return np.flatnonzero(np.isin(edge_codes(cells[:, edges]), edge_codes(np.concatenate(known))).any(axis=1))


def _part(mesh: Mesh, rounding: Rounding, chosen: IntArray) -> tuple[Mesh, Rounding]:
    """Mesh of some cells with its surface."""
    name, cells = next(iter(mesh.blocks.items()))
    nodes, rows = np.unique(cells[chosen], return_inverse=True)
    number = np.zeros(mesh.n_nodes, dtype=np.int64)
    number[nodes] = np.arange(len(nodes))
    kept = replace(
        rounding,
        patches=rounding.patches[nodes],
        normals=rounding.normals[nodes],
        tangents=rounding.tangents[nodes],
        edges=number[rounding.edges],
        facets=number[rounding.facets],
        moments=rounding.moments[chosen],
        bulge=rounding.bulge[chosen],
    )
    return Mesh(points=mesh.points[nodes], blocks={name: rows.reshape(len(chosen), -1)}), kept


def _examined(mesh: Mesh, radial: bool) -> tuple[BoolArray, Array, Array]:
    """Cells (e,) that the curve squeezes, and moments (e, 1 + d) and bulge (e,) of the body in each, from two
    refinements.
    """
    bulge = np.zeros(mesh.n_cells)
    (name, cells), squeezed = next(iter(mesh.blocks.items())), np.zeros(mesh.n_cells, dtype=bool)
    moments = [moments_by_root(mesh, mesh.points, cells, np.arange(mesh.n_cells), radial)[:, 0]]
    for halvings in (1, 2):
        tree = tree_of(mesh)
        tree = tree.grown(tree.leaves, np.full(mesh.n_cells, halvings * mesh.dim))
        found, straight = leaf_places(tree), leaf_places(replace(tree, base=replace(mesh, rounding=None)))
        ratio = stretches(found.points, name, found.nodes) / stretches(straight.points, name, straight.nodes)
        squeezed[tree.leaves.root[(ratio < SQUEEZED).any(axis=1)]] = True
        away = np.linalg.norm(found.points - straight.points, axis=1)
        np.maximum.at(bulge, tree.leaves.root, away[found.nodes].max(axis=1))
        moments.append(moments_by_root(mesh, found.points, found.nodes, tree.leaves.root, radial)[:, 0])
    once = [fine + (fine - coarse) / 3.0 for coarse, fine in pairwise(moments)]
    return squeezed, once[1] + (once[1] - once[0]) / 15.0, bulge


def _without(mesh: Mesh, rounding: Rounding, cells: IntArray) -> Rounding:
    """Surface without the curves at some cells, and without those no further from them than they are long."""
    centres = cKDTree(mesh.centres()[cells])
    near = []
    for rows in (rounding.edges, rounding.facets):
        corners = mesh.points[rows]
        middle = corners.mean(axis=1, keepdims=True)
        reach = 2.0 * np.linalg.norm(corners - middle, axis=2).max(axis=1, initial=0.0)
        near.append(centres.query(middle[:, 0])[0] <= reach)
    edges, facets = ~near[0], ~near[1]
    inside = _inside(mesh, rounding, cells)
    edges, facets = edges & ~inside[0], facets & ~inside[1]
    return replace(
        rounding,
        edges=rounding.edges[edges],
        sides=rounding.sides[edges],
        facets=rounding.facets[facets],
        on=rounding.on[facets],
    )


def _inside(mesh: Mesh, rounding: Rounding, cells: IntArray) -> tuple[BoolArray, BoolArray]:
    """True (k,), (f,) for the edges of some cells, and for facets with two corners in one of them."""
    name, nodes = next(iter(mesh.blocks.items()))
    known = edge_codes(nodes[cells][:, np.array(CELLS[name].edges)]).ravel()
    rows, c = rounding.facets, rounding.facets.shape[1]
    sides = [np.isin(edge_codes(rows[:, [i, j]]), known) for i in range(c) for j in range(i)]
    return np.isin(edge_codes(rounding.edges), known), np.any(sides, axis=0)
