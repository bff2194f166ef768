"""Facets of larger cells beside smaller ones, found from the places of their nodes: they are no boundary."""

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS

NEAR = 1e-9
"""Distance of a node from the middle of a facet, relative to the distance of its corners, at which it is there."""
DIAGONALS = {2: ((0, 1),), 4: ((0, 2), (1, 3))}
"""Corners of a facet that a facet of half its size has at the corner and at the middle of it, by number of corners."""


def beside_smaller(points: Array, owner: IntArray, name: str, facets: IntArray) -> BoolArray:
    """Facets (f,) of one cell each that lie beside cells of the same body of half or double their size.

    Parameters
    ----------
    points, owner
        (n, d) places of the nodes at rest [m], (n,) numbers of their bodies.
    name, facets
        Name and nodes (f, a) of facets that belong to one cell.

    Examples
    --------
    >>> points = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [2.0, 1.0]])
    >>> edges = np.array([[0, 1], [2, 0], [1, 2], [1, 3]])
    >>> beside_smaller(points, np.zeros(4, int), "bar2", edges).tolist()
    [True, True, True, False]
    """
    count = CELLS[name].corners
    out = np.zeros(len(facets), dtype=bool)
    if count not in DIAGONALS or not len(facets):
        return out
    corners = facets[:, :count]
    size = np.linalg.norm(points[corners[:, 0]] - points[corners[:, count // 2]], axis=1)
    known = np.unique(corners)
    tree = cKDTree(np.column_stack([points[known], owner[known] * float(size.max())]))
    middle = np.column_stack([_middles(name, points[facets]), owner[corners[:, 0]] * float(size.max())])
    distance, nearest = tree.query(middle)
    larger = np.flatnonzero(distance <= NEAR * size)
    pairs = np.concatenate([corners[:, ends] for ends in DIAGONALS[count]])
    codes = _codes(pairs, len(points))
    order = np.argsort(codes)
    at_middle = np.repeat(known[nearest[larger], None], count, axis=1)
    wanted = _codes(np.stack([at_middle, corners[larger]], axis=-1), len(points))
    place = order[np.minimum(np.searchsorted(codes[order], wanted), len(codes) - 1)]
    whole = (codes[place] == wanted).all(axis=1)
    out[larger[whole]] = True
    out[place[whole] % len(facets)] = True
    return out


def _middles(name: str, nodes: Array) -> Array:
    """Middles (f, d) of facets with ``nodes`` (f, a, d)."""
    if name in ("bar3", "quad9"):
        return nodes[:, -1]
    if name == "quad8":
        return np.asarray(0.5 * nodes[:, 4:].sum(axis=1) - 0.25 * nodes[:, :4].sum(axis=1))
    return np.asarray(nodes.mean(axis=1))


def _codes(pairs: IntArray, count: int) -> IntArray:
    """One number (...,) for each pair of nodes (..., 2)."""
    return np.asarray(pairs.min(axis=-1) * count + pairs.max(axis=-1))
