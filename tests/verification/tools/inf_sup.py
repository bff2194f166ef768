"""The constant of Babuska and Brezzi of displacements with a pressure, on meshes whose boundary is fixed."""

import numpy as np
import scipy.sparse as sp

from softway.kernels.geometry.jacobians import cell_geometry
from softway.meshes.cells import CELLS
from softway.meshes.element import element, tabulate
from softway.meshes.mesh import Mesh


def constant(mesh: Mesh, pressure: str, *, without: int = 0) -> float:
    """``beta``: least of ``sup (p, div u)/(|p| |grad u|)`` over pressures without mean.

    Parameters
    ----------
    mesh
        Cells of one kind.
    pressure
        ``mean``: one number for each cell; ``corner``: linear between the corners.  ``bubble``: as ``corner``, with a
        displacement in the middle of each triangle or tetrahedron besides (MINI).
    without
        Number of the lowest modes that are left out.
    """
    (cell, nodes), (n, d) = next(iter(mesh.blocks.items())), mesh.points.shape
    table = element(cell, 6)
    gradients, weights, _ = cell_geometry(mesh.points[nodes], table.dN, table.weights)
    columns, count = nodes, n
    if pressure == "bubble":
        gradients, columns, count = _with_bubble(table.points, gradients, nodes, n)
    shapes, owners, size = _pressures(cell, table.points, nodes, n, pressure)
    K = _assembled(np.einsum("eqar,eqbr,eq->eab", gradients, gradients, weights), columns, columns, (count, count))
    W = _assembled(np.einsum("eqc,eqk,eq->eck", shapes, shapes, weights), owners, owners, (size, size))
    parts = np.einsum("eqc,eqar,eq->reca", shapes, gradients, weights)
    free = np.ones(count, bool)
    free[mesh.nodes("surface")] = False
    inverse = np.linalg.inv(K[free][:, free])
    S = np.zeros((size, size))
    for r in range(d):
        B = _assembled(parts[r], owners, columns, (size, count))[:, free]
        S += B @ inverse @ B.T
    used = np.diag(W) > 0.0
    L = np.linalg.cholesky(W[used][:, used])
    half = np.linalg.solve(L, np.linalg.solve(L, S[used][:, used]).T)
    values = np.linalg.eigvalsh(0.5 * (half + half.T))
    return float(np.sqrt(max(values[1 + without], 0.0)))  # the first belongs to the constant


def _pressures(cell, points, nodes, n, pressure):
    """Shapes (e, q, c) of the pressure, the numbers (e, c) of its unknowns, and how many there are."""
    e = len(nodes)
    if pressure == "mean":
        return np.ones((e, len(points), 1)), np.arange(e)[:, None], e
    name, corners = cell.rstrip("0123456789"), CELLS[cell].corners
    shapes = tabulate(f"{name}{corners}", points)[0]
    return np.broadcast_to(shapes, (e, *shapes.shape)), nodes[:, :corners], n


def _with_bubble(points, gradients, nodes, n):
    """One more node for each simplex, whose shape function is the product of all barycentric coordinates."""
    e, d = len(nodes), points.shape[1]
    N = np.concatenate([1.0 - points.sum(axis=1, keepdims=True), points], axis=1)
    others = np.stack([np.prod(np.delete(N, k, axis=1), axis=1) for k in range(d + 1)], axis=1)
    bubble = np.einsum("qa,eqar->eqr", others, gradients)[:, :, None]
    numbers = np.concatenate([nodes, n + np.arange(e)[:, None]], axis=1)
    return np.concatenate([gradients, bubble], axis=2), numbers, n + e


def _assembled(blocks, rows, columns, shape):
    at = np.broadcast_to(rows[:, :, None], blocks.shape), np.broadcast_to(columns[:, None], blocks.shape)
    return sp.coo_array((blocks.ravel(), (at[0].ravel(), at[1].ravel())), shape=shape).toarray()
