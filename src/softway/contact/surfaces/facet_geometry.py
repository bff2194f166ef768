"""Geometry of facets: closest points, shape functions and outward normals for every kind of facet.

Straight segments and triangles have closed forms.  The other facets are polynomials: Newton's method finds their feet
from the nearest node.  If the foot is outside the facet, the closest point of its edges replaces it.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.geometry import curved_facets
from softway.kernels.geometry.closest_points import dot, on_segments, on_triangles
from softway.meshes.cells import CELLS

BEYOND = 0.25
"""Distance beyond its edges up to which a facet is continued as a polynomial, in local coordinates."""
AWAY = 1.0
"""Distance from the reference cell beyond which a foot is not followed any further."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetKind:
    """Shape functions ``N_k = sum_m coefficients[m, k] prod_j xi_j^powers[m, j]`` of one kind of facet.

    Parameters
    ----------
    powers
        (b, r) exponents.
    coefficients
        (b, b).
    edge, edges
        Kind of the edges, and their nodes (k, 2 or 3) on the facet.
    """

    powers: IntArray
    coefficients: Array
    edge: str
    edges: IntArray

    def shapes(self, local: Array, derivative: tuple[int, ...]) -> Array:
        """Shape functions (p, b) at local coordinates (p, r), or their derivatives."""
        return _table(local, self.powers, derivative) @ self.coefficients

    def terms(self, nodes: Array) -> Array:
        """Coefficients (b, d, p) of the powers for facets with nodes at (p, b, d)."""
        return np.ascontiguousarray(np.tensordot(self.coefficients, nodes.transpose(1, 2, 0), axes=1))


def _table(local: Array, powers: IntArray, derivative: tuple[int, ...]) -> Array:
    """Values (p, b) of the powers."""
    out = np.empty((len(powers), len(local)))
    for row, (factor, values) in zip(out, curved_facets.monomials(local.T, powers, derivative), strict=True):
        row[:] = factor if values is None else factor * values
    return out.T


@cache
def kind_of(name: str) -> FacetKind:
    """Shape functions of a kind of facet.

    Examples
    --------
    >>> kind_of("bar3").shapes(np.array([[0.25]]), (0,)).tolist()
    [[0.375, -0.125, 0.75]]
    """
    cell = CELLS[name]
    coefficients = np.linalg.inv(_table(cell.nodes, cell.powers, (0,) * cell.dim))
    edges = [[*pair, _middle(cell.nodes, pair)] if cell.order == 2 else pair for pair in cell.edges]
    return FacetKind(
        powers=cell.powers,
        coefficients=np.where(np.abs(coefficients) < 1e-13, 0.0, coefficients),
        edge="bar3" if cell.order == 2 else "bar2",
        edges=np.array(edges, dtype=np.int64).reshape(len(cell.edges), cell.order + 1),
    )


def _middle(nodes: Array, pair: tuple[int, int]) -> int:
    return int(np.abs(nodes - nodes[list(pair)].mean(axis=0)).sum(axis=1).argmin())


def on_facets(kind: str, x: Array, nodes: Array) -> Array:
    """Local coordinates (p, r) of the closest points of facets, one facet for each point.

    Parameters
    ----------
    kind
        ``point1 bar2 bar3 tri3 tri6 quad4 quad8 quad9``.
    x
        (p, d) points [m].
    nodes
        (p, b, d) nodes of the facets [m].

    Examples
    --------
    >>> square = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]])
    >>> on_facets("quad4", np.array([[0.5, 9.0, 1.0]]), square).round(12).tolist()
    [[0.25, 1.0]]
    """
    if kind == "point1":
        return np.zeros((len(x), 0))
    if kind == "bar2":
        return on_segments(x, nodes[:, 0], nodes[:, 1])[:, 1:]
    if kind == "tri3":
        return on_triangles(x, nodes[:, 0], nodes[:, 1], nodes[:, 2])[:, 1:]
    if kind == "bar3":
        return _feet(kind, x, nodes, 0.0, 1.0)
    local = _feet(kind, x, nodes, -AWAY, 1.0 + AWAY)
    out = np.flatnonzero(~_inside(kind, local))
    local[out] = _on_edges(kind, x[out], nodes[out])
    return local


def _feet(kind: str, x: Array, nodes: Array, low: float, high: float) -> Array:
    """Local coordinates (p, r) of feet by Newton's method from the nearest node."""
    table = kind_of(kind)
    away = nodes - x[:, None, :]
    start = CELLS[kind].nodes[np.einsum("pbd,pbd->pb", away, away).argmin(axis=1)]
    return np.ascontiguousarray(curved_facets.feet(x.T, table.powers, table.terms(nodes), start.T, low, high).T)


def _inside(kind: str, local: Array) -> BoolArray:
    """True for feet (p,) in the reference cell."""
    far = 1.0 - local.sum(axis=1) if CELLS[kind].simplex else 1.0 - local.max(axis=1)
    return np.asarray((local.min(axis=1) >= 0.0) & (far >= 0.0))


