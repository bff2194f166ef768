"""Overlap of two deformed solids, computed from their cells alone, independently of the contact algorithm."""

from itertools import combinations

import numpy as np

import softway as sw
from softway.arrays import Array, IntArray

SIMPLICES = {
    "tri3": ((0, 1, 2),),
    "quad4": ((0, 1, 2), (0, 2, 3)),
    "tet4": ((0, 1, 2, 3),),
    "hex8": ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)),
}
EDGES = {name: tuple({pair for s in parts for pair in combinations(s, 2)}) for name, parts in SIMPLICES.items()}


def simplices(mesh: sw.Mesh) -> IntArray:
    """Nodes (s, d + 1) of the simplices that form the cells."""
    return np.concatenate([cells[:, part] for name, cells in mesh.blocks.items() for part in SIMPLICES[name]])


def points_on(mesh: sw.Mesh, x: Array, pieces: int = 8) -> Array:
    """Points (p, d) along all edges of the simplices of a mesh whose nodes are at x (n, d)."""
    pairs = np.concatenate([cells[:, pair] for name, cells in mesh.blocks.items() for pair in EDGES[name]])
    a, b = np.moveaxis(x[np.unique(np.sort(pairs, axis=1), axis=0)], 1, 0)
    share = np.linspace(0.0, 1.0, pieces + 1)[:, None, None]
    return np.asarray(a + share * (b - a)).reshape(-1, x.shape[1])


def depth(points: Array, mesh: sw.Mesh, x: Array) -> float:
    """Greatest depth [m] of points (p, d) in a nearly convex body, zero if none is inside.

    The depth of a point is its distance to the nearest facet plane.

    >>> mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)).build()
    >>> [round(depth(np.array([[a, 0.4]]), mesh, mesh.points), 12) for a in (-0.1, 0.1, 0.5)]
    [0.0, 0.1, 0.4]
    """
    points = points[((points >= x.min(axis=0)) & (points <= x.max(axis=0))).all(axis=1)]
    corners = x[simplices(mesh)]
    inverse = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
    share = np.einsum("sij,spj->spi", inverse, points[None] - corners[:, :1])
    inside = points[((share >= 0.0).all(axis=2) & (share.sum(axis=2) <= 1.0)).any(axis=0)]
    heights = [
        np.abs(np.einsum("pfi,fi->pf", inside[:, None] - x[f[:, 0]], _normals(x[f]))) for f in mesh.boundary().values()
    ]
    return float(np.concatenate(heights, axis=1).min(axis=1).max(initial=0.0))


def _normals(corners: Array) -> Array:
    """Unit normals (f, d) of facets (f, b, d)."""
    side = corners[:, 1] - corners[:, 0]
    if corners.shape[2] == 2:
        normal = side[:, ::-1] * np.array([1.0, -1.0])
    else:
        normal = np.cross(side, corners[:, 2] - corners[:, 0])
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))


def overlap(one: tuple[sw.Mesh, Array], two: tuple[sw.Mesh, Array]) -> float:
    """Greatest depth [m] of either body in the other; a body is a mesh with its node positions (n, d)."""
    return max(depth(points_on(*one), *two), depth(points_on(*two), *one))
