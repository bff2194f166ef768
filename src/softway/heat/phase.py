"""Liquid part of simplices that the temperature of melting cuts (docs/theory/heat/phase.md)."""

from itertools import permutations, product

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS, FLAT

_TET10 = (
    *((0, 4, 6, 7), (1, 5, 4, 8), (2, 6, 5, 9), (3, 7, 9, 8)),
    *((6, 8, 4, 5), (6, 8, 5, 9), (6, 8, 9, 7), (6, 8, 7, 4)),
)


def simplices_of(cell: str) -> tuple[tuple[int, ...], ...]:
    """Division of a cell into simplices between its nodes; empty for ``hex20``, whose inner nodes are missing.

    Examples
    --------
    >>> simplices_of("bar3"), len(simplices_of("hex8")), len(simplices_of("hex27"))
    (((0, 2), (2, 1)), 6, 48)
    """
    match cell:
        case "tet4":
            return ((0, 1, 2, 3),)
        case "tet10":
            return _TET10
        case "hex8" | "hex27":
            return _kuhn(cell)
        case _:
            return FLAT.get(cell, ())


def liquid_part(over: Array) -> tuple[Array, Array]:
    """Integrals (s, k) of the shape functions over the liquid part of simplices, and their derivatives (s, k, k) [1/K].

    Both are per volume of the simplex.  The derivatives are integrals over the front, of two shape functions over the
    gradient of the temperature, and symmetric.

    Parameters
    ----------
    over
        (s, k) temperatures of the corners above melting [K]; a corner at melting is solid.

    Examples
    --------
    A bar that is liquid over a quarter of its length:

    >>> part, slopes = liquid_part(np.array([[1.0, -3.0]]))
    >>> part.tolist(), float(part.sum()), slopes[0].sum().tolist()
    ([[0.21875, 0.03125]], 0.25, 0.25)
    """
    s, k = over.shape
    liquid = over > 0.0
    count = liquid.sum(axis=1)
    part = np.where(count[:, None] == k, 1.0 / k, 0.0) * np.ones(k)
    slopes = np.zeros((s, k, k))
    one, rest = np.flatnonzero(count == 1), np.flatnonzero((count == k - 1) & (count > 1))
    part[one], slopes[one] = _corner(over[one], liquid[one])
    solid, slopes[rest] = _corner(-over[rest], ~liquid[rest])
    part[rest] = 1.0 / k - solid
    if k == 4:
        two = np.flatnonzero(count == 2)
        part[two], slopes[two] = _wedge(over[two], liquid[two])
    return part, slopes


def _corner(over: Array, apart: BoolArray) -> tuple[Array, Array]:
    """Part at the one corner that is ``apart`` (s, k) and above zero, and its derivatives."""
    s, k = over.shape
    order = np.argsort(~apart, axis=1, kind="stable")
    sorted_over = np.take_along_axis(over, order, axis=1)
    top, falls = sorted_over[:, 0], sorted_over[:, :1] - sorted_over[:, 1:]
    cuts = top[:, None] / falls
    points = np.zeros((s, k - 1, k))
    points[:, :, 0] = 1.0 - cuts
    points[:, np.arange(k - 1), np.arange(1, k)] = cuts
    share = cuts.prod(axis=1)
    part = points.sum(axis=1)
    part[:, 0] += 1.0
    grown = (k - 1) * top ** (k - 2) / falls.prod(axis=1)
    return _back(part * (share / k)[:, None], grown[:, None, None] * _products(points), order)


def _wedge(over: Array, liquid: BoolArray) -> tuple[Array, Array]:
    """Part of tetrahedra with two liquid corners, and its derivatives."""
    s = len(over)
    order = np.argsort(~liquid, axis=1, kind="stable")
    t = np.take_along_axis(over, order, axis=1)
    corner = np.broadcast_to(np.eye(4), (s, 4, 4))
    cut = {(a, c): _between(t, a, c) for a in (0, 1) for c in (2, 3)}
    p, q = (corner[:, 0], cut[0, 2], cut[0, 3]), (corner[:, 1], cut[1, 2], cut[1, 3])
    part, slopes = np.zeros((s, 4)), np.zeros((s, 4, 4))
    for tet in ((*p, q[2]), (p[0], p[1], q[1], q[2]), (p[0], *q)):
        corners = np.stack(tet, axis=1)
        part += np.abs(np.linalg.det(corners))[:, None] * corners.mean(axis=1)
    far = np.abs(t).argmax(axis=1)
    top, height = np.eye(4)[far][:, None, :], np.abs(t[np.arange(s), far])
    for triangle in ((p[1], p[2], q[2]), (p[1], q[2], q[1])):
        corners = np.stack(triangle, axis=1)
        area = 3.0 * np.abs(np.linalg.det(np.concatenate([corners, top], axis=1))) / height
        slopes += area[:, None, None] * _products(corners)
    return _back(part, slopes, order)


def _between(t: Array, a: int, c: int) -> Array:
    """Coordinates (s, 4) of the point at melting on the edge from corner a to corner c."""
    share = t[:, a] / (t[:, a] - t[:, c])
    point = np.zeros_like(t)
    point[:, a], point[:, c] = 1.0 - share, share
    return point


def _products(points: Array) -> Array:
    """Means (s, k, k) of the products of the coordinates over simplices with corners (s, m, k)."""
    m, total = points.shape[1], points.sum(axis=1)
    both = np.einsum("smi,smj->sij", points, points) + total[:, :, None] * total[:, None, :]
    return np.asarray(both / (m * (m + 1)))


def _back(part: Array, slopes: Array, order: IntArray) -> tuple[Array, Array]:
    """Values of sorted corners in the order before the sort."""
    place = np.argsort(order, axis=1)
    rows = np.arange(len(part))[:, None]
    return part[rows, place], slopes[rows[:, :, None], place[:, :, None], place[:, None, :]]


def _kuhn(cell: str) -> tuple[tuple[int, ...], ...]:
    """Six tetrahedra around a diagonal of each cube between the nodes."""
    order = CELLS[cell].order
    at = {tuple(place): k for k, place in enumerate(np.rint(order * CELLS[cell].nodes).astype(int).tolist())}
    found = []
    for low in product(range(order), repeat=3):
        for axes in permutations(range(3)):
            way = [np.array(low)]
            for axis in axes:
                way.append(way[-1] + np.eye(3, dtype=int)[axis])
            found.append(tuple(at[tuple(place.tolist())] for place in way))
    return tuple(found)