def _on_edges(kind: str, x: Array, nodes: Array) -> Array:
    """Local coordinates (p, 2) of the closest point of the edges of each facet."""
    table, reference = kind_of(kind), CELLS[kind].nodes
    p, k, d = len(x), len(table.edges), x.shape[1]
    ends = nodes[:, table.edges].reshape(p * k, table.edges.shape[1], d)
    t = on_facets(table.edge, np.repeat(x, k, axis=0), ends)
    there = np.einsum("qb,qbd->qd", kind_of(table.edge).shapes(t, (0,)), ends).reshape(p, k, d)
    away = there - x[:, None, :]
    best = np.einsum("pkd,pkd->pk", away, away).argmin(axis=1)
    first, last = reference[table.edges[best, 0]], reference[table.edges[best, 1]]
    return np.asarray(first + t.reshape(p, k)[np.arange(p), best, None] * (last - first))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClosestPoints:
    """Closest points of facets, relative to given points.

    Parameters
    ----------
    shapes
        (p, b) shape functions of the facet at the closest point.
    offset
        (p, d) vector from the facet to the point [m].
    normal
        (p, d) unit outward normal of the facet at the closest point.
    """

    shapes: Array
    offset: Array
    normal: Array


def nearest(kind: str, x: Array, nodes: Array, ends: Array) -> ClosestPoints:
    """Closest points of facets with nodes (p, b, d) to points x (p, d).

    ``ends`` (p,) are the outward directions of the facets ``point1``; the others do not use it.
    """
    return _seen(kind, x, nodes, on_facets(kind, x, nodes), ends)


def continued(kind: str, x: Array, nodes: Array, ends: Array) -> ClosestPoints:
    """Closest points of facets that are continued beyond their edges; arguments as in :func:`nearest`.

    Straight segments and triangles are infinite; other facets are continued as polynomials by ``BEYOND``, and from
    there along their tangents.  The offset is always normal to the facet.

    Examples
    --------
    >>> feet = continued("bar2", np.array([[3.0, -1.0]]), np.array([[[0.0, 0.0], [2.0, 0.0]]]), np.zeros(0))
    >>> feet.shapes.tolist(), feet.offset.tolist(), feet.normal.tolist()
    ([[-0.5, 1.5]], [[0.0, -1.0]], [[0.0, -1.0]])
    """
    if kind == "point1":
        return nearest(kind, x, nodes, ends)
    local = _feet(kind, x, nodes, -BEYOND, 1.0 + BEYOND)
    feet, tangents, r = _seen(kind, x, nodes, local, ends), _tangents(kind, nodes, local), local.shape[1]
    metric = np.einsum("ipd,jpd->pij", tangents, tangents)
    shift = np.linalg.solve(metric, np.einsum("ipd,pd->pi", tangents, feet.offset)[..., None])[..., 0]
    slopes = np.stack([kind_of(kind).shapes(local, _unit(r, i)) for i in range(r)])
    return ClosestPoints(
        shapes=feet.shapes + np.einsum("ipb,pi->pb", slopes, shift),
        offset=feet.offset - np.einsum("ipd,pi->pd", tangents, shift),
        normal=feet.normal,
    )


def _seen(kind: str, x: Array, nodes: Array, local: Array, ends: Array) -> ClosestPoints:
    """Points of facets at local coordinates (p, r), relative to x."""
    shapes = kind_of(kind).shapes(local, (0,) * local.shape[1])
    offset = x - np.einsum("pb,pbd->pd", shapes, nodes)
    normal = ends[:, None] if kind == "point1" else normals(kind, nodes, local)
    return ClosestPoints(shapes=shapes, offset=offset, normal=normal)


def normals(kind: str, nodes: Array, local: Array) -> Array:
    """Unit outward normals (p, d) at local coordinates (p, r) of facets with nodes (p, b, d).

    Examples
    --------
    >>> normals("bar2", np.array([[[0.0, 0.0], [2.0, 0.0]]]), np.array([[0.5]])).tolist()
    [[0.0, -1.0]]
    """
    tangents = _tangents(kind, nodes, local)
    if len(tangents) == 1:
        out = np.stack([tangents[0][:, 1], -tangents[0][:, 0]], axis=-1)
    else:
        u, v = tangents
        cyclic = ((1, 2), (2, 0), (0, 1))
        out = np.stack([u[:, i] * v[:, j] - u[:, j] * v[:, i] for i, j in cyclic], axis=-1)
    return np.asarray(out / np.sqrt(dot(out, out))[:, None])


def _tangents(kind: str, nodes: Array, local: Array) -> list[Array]:
    """Derivatives (p, d) of the facets along each of the local coordinates (p, r)."""
    table, r = kind_of(kind), local.shape[1]
    return [np.einsum("pb,pbd->pd", table.shapes(local, _unit(r, i)), nodes) for i in range(r)]


def _unit(r: int, i: int) -> tuple[int, ...]:
    """Order of the first derivative along coordinate i of r."""
    return tuple(int(j == i) for j in range(r))
