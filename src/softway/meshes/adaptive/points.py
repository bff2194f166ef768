"""A place of a body in its adapted meshes: the nodes around it, and their shape functions there."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.adaptive.leaf_nodes import shape_functions
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

CLOSE = 1e-9
"""Distance from a node of the base mesh, relative to the size of the body, at which a place is that node."""
PASSES = 20
"""Passes of Newton's method in cells of second order."""


def around(adapted: AdaptedMesh, point: Array) -> tuple[IntArray, Array]:
    """Nodes (k,) of the cell around a place (d,) of the body at rest [m], and their shape functions (k,) there.

    The place belongs to a base cell, whatever the present leaves are, so that values there have no jumps where the mesh
    is refined.  Of a place outside of the body the nearest one inside is taken; a node of the base mesh is itself.

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
    if distance[nearest] <= CLOSE * float(np.linalg.norm(np.ptp(base.points, axis=0))):
        return np.array([nearest]), np.ones(1)
    root, place = _in_base(base, x)
    leaves = np.flatnonzero(adapted.leaves.root == root)
    inside = np.einsum("c,ecd->ed", place, np.linalg.inv(adapted.place[leaves]))
    own = _first(inside.min(axis=1), 1.0)
    nodes = next(iter(adapted.mesh.blocks.values()))[leaves[own]]
    return nodes, shape_functions(adapted.cell, inside[own])


def _in_base(base: Mesh, x: Array) -> tuple[int, Array]:
    """Base cell around a place (d,), and its barycentric coordinates (c,) there."""
    name, rows = next(iter(base.blocks.items()))
    corners = base.points[rows[:, : CELLS[name].corners]]
    rest = np.einsum("eki,ei->ek", np.linalg.pinv((corners[:, 1:] - corners[:, :1]).swapaxes(1, 2)), x - corners[:, 0])
    place = _clipped(np.column_stack([1.0 - rest.sum(axis=1), rest]))
    away = np.linalg.norm(np.einsum("ec,eci->ei", place, corners) - x, axis=1)
    cell = _first(-away, float(np.linalg.norm(np.ptp(base.points, axis=0))))
    if CELLS[name].order == 1:
        return cell, place[cell]
    return cell, _curved(name, base.points[rows[cell]], x, place[cell])


def _first(values: Array, scale: float) -> int:
    """First place of the greatest of some values (k,), where differences of rounding do not count."""
    return int(np.flatnonzero(values >= values.max() - CLOSE * scale)[0])


def _curved(name: str, nodes: Array, x: Array, place: Array) -> Array:
    """Barycentric coordinates (c,) of a place (d,) in a cell of second order with ``nodes`` (a, d)."""
    corners = nodes[: len(place)]
    inverse = np.linalg.pinv((corners[1:] - corners[0]).T)
    for _ in range(PASSES):
        rest = inverse @ (x - shape_functions(name, place) @ nodes)
        place = _clipped(place + np.concatenate([[-rest.sum()], rest]))
    return place


def _clipped(place: Array) -> Array:
    """Barycentric coordinates (..., c) of places inside of the cell."""
    inside = np.maximum(place, 0.0)
    return np.asarray(inside / inside.sum(axis=-1, keepdims=True))
