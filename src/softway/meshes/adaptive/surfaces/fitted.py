"""Normals of surfaces in space by fits, exact on spheres and circular cylinders."""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray

ROUNDS = 4
"""Fits, each in the frame of the normal before."""
FEWEST = 6
"""Least number of nodes around one for a fit."""
RANK = 1e-9
"""Eigenvalue of the equations of a fit, relative to the greatest, below which they do not determine a direction."""


def fitted_normals(points: Array, node: IntArray, corners: IntArray, normals: Array) -> Array:
    """Normals (p, 3) of patches at nodes, from rough ones; not a number where too few nodes are around.

    Over the plane across the rough normal the surface is ``z = g x + x K x + k z^2``, with the nodes up to two facets
    away on the same patch; the last term makes circular cylinders and spheres exact.

    Parameters
    ----------
    points
        (n, 3) nodes [m].
    node
        (p,) node of each pair of a node and a patch.
    corners
        (f, c) pairs at the corners of the facets.
    normals
        (p, 3) rough unit normals.
    """
    near, weight = _neighbours(len(node), corners)
    d = (points[node[near]] - points[node][:, None]) * weight[..., None]
    size = np.sqrt((d**2).sum(axis=(1, 2)) / np.maximum(weight.sum(axis=1), 1.0))
    d /= np.where(size > 0.0, size, 1.0)[:, None, None]
    for _ in range(ROUNDS):
        t1, t2 = _frames(normals)
        x, y, z = ((d * axis[:, None]).sum(axis=2) for axis in (t1, t2, normals))
        terms = np.stack([x, y, x**2, x * y, y**2, z**2], axis=2)
        inverse = np.linalg.pinv(np.einsum("pki,pkj->pij", terms, terms), rcond=RANK, hermitian=True)
        g1, g2 = np.einsum("pij,pkj,pk->pi", inverse, terms, z).T[:2]
        normals = normals - g1[:, None] * t1 - g2[:, None] * t2
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[weight.sum(axis=1) < FEWEST] = np.nan
    return normals


def _neighbours(count: int, corners: IntArray) -> tuple[IntArray, Array]:
    """Pairs (p, k) up to two facets away from each, filled with itself, and 1 (p, k) where there is one."""
    f, c = corners.shape
    on = sp.csr_array((np.ones(f * c), (corners.ravel(), np.repeat(np.arange(f), c))), shape=(count, f))
    near = sp.csr_array(on @ on.T)
    near = sp.csr_array(near @ near)
    near.setdiag(0.0)
    near.eliminate_zeros()
    near.sort_indices()
    sizes = np.diff(near.indptr)
    out = np.repeat(np.arange(count)[:, None], max(1, int(sizes.max(initial=0))), axis=1)
    place = np.arange(near.nnz) - np.repeat(near.indptr[:-1], sizes)
    rows = np.repeat(np.arange(count), sizes)
    out[rows, place] = near.indices
    weight = np.zeros(out.shape)
    weight[rows, place] = 1.0
    return out, weight


def _frames(normals: Array) -> tuple[Array, Array]:
    """Unit vectors (p, 3) across unit normals (p, 3), by the axis that is least along them."""
    axis = np.eye(3)[np.abs(normals).argmin(axis=1)]
    one = np.cross(normals, axis)
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    return one, np.cross(normals, one)
