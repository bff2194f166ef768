"""Edges across walls one linear cell thick (docs/theory/bodies/mass.md)."""

from itertools import product

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.mesh import Mesh
from softway.meshes.thickness import outer_facets

WALLS = ("quad4", "hex8", "tri3", "tet4")
"""Cells of whose walls the edges are found: linear ones, which have no nodes inside."""
FACING = -0.5
"""Product of the normals of two facets below which they are on opposite sides of a wall of triangles or tetrahedra."""


def wall_edges(mesh: Mesh, touching: IntArray) -> IntArray:
    """Edges (k, 2) across walls one cell thick, on at least one side of which all nodes of a facet may touch.

    A wall of quadrilaterals or hexahedra is a cell with two opposite facets on the boundary.  A wall of triangles or
    tetrahedra has edges that connect facets of the boundary with opposite normals through the body.

    Parameters
    ----------
    mesh
        Mesh with cells that fill the space.
    touching
        (t,) numbers of the nodes that may touch.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> strip = rectangle((2.0, 0.1), (2, 1))
    >>> wall_edges(strip, strip.nodes("bottom")).tolist()
    [[0, 3], [1, 4], [2, 5]]
    >>> wall_edges(rectangle((2.0, 0.1), (2, 2)), np.arange(9)).tolist()
    []
    """
    if mesh.dim == 1 or mesh.cell_dim < mesh.dim or not len(touching):
        return np.zeros((0, 2), int)
    touches = np.zeros(mesh.n_nodes, bool)
    touches[touching] = True
    found = [np.zeros((0, 2), int)]
    for cell in WALLS:
        if cell in mesh.blocks:
            across = _across_simplices if CELLS[cell].simplex else _across_blocks
            found.append(across(mesh, cell, touches))
    return np.unique(np.sort(np.concatenate(found), axis=1), axis=0)


def parallel_edges(cell: str) -> IntArray:
    """Local nodes (d, b, 2) of the edges of ``quad4`` or ``hex8`` along each axis of the reference cell.

    Examples
    --------
    >>> parallel_edges("quad4").tolist()
    [[[0, 1], [3, 2]], [[0, 3], [1, 2]]]
    """
    nodes, edges = CELLS[cell].nodes, np.array(CELLS[cell].edges)
    along = nodes[edges[:, 1]] - nodes[edges[:, 0]]
    forward = np.where(along.sum(axis=1, keepdims=True) > 0.0, edges, edges[:, ::-1])
    return np.array([np.unique(forward[along[:, axis] != 0.0], axis=0) for axis in range(nodes.shape[1])])


def _across_blocks(mesh: Mesh, cell: str, touches: BoolArray) -> IntArray:
    """Edges (k, 2) of quadrilaterals or hexahedra with two opposite facets on the boundary."""
    cells, nodes = mesh.blocks[cell], CELLS[cell].nodes
    local = np.array([facet for _, facet in FACETS[cell]])
    on = outer_facets(mesh, cell)
    may = np.asarray(touches[cells[:, local]].all(axis=2))
    found = []
    for axis, edges in enumerate(parallel_edges(cell)):
        low, high = (int(np.flatnonzero((nodes[local, axis] == end).all(axis=1))[0]) for end in (0.0, 1.0))
        wall = on[:, low] & on[:, high] & (may[:, low] | may[:, high])
        found.append(cells[wall][:, edges].reshape(-1, 2))
    return np.concatenate(found)


def _across_simplices(mesh: Mesh, cell: str, touches: BoolArray) -> IntArray:
    """Edges (k, 2) of triangles or tetrahedra that connect facets of the boundary with opposite normals."""
    facets = mesh.boundary().get(FACETS[cell][0][0], np.zeros((0, mesh.dim), int))
    surface = np.zeros(mesh.n_nodes, bool)
    surface[facets] = True
    edges = mesh.blocks[cell][:, np.array(CELLS[cell].edges)].reshape(-1, 2)
    edges = np.unique(np.sort(edges[surface[edges].all(axis=1)], axis=1), axis=0)
    return edges[_opposite(mesh.points, facets, edges, np.asarray(touches[facets].all(axis=1)))]


def _opposite(points: Array, facets: IntArray, edges: IntArray, may: BoolArray) -> BoolArray:
    """True for edges (k, 2) that cross the body between facets of opposite normals, one of which ``may`` (f,) touch."""
    normal, around = _normals(points, facets), _facets_around(facets, len(points))
    along = points[edges[:, 1]] - points[edges[:, 0]]
    out = np.zeros(len(edges), bool)
    for one, other in product(range(around.shape[1]), repeat=2):
        f, g = around[edges[:, 0], one], around[edges[:, 1], other]
        facing = np.einsum("ki,ki->k", normal[f], normal[g]) < FACING
        inside = (np.einsum("ki,ki->k", normal[f], along) < 0.0) & (np.einsum("ki,ki->k", normal[g], along) > 0.0)
        out |= (f >= 0) & (g >= 0) & facing & inside & (may[f] | may[g])
    return out


def _normals(points: Array, facets: IntArray) -> Array:
    """Outward unit normals (f, d) of segments or triangles."""
    x = points[facets]
    if points.shape[1] == 2:
        along = x[:, 1] - x[:, 0]
        normal = np.column_stack([along[:, 1], -along[:, 0]])
    else:
        normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))


def _facets_around(facets: IntArray, count: int) -> IntArray:
    """Numbers (n, m) of the facets around each node, filled with -1."""
    node, number = facets.ravel(), np.repeat(np.arange(len(facets)), facets.shape[1])
    order = np.argsort(node, kind="stable")
    sizes = np.bincount(node, minlength=count)
    place = np.arange(len(node)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    out = np.full((count, int(sizes.max(initial=0))), -1)
    out[node[order], place] = number[order]
    return out
