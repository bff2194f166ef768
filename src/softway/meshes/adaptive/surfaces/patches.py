"""Patches of the boundary of a mesh: facets that meet at small angles, and the edges between them."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Patches:
    """Boundary of a mesh of linear cells.

    Parameters
    ----------
    facets
        (f, c) nodes of the facets, facing outward.
    normals
        (f, d) their unit normals.
    patch
        (f,) their patches.
    rims, joined
        (r, c) what facets have in common: edges in space, nodes in the plane; and True (r,) where they meet at a small
        angle.
    pairs
        (r, 2) both facets of each; -1 where there are not two.
    """

    facets: IntArray
    normals: Array
    patch: IntArray
    rims: IntArray
    joined: BoolArray
    pairs: IntArray


def patches_of(mesh: Mesh, smooth: float) -> Patches:
    """Patches of the boundary of a mesh, with angles of at most ``smooth`` [rad] between neighbours.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> found = patches_of(rectangle((1.0, 1.0), (2, 2)), 0.5)
    >>> len(np.unique(found.patch)), int(found.joined.sum())
    (4, 4)
    """
    ((_, facets),) = mesh.boundary().items()
    normals = facet_normals(mesh.points[facets])
    count, c = facets.shape
    local = [[k, (k + 1) % c] for k in range(c)] if mesh.dim == 3 else [[k] for k in range(c)]
    every = np.sort(facets[:, local].reshape(count * len(local), -1), axis=1)
    rims, number = np.unique(every, axis=0, return_inverse=True)
    order = np.argsort(number.ravel(), kind="stable")
    owner, sizes = order // len(local), np.bincount(number.ravel())
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    two = sizes == 2
    pairs = np.full((len(rims), 2), -1)
    pairs[two] = np.column_stack([owner[first[two]], owner[first[two] + 1]])
    joined = two.copy()
    joined[two] = (normals[pairs[two, 0]] * normals[pairs[two, 1]]).sum(axis=1) >= np.cos(smooth)
    links = sp.coo_array((np.ones(int(joined.sum())), pairs[joined].T), shape=(count, count))
    patch = connected_components(links, directed=False)[1].astype(np.int64)
    return Patches(facets=facets, normals=normals, patch=patch, rims=rims, joined=joined, pairs=pairs)


def facet_normals(corners: Array) -> Array:
    """Unit normals (f, d) of facets with ``corners`` (f, c, d), those of quadrilaterals by their diagonals."""
    c, d = corners.shape[1:]
    if d == 2:
        along = corners[:, 1] - corners[:, 0]
        out = np.column_stack([along[:, 1], -along[:, 0]])
    else:
        one, two = ((2, 0), (3, 1)) if c == 4 else ((1, 0), (2, 0))
        out = np.cross(corners[:, one[0]] - corners[:, one[1]], corners[:, two[0]] - corners[:, two[1]])
    return np.asarray(out / np.linalg.norm(out, axis=1, keepdims=True))


def corner_normals(corners: Array) -> Array:
    """Shares (f, c, d) of facets in the normals at their corners: their sum at a node is exact on a circle or sphere.

    References
    ----------
    Max (1999), J. Graphics Tools 4 (2), 1-6.
    """
    if corners.shape[2] == 2:
        length = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
        return np.repeat((facet_normals(corners) / length[:, None])[:, None], 2, axis=1)
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    squares = (after**2).sum(axis=2) * (before**2).sum(axis=2)
    return np.asarray(np.cross(after, before) / squares[..., None])


def crease_tangents(points: Array, ends: IntArray, smooth: float) -> Array:
    """Tangents (n, d) of lines of edges ``ends`` (k, 2) at nodes (n, d), exact on circles; not a number at their ends,
    where lines meet, and at corners of more than ``smooth`` [rad].
    """
    n, d = points.shape
    out = np.full((n, d), np.nan)
    both = np.concatenate([ends, ends[:, ::-1]])
    both = both[np.argsort(both[:, 0], kind="stable")]
    count = np.bincount(both[:, 0], minlength=n)
    start = np.concatenate([[0], np.cumsum(count)])
    nodes = np.flatnonzero(count == 2)
    one, two = (points[both[start[nodes] + k, 1]] - points[nodes] for k in (0, 1))
    lengths = [np.linalg.norm(way, axis=1) for way in (one, two)]
    straight = -(one * two).sum(axis=1) / (lengths[0] * lengths[1])
    tangent = two / lengths[1][:, None] ** 2 - one / lengths[0][:, None] ** 2
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    soft = straight >= np.cos(smooth)
    out[nodes[soft]] = tangent[soft]
    return out


def around_nodes(found: Patches) -> tuple[IntArray, IntArray, IntArray]:
    """Pairs (p,) of a node and a patch at it, and the number (f, c) of the pair at each corner of the facets."""
    both = np.column_stack([found.facets.ravel(), np.repeat(found.patch, found.facets.shape[1])])
    pairs, number = np.unique(both, axis=0, return_inverse=True)
    return pairs[:, 0], pairs[:, 1], number.reshape(found.facets.shape)
