"""Values of fields at nodes off their cells: on a curved boundary finer cells reach beyond larger ones."""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.meshes.adaptive.nodes.leaf_nodes import node_places
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.cells import CELLS

NEAR = 1e-12
"""Distance of a node from the place of its shape functions, relative to the size of the body, that is rounding."""


def extended(values: sp.csr_array, one: AdaptedMesh, other: AdaptedMesh) -> sp.csr_array:
    """Values (m, n) at the m nodes of a mesh of the fields of another one, n nodes, with their gradients to the nodes.

    The shape functions ``values`` are those at the same place in the base cell.  Where a node X lies off it, the
    gradient of the cell is added: ``u(X) = u_h + grad u_h (X - X_h)``.  So affine fields, such as rotations, are exact.

    Parameters
    ----------
    values
        (m, n) shape functions of ``one`` at the nodes of ``other``.
    one, other
        The meshes.
    """
    if one.base.rounding is None:
        return values
    away = other.mesh.points - values @ one.mesh.points
    size = float(np.linalg.norm(np.ptp(one.mesh.points, axis=0)))
    nodes = np.flatnonzero(np.abs(away).max(axis=1) > NEAR * size)
    if not len(nodes):
        return values
    leaf, place = _in_leaves(values, one, other, nodes)
    columns = next(iter(one.mesh.blocks.values()))[leaf]
    slopes = np.einsum("kcd,kd->kc", gradients(one.cell, place, one.mesh.points[columns]), away[nodes])
    rows = np.repeat(nodes, columns.shape[1])
    return sp.csr_array(values + sp.csr_array((slopes.ravel(), (rows, columns.ravel())), shape=values.shape))


def _in_leaves(values: sp.csr_array, one: AdaptedMesh, other: AdaptedMesh, nodes: IntArray) -> tuple[IntArray, Array]:
    """Leaves (k,) of ``one`` around some nodes (k,) of ``other``, and the places (k, c) there, of corners and in
    quadrilaterals and hexahedra of their linear shape functions.
    """
    leaf, local = _first(other)
    leaf, local = leaf[nodes], local[nodes]
    around = one.leaves.around(other.leaves.start[leaf])
    own = node_places(other.cell, other.place[leaf])[np.arange(len(leaf)), local]
    place = np.asarray(np.linalg.solve(one.place[around].swapaxes(1, 2), own[:, :, None])[:, :, 0], float)
    outer = other.leaves.level[leaf] < one.leaves.level[around]  # a node of both meshes
    if outer.any():
        known, corner = _first(one)
        same = values[nodes[outer]].argmax(axis=1)
        around[outer], place[outer] = known[same], np.eye(place.shape[1])[corner[same]]
    return around, place


def _first(adapted: AdaptedMesh) -> tuple[IntArray, IntArray]:
    """First leaf (n,) with each node, and its number there (n,)."""
    rows = next(iter(adapted.mesh.blocks.values()))
    first = np.unique(rows.ravel(), return_index=True)[1]
    return np.divmod(first, rows.shape[1])


def gradients(name: str, place: Array, corners: Array) -> Array:
    """Gradients (k, c, d) of the shape functions of linear cells with ``corners`` (k, c, d) at places (k, c), given by
    the shape functions there [1/m].

    Examples
    --------
    >>> square = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]])
    >>> gradients("quad4", np.full((1, 4), 0.25), square)[0].tolist()
    [[-0.25, -0.5], [0.25, -0.5], [0.25, 0.5], [-0.25, 0.5]]
    """
    own = CELLS[name].nodes
    d = own.shape[1]
    if CELLS[name].simplex:
        slopes = np.broadcast_to(np.vstack([-np.ones(d), np.eye(d)]), (len(place), d + 1, d))
    else:
        x = (place @ own)[:, None]
        parts = np.where(own == 1.0, x, 1.0 - x)
        others = [np.delete(parts, k, axis=2).prod(axis=2) for k in range(d)]
        slopes = np.stack(others, axis=2) * (2.0 * own - 1.0)
    jacobian = np.einsum("kcd,kcr->kdr", corners, slopes)
    return np.asarray(np.einsum("kcr,krd->kcd", slopes, np.linalg.inv(jacobian)))
