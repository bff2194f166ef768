"""Liquid part of simplices that the temperature of melting cuts (docs/theory/heat/phase.md)."""

from itertools import permutations, product

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS, FLAT

_GAUSS = tuple(np.polynomial.legendre.leggauss(k // 2 + 2) for k in range(5))
"""Places and weights on [-1, 1] for simplices of k corners."""
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


def melted_part(over: Array, width: float) -> tuple[Array, Array]:
    """Integrals (s, k) of shape function times liquid share over simplices, and their derivatives (s, k, k) [1/K].

    Both are per volume of the simplex.  The share rises smoothly from zero at melting to one at ``width`` above it, as
    x^2 (3 - 2 x).  The integrals are means of those over the parts above the temperatures in between, which are
    polynomials between the temperatures of the corners, so that they are exact.  The derivatives are symmetric.

    Parameters
    ----------
    over
        (s, k) temperatures of the corners above melting [K]; a corner at melting is solid.
    width
        Range of temperatures in which matter melts [K], positive.

    Examples
    --------
    A bar that is liquid over a quarter of its length, and one that is in the middle of the range:

    >>> part, slopes = melted_part(np.array([[1.0, -3.0], [5e-10, 5e-10]]), 1e-9)
    >>> part.round(6).tolist(), round(float(slopes[1].sum()) * 1e-9, 6)
    ([[0.21875, 0.03125], [0.25, 0.25]], 1.5)
    """
    s, k = over.shape
    part = np.full((s, k), 1.0 / k) * (over.min(axis=1) >= width)[:, None]
    slopes = np.zeros((s, k, k))
    cut = np.flatnonzero((over.max(axis=1) > 0.0) & (over.min(axis=1) < width))
    ends = np.sort(np.column_stack([np.zeros(len(cut)), np.clip(over[cut] / width, 0.0, 1.0), np.ones(len(cut))]))
    place, weight = _GAUSS[k]
    length = np.diff(ends)[:, :, None]
    levels = ends[:, :-1, None] + 0.5 * length * (1.0 + place)
    weights = 0.5 * length * weight
    inside = np.nonzero(weights)
    at, level, weigh = cut[inside[0]], levels[inside][:, None], weights[inside]
    both = liquid_part(over[at] / width - level)
    np.add.at(part, at, (weigh[:, None] * 6.0 * level * (1.0 - level)) * both.sum(axis=2))
    np.add.at(slopes, at, (weigh[:, None] * (6.0 - 12.0 * level))[:, :, None] * both / width)
    return part, slopes


def liquid_part(over: Array) -> Array:
    """Integrals (s, k, k) of products of two shape functions over the part of simplices above zero, per volume.

    Parameters
    ----------
    over
        (s, k) values of the corners; zero is below.

    Examples
    --------
    Three quarters of a bar:

    >>> liquid_part(np.array([[-1.0, 3.0]])).sum()
    np.float64(0.75)
    """
    s, k = over.shape
    liquid = over > 0.0
    count = liquid.sum(axis=1)
    whole = _products(np.eye(k)[None])
    part = np.where(count == k, 1.0, 0.0)[:, None, None] * whole
    one, rest = np.flatnonzero(count == 1), np.flatnonzero((count == k - 1) & (count > 1))
    part[one] = _corner(over[one], liquid[one])
    part[rest] = whole - _corner(-over[rest], ~liquid[rest])
    if k == 4:
        two = np.flatnonzero(count == 2)
        part[two] = _wedge(over[two], liquid[two])
    return part


def _corner(over: Array, apart: BoolArray) -> Array:
    """Part at the one corner that is ``apart`` (s, k), above zero where the others are not."""
    s, k = over.shape
    order = np.argsort(~apart, axis=1, kind="stable")
    sorted_over = np.take_along_axis(over, order, axis=1)
    cuts = sorted_over[:, :1] / (sorted_over[:, :1] - sorted_over[:, 1:])
    points = np.zeros((s, k, k))
    points[:, 0, 0] = 1.0
    points[:, 1:, 0] = 1.0 - cuts
    points[:, np.arange(1, k), np.arange(1, k)] = cuts
    return _back(cuts.prod(axis=1)[:, None, None] * _products(points), order)


def _wedge(over: Array, liquid: BoolArray) -> Array:
    """Part of tetrahedra with two liquid corners."""
    s = len(over)
    order = np.argsort(~liquid, axis=1, kind="stable")
    t = np.take_along_axis(over, order, axis=1)
    corner = np.broadcast_to(np.eye(4), (s, 4, 4))
    cut = {(a, c): _between(t, a, c) for a in (0, 1) for c in (2, 3)}
    p, q = (corner[:, 0], cut[0, 2], cut[0, 3]), (corner[:, 1], cut[1, 2], cut[1, 3])
    part = np.zeros((s, 4, 4))
    for tet in ((*p, q[2]), (p[0], p[1], q[1], q[2]), (p[0], *q)):
        corners = np.stack(tet, axis=1)
        part += np.abs(np.linalg.det(corners))[:, None, None] * _products(corners)
    return _back(part, order)


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


def _back(part: Array, order: IntArray) -> Array:
    """Values (s, k, k) of sorted corners in the order before the sort."""
    place = np.argsort(order, axis=1)
    return part[np.arange(len(part))[:, None, None], place[:, :, None], place[:, None, :]]


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
