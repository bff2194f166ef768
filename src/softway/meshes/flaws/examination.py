"""Examination of a mesh: cells that overlap, nodes that hang on facets, and parts that nothing holds together."""

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray
from softway.errors import InputError, Note
from softway.meshes.cells import FLAT
from softway.meshes.flaws.hinges import hinges
from softway.meshes.flaws.overlapping_cells import check_overlap, near_pairs
from softway.meshes.mesh import Mesh
from softway.meshes.topology import described

COINCIDENT = 1e-6
"""Distance of two nodes, or of a node and a facet, relative to the shortest edge, below which they coincide."""


def examined(mesh: Mesh, glued: Sequence[tuple[str, str]] = ()) -> tuple[Note, ...]:
    """Notes on a mesh that can be computed, although it may not be the intended one.

    Ties hold the pairs of tags ``glued`` together.

    Raises
    ------
    InputError
        For cells that overlap, and for nodes on a facet of the same part that are not nodes of the facet.

    Examples
    --------
    Two squares that touch, but share no node:

    >>> points = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [1, 0], [2, 0], [2, 1], [1, 1]])
    >>> print(examined(Mesh(points=points, blocks={"quad4": np.arange(8).reshape(2, 4)}))[0].problem)
    2 parts that share no node; they touch at 4 nodes, where nothing holds them together
    """
    part = _parts(mesh)
    if mesh.cell_dim < mesh.dim:
        return _loose_parts(_joined(mesh, part, glued), np.zeros(0, int))
    check_overlap(mesh)
    surface = np.unique(np.concatenate([facets.ravel() for facets in mesh.boundary().values()]))
    pairs = cKDTree(mesh.points[surface]).query_pairs(COINCIDENT * mesh.edge(), output_type="ndarray")
    same = surface[pairs.astype(np.int64)]
    apart = surface if mesh.hanging is None else np.setdiff1d(surface, mesh.hanging.node)
    touching = _touching(mesh, part, apart) if mesh.dim > 1 else np.zeros(0, int)
    other = part[same[:, 0]] != part[same[:, 1]]
    free = np.setdiff1d(np.append(same[other].ravel(), touching), _tagged(mesh, glued))
    notes = _loose_parts(_joined(mesh, part, glued), free)
    return (*notes, *_cracks(mesh, np.unique(same[~other])), *_hinges(mesh))


def _parts(mesh: Mesh) -> IntArray:
    """Number (n,) of the part of each node; parts share no node."""
    rows = np.concatenate([np.repeat(cells[:, 0], cells.shape[1]) for cells in mesh.blocks.values()])
    columns = np.concatenate([cells.ravel() for cells in mesh.blocks.values()])
    graph = coo_array((np.ones(len(rows), dtype=bool), (rows, columns)), shape=(mesh.n_nodes, mesh.n_nodes))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _joined(mesh: Mesh, part: IntArray, glued: Sequence[tuple[str, str]]) -> IntArray:
    """Number (n,) of the part of each node, where glued parts are one."""
    for pair in glued:
        met = part[_tagged(mesh, [pair])]
        part = np.where(np.isin(part, met), met[0], part)
    return np.unique(part, return_inverse=True)[1].ravel()


def _tagged(mesh: Mesh, pairs: Sequence[tuple[str, str]]) -> IntArray:
    """Nodes (k,) of pairs of tags."""
    return np.concatenate([np.zeros(0, int), *(mesh.nodes(tag) for pair in pairs for tag in pair)])


def _touching(mesh: Mesh, part: IntArray, surface: IntArray) -> IntArray:
    """Boundary nodes (k,) on facets of other parts; refuses nodes on facets of their own part."""
    node, on = _on_pieces(mesh, _flat_pieces(mesh), surface)
    hanging = part[node] == part[on]
    if hanging.any():
        first = int(node[hanging].min())
        count = len(np.unique(node[hanging]))
        raise InputError(
            "points",
            f"node {first} at {described(mesh.points[first])} lies on a facet, but is not a node of it; "
            f"{count} such {'node' if count == 1 else 'nodes'}: the cells are not connected there",
            "a mesh whose neighbouring cells share whole facets; a body of its own for each part that only touches",
        )
    return np.unique(node)


