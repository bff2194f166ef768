"""Nodal fields on a mesh that replaces another one."""

from collections.abc import Mapping

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.inertia.mass_matrix import Consistent, assembled, body_of
from softway.kernels.geometry.jacobians import cell_geometry
from softway.meshes.cells import CELLS
from softway.meshes.element import element, exact_degree

NEAR = 24
"""Simplices near a place among which the one around it is looked for."""
PORTION = 20_000
"""Points that are looked for at once."""
_SIMPLICES = {
    3: ((0, 1, 2),),
    4: ((0, 1, 2), (0, 2, 3)),
    8: ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)),
}


def simplices(blocks: Mapping[str, IntArray]) -> IntArray:
    """Simplices (s, d + 1) of the corners of cells, that fill the cells.

    Examples
    --------
    >>> simplices({"quad4": np.array([[0, 1, 3, 2]])}).tolist()
    [[0, 1, 3], [0, 3, 2]]
    """
    parts = []
    for cell, nodes in blocks.items():
        it = CELLS[cell]
        split = ((0, 1, 2, 3),) if it.dim == 3 and it.corners == 4 else _SIMPLICES[it.corners]
        parts.append(nodes[:, np.array(split)].reshape(-1, it.dim + 1))
    return np.concatenate(parts)


def interpolation(blocks: Mapping[str, IntArray], places: Array, points: Array) -> sp.csr_array:
    """Matrix (m, n) of the values at points (m, d) of nodal fields, linear in the simplices of the cells.

    Points outside get the values of the nearest simplex, continued.

    Parameters
    ----------
    blocks, places
        Cells, and places (n, d) of their nodes [m].
    points
        (m, d) points [m].

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> found = interpolation({"quad4": np.array([[0, 1, 2, 3]])}, square, np.array([[0.25, 0.5]]))
    >>> (found @ square).round(12).tolist()
    [[0.25, 0.5]]
    """
    nodes, values = _nearest(simplices(blocks), places, points)
    return _rows(nodes, values, len(places))


def within_simplices(cells: IntArray, places: Array, points: Array) -> sp.csr_array:
    """Matrix (m, n) of the values at points (m, d) of nodal fields, linear in simplices ``cells`` (s, d + 1).

    Points outside get values of the nearest simplex, with shares that are not negative: within those of its nodes.

    Examples
    --------
    >>> triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    >>> within_simplices(np.array([[0, 1, 2]]), triangle, np.array([[0.5, -1.0]])).toarray().tolist()
    [[0.75, 0.25, 0.0]]
    """
    nodes, values = _nearest(cells, places, points)
    inside = np.maximum(values, 0.0)
    return _rows(nodes, inside / inside.sum(axis=1, keepdims=True), len(places))


def _nearest(cells: IntArray, places: Array, points: Array) -> tuple[IntArray, Array]:
    """Nodes (m, d + 1) of the simplices around points (m, d), and their shares there."""
    x, count = places[cells], min(NEAR, len(cells))
    tree, inverse = cKDTree(x.mean(axis=1)), np.asarray(np.linalg.inv(np.swapaxes(x[:, 1:] - x[:, :1], 1, 2)), float)
    found = [_around(tree, count, x[:, 0], inverse, part) for part in _portions(points)]
    which, shares = (np.concatenate(part) for part in zip(*found, strict=True))
    return cells[which], shares


def _portions(points: Array) -> list[Array]:
    """Points (m, d) in portions that fit into the memory."""
    return [points[k : k + PORTION] for k in range(0, max(len(points), 1), PORTION)]


def _around(tree: cKDTree, count: int, origin: Array, inverse: Array, points: Array) -> tuple[IntArray, Array]:
    """Simplices (m,) around points (m, d), and the shares (m, d + 1) of their nodes."""
    near = tree.query(points, k=count)[1].reshape(len(points), count)
    inner = np.einsum("mkij,mkj->mki", inverse[near], points[:, None] - origin[near])
    shares = np.concatenate([1.0 - inner.sum(axis=2, keepdims=True), inner], axis=2)
    best = shares.min(axis=2).round(12).argmax(axis=1)
    row = np.arange(len(points))
    return near[row, best], shares[row, best]


def _rows(nodes: IntArray, values: Array, count: int) -> sp.csr_array:
    """Matrix (m, n) with the values (m, k) at the nodes (m, k)."""
    where = np.repeat(np.arange(len(nodes)), nodes.shape[1]), nodes.ravel()
    return sp.csr_array((values.ravel(), where), shape=(len(nodes), count))


def projected(before: DiscreteSolid, places: Array, after: DiscreteSolid, field: Array) -> Array:
    """Projection (m, d) with the consistent mass of a field (n, d) of a solid to a mesh of its present shape.

    The field is sampled at the quadrature points of the new mesh; supported components have its values at the nodes.

    Parameters
    ----------
    before, places
        The solid on the old mesh, and the present places (n, d) of its nodes [m].
    after
        The solid on the new mesh.
    field
        (n, d) nodal field: velocity, acceleration.
    """
    mesh, section = after.mesh, after.internal.section
    values = np.asarray(interpolation(before.mesh.blocks, places, mesh.points) @ field)
    right = np.zeros_like(values)
    for cell, cells in mesh.blocks.items():
        table = element(cell, exact_degree(cell))
        x = mesh.points[cells]
        at = np.einsum("qa,ead->eqd", table.N, x)
        weights = cell_geometry(x, table.dN, table.weights)[1] * section.measure(at)
        sampled = interpolation(before.mesh.blocks, places, at.reshape(-1, at.shape[2])) @ field
        own = np.einsum("qa,ead->eqd", table.N, values[cells])
        missing = weights[..., None] * (np.asarray(sampled).reshape(own.shape) - own)
        np.add.at(right, cells, np.einsum("qa,eqd->ead", table.N, missing))
    mass = assembled(body_of(mesh, section, 1.0), Consistent(), np.ones(mesh.n_nodes))
    wide = sp.csc_array(sp.kron(mass, sp.eye_array(mesh.dim), format="csc"))
    dofs = after.dofs
    return np.asarray(values + dofs.nodes(splu(sp.csc_array(dofs.matrix(wide))).solve(dofs.forces(right))))
