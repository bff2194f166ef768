"""A place of a body in its adapted meshes: the nodes around it, and their shape functions there."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.adaptive.nodes.leaf_nodes import shape_functions
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

CLOSE = 1e-9
"""Distance from a node of the base mesh, relative to the size of the body, at which a place is that node."""
PASSES = 60
"""Passes of Newton's method with the derivative of the linear map in the middle of each cell."""
WIDE, FEW = 1.5, 16
"""Radius of a curved cell, relative to the distance of its nodes from its middle, and least number of cells tried."""


def around(adapted: AdaptedMesh, point: Array) -> tuple[IntArray, Array]:
    """Nodes (k,) of the cell around a place (d,) of the body at rest [m], and their shape functions (k,) there.

    The place belongs to a base cell, whatever the present leaves are, so that values there have no jumps where the mesh
    is refined.  Of a place outside of the body one inside near it is taken; a node of the base mesh is itself.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import interval
    >>> fine = refined(interval(1.0, cells=2), np.array([1, 0]))
    >>> nodes, weights = around(fine, np.array([0.3]))
    >>> fine.mesh.points[nodes, 0].tolist(), weights.round(12).tolist()
    ([0.25, 0.5], [0.8, 0.2])
    >>> around(fine, np.array([1.0]))
    (array([2]), array([1.]))
    """
    base, x = adapted.base, np.asarray(point, float)
    distance = np.linalg.norm(base.points - x, axis=1)
    nearest = int(np.argmin(distance))
    if distance[nearest] <= CLOSE * _size(base):
        return np.array([nearest]), np.ones(1)
    root, local = _in_base(base, x)
    leaves = np.flatnonzero(adapted.leaves.root == root)
    corners = adapted.place[leaves] @ _corners(adapted.cell)
    from_first = (local - corners[:, 0])[:, :, None]
    inside = np.asarray(np.linalg.solve(_derivative(adapted.cell, corners), from_first)[:, :, 0], float)
    own = _first(_depth(adapted.cell, inside), 1.0)
    nodes = next(iter(adapted.mesh.blocks.values()))[leaves[own]]
    return nodes, shape_functions(adapted.cell, _place(adapted.cell, inside[own]))


def _in_base(base: Mesh, x: Array) -> tuple[int, Array]:
    """Base cell around a place (d,), and the coordinates (k,) of the place in the reference cell."""
    name, rows = next(iter(base.blocks.items()))
    cells = _near(base.points[rows], x)
    nodes = base.points[rows[cells]]
    inverse = np.linalg.pinv(_derivative(name, nodes[:, : CELLS[name].corners]))
    local = np.tile(_corners(name).mean(axis=0), (len(cells), 1))
    for _ in range(PASSES):
        rest = x - np.einsum("ea,eai->ei", shape_functions(name, _place(name, local)), nodes)
        local = _clipped(name, local + np.einsum("eki,ei->ek", inverse, rest))
    away = np.linalg.norm(x - np.einsum("ea,eai->ei", shape_functions(name, _place(name, local)), nodes), axis=1)
    own = _first(-away, _size(base))
    return int(cells[own]), local[own]


def _near(nodes: Array, x: Array) -> IntArray:
    """Cells with ``nodes`` (e, a, d) that may be around a place (d,); in rising order."""
    middle = nodes.mean(axis=1)
    radius = np.linalg.norm(nodes - middle[:, None], axis=2).max(axis=1)
    beyond = np.linalg.norm(middle - x, axis=1) - WIDE * radius
    most = np.sort(beyond)[min(FEW, len(beyond)) - 1]
    return np.flatnonzero(beyond <= max(most, 0.0))


def _corners(name: str) -> Array:
    """Corners (c, k) of the reference cell, the first one at the origin."""
    return np.asarray(CELLS[name].nodes[: CELLS[name].corners], float)


def _derivative(name: str, corners: Array) -> Array:
    """Derivative (e, d, k) of the linear map from the reference cell to given corners (e, c, d), in its middle."""
    own = _corners(name)
    if CELLS[name].simplex:
        return (corners[:, 1:] - corners[:, :1]).swapaxes(1, 2)
    signs = (2.0 * own - 1.0) / (0.5 * len(own))
    return np.einsum("ecd,ck->edk", corners, signs)


def _place(name: str, local: Array) -> Array:
    """Barycentric coordinates, or linear shape functions, (..., c) at places (..., k) of the reference cell."""
    if CELLS[name].simplex:
        return np.concatenate([1.0 - local.sum(axis=-1, keepdims=True), local], axis=-1)
    return np.asarray(np.where(_corners(name) == 1.0, local[..., None, :], 1.0 - local[..., None, :]).prod(axis=-1))


def _depth(name: str, local: Array) -> Array:
    """Least distance (...,) of places (..., k) of the reference cell from its facets; negative outside."""
    return np.asarray((_place(name, local) if CELLS[name].simplex else np.minimum(local, 1.0 - local)).min(axis=-1))


def _clipped(name: str, local: Array) -> Array:
    """Places (..., k) of the reference cell, moved into it where they are outside."""
    inside = np.clip(local, 0.0, 1.0)
    return inside / np.maximum(inside.sum(axis=-1, keepdims=True), 1.0) if CELLS[name].simplex else inside


def _first(values: Array, scale: float) -> int:
    """First place of the greatest of some values (k,), where differences of rounding do not count."""
    return int(np.flatnonzero(values >= values.max() - CLOSE * scale)[0])


def _size(base: Mesh) -> float:
    return float(np.linalg.norm(np.ptp(base.points, axis=0)))