def _flat_pieces(mesh: Mesh) -> tuple[tuple[IntArray, IntArray], ...]:
    """Flat pieces (p, d) of the boundary facets, and all nodes (p, b) of their facets, for each kind."""
    return tuple(
        (np.concatenate([nodes[:, list(piece)] for piece in FLAT[kind]]), np.tile(nodes, (len(FLAT[kind]), 1)))
        for kind, nodes in mesh.boundary().items()
    )


def _on_pieces(
    mesh: Mesh, pieces: tuple[tuple[IntArray, IntArray], ...], surface: IntArray
) -> tuple[IntArray, IntArray]:
    """Nodes (k,) of the surface that lie on a piece without being at a node of its facet, and a node (k,) of it."""
    slack, found, on = COINCIDENT * mesh.edge(), [], []
    for corners, nodes in pieces:
        x = mesh.points[corners]
        centre = x.mean(axis=1)
        radii = np.linalg.norm(x - centre[:, None], axis=-1).max(axis=1) + slack
        point, piece = near_pairs(mesh.points[surface], centre, radii)
        node = surface[point]
        apart = np.linalg.norm(mesh.points[nodes[piece]] - mesh.points[node][:, None], axis=-1).min(axis=1) > slack
        node, piece = node[apart], piece[apart]
        near = _distance(x[piece], mesh.points[node]) <= slack
        found.append(node[near])
        on.append(nodes[piece[near], 0])
    return np.concatenate(found), np.concatenate(on)


def _distance(corners: Array, points: Array) -> Array:
    """Distance (p,) of points (p, d) from flat pieces (p, d, d); infinite where they project beyond the piece."""
    legs = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    away = points - corners[:, 0]
    local = np.einsum("pkd,pd->pk", np.linalg.pinv(legs), away)
    off: Array = np.linalg.norm(away - np.einsum("pdk,pk->pd", legs, local), axis=1)
    beyond = (local.min(axis=1) < -COINCIDENT) | (local.sum(axis=1) > 1.0 + COINCIDENT)
    return np.where(beyond, np.inf, off)


def _loose_parts(part: IntArray, touching: IntArray) -> tuple[Note, ...]:
    """Note on parts that share no node."""
    count = int(part.max()) + 1
    if count == 1:
        return ()
    met = f"; they touch at {len(touching)} nodes, where nothing holds them together" if len(touching) else ""
    remedy = "merge the nodes (in Gmsh: Coherence), or a body of its own for each part, with a contact between them"
    return (Note(where="mesh", problem=f"{count} parts that share no node{met}", remedy=remedy),)


def _cracks(mesh: Mesh, nodes: IntArray) -> tuple[Note, ...]:
    """Note on nodes of one part that coincide: a crack."""
    if not len(nodes):
        return ()
    problem = f"{len(nodes)} nodes coincide with others of the same part, as at {described(mesh.points[nodes[0]])}"
    remedy = "merge the nodes (in Gmsh: Coherence), unless a crack is meant"
    return (Note(where="mesh", problem=f"{problem}: a crack, which nothing holds together", remedy=remedy),)


def _hinges(mesh: Mesh) -> tuple[Note, ...]:
    """Note on nodes and edges at which cells meet that share no facet there."""
    nodes = hinges(mesh) if mesh.dim > 1 and mesh.hanging is None else np.zeros(0, int)
    if not len(nodes):
        return ()
    what = "nodes" if mesh.dim == 2 else "nodes and edges"
    problem = f"cells meet only at {what}, {len(nodes)} of them, as at {described(mesh.points[nodes[0]])}: hinges"
    remedy = "cells that share whole facets, so that the surface has one normal at a node"
    return (Note(where="mesh", problem=f"{problem} without stiffness", remedy=remedy),)
