"""Distance of facets from the smooth surface through their nodes, compared with the gap between two surfaces.

At a node with the normal n, an edge to a neighbour with the tangent t and the length c has the curvature
``(n' - n) . t / c``.  The least squares of all edges give the curvature of the surface in any direction.  At the
distance s from the node, the smooth surface stands ``curvature s (c - s) / 2`` off a straight facet, at most its
sagitta ``curvature c^2 / 8``; in space this holds along both principal directions.  It matters where nodes meet facets,
unless nodes lie opposite nodes.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.surfaces.boundary import SHARP, ContactSurface
from softway.contact.surfaces.continued_edges import continued_edges
from softway.contact.tangential_rows import tangents
from softway.meshes.cells import CELLS

CONFORMING = 0.3
"""Relative curvature of two surfaces, relative to the greater one, below which they conform to each other."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodalCurvature:
    """Curvature and edges of a surface at its corner nodes.

    Parameters
    ----------
    node
        (k,) sorted numbers of the corner nodes.
    points
        (k, d) positions of the corner nodes [m].
    normal
        (k, d) unit outward normals.
    curvature
        (k, d, d) curvature in tangential directions, positive where the surface is convex [1/m]; zero at sharp edges.
    first, edges
        (k + 1,) start of the edges of each node, and the edges (e, d) to its neighbours [m].
    factor
        Distance of the facets from the smooth surface, relative to that of straight facets.
    """

    node: IntArray
    points: Array
    normal: Array
    curvature: Array
    first: IntArray
    edges: Array
    factor: float

    def along(self, node: IntArray, direction: Array) -> Array:
        """Curvature (p,) at nodes (p,) in unit directions (p, d) [1/m]."""
        return np.asarray(np.einsum("pi,pij,pj->p", direction, self.curvature[node], direction))

    def off(self, node: IntArray, step: Array) -> Array:
        """Distance (p,) of the facets from the smooth surface, at tangential steps (p, d) from nodes (p,) [m]."""
        values, axes, reach = self._principal()
        along = np.abs(np.einsum("pd,pdi->pi", step, axes[node]))
        bow = 0.5 * along * np.maximum(reach[node] - along, 0.0)
        return np.asarray(self.factor * (np.abs(values[node]) * bow).sum(axis=1))

    def outside(self) -> Array:
        """Greatest distance (k,) by which the facets around each node stand outside of the smooth surface [m]."""
        values, _, reach = self._principal()
        return np.asarray(self.factor * (np.maximum(-values, 0.0) * reach**2 / 8.0).sum(axis=1))

    def _principal(self) -> tuple[Array, Array, Array]:
        """Principal curvatures (k, d) [1/m], their directions (k, d, d), and the extent (k, d) of the edges [m]."""
        values, axes = np.linalg.eigh(self.curvature)
        row = np.repeat(np.arange(len(self.points)), np.diff(self.first))
        reach = np.zeros(values.shape)
        np.maximum.at(reach, row, np.abs(np.einsum("ed,edi->ei", self.edges, axes[row])))
        return values, axes, reach


@dataclass(frozen=True, slots=True, kw_only=True)
class Misfit:
    """Distance ``off`` of facets from the smooth surface [m], where the smooth surfaces have the ``gap`` [m]."""

    off: float
    gap: float


def nodal_curvature(side: ContactSurface, x: Array) -> NodalCurvature:
    """Curvature of a surface at positions ``x`` (n, d).

    Examples
    --------
    A circle of radius 2, whose facets stand 2 (1 - cos(pi / 60)) = 0.0027 off the curve:

    >>> turn = np.arange(60) * np.pi / 30
    >>> circle = 2.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    >>> side = ContactSurface(facets={"bar2": np.stack([np.arange(60), np.roll(np.arange(60), -1)], axis=1)})
    >>> made = nodal_curvature(side, circle)
    >>> made.off(np.array([0]), 0.5 * (circle[1:2] - circle[:1])).round(4).tolist()
    [0.0027]
    """
    corners = [found[:, : CELLS[kind].corners] for kind, _, found in side.numbers]
    pairs = [
        nodes[:, list(edge)]
        for (kind, _, _), nodes in zip(side.numbers, corners, strict=True)
        for edge in CELLS[kind].edges
    ]
    ends = np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)
    node = np.unique(np.concatenate([c.ravel() for c in corners]))
    place = np.searchsorted(side.nodes, node)
    normal = side.nodal_normals(x)[place]
    around = side.adjacent_facet_normals(x)[place]
    smooth = np.einsum("kld,kd->kl", around, normal).min(axis=1) >= np.cos(0.51 * SHARP)
    both = np.searchsorted(node, np.concatenate([ends, ends[:, ::-1]]))
    order = np.argsort(both[:, 0], kind="stable")
    back = np.argsort(order)[(order + len(ends)) % len(both)]
    both = both[order]
    first = np.searchsorted(both[:, 0], np.arange(len(node) + 1))
    step = x[node[both[:, 1]]] - x[node[both[:, 0]]]
    normal = _turned(normal, both, step, back, smooth)
    bent = np.einsum("ed,ed->e", normal[both[:, 1]] - normal[both[:, 0]], step) / np.einsum("ed,ed->e", step, step)
    bent = np.where(smooth[both].all(axis=1), bent, 0.0)
    degree = max(CELLS[kind].order for kind in side.facets)
    return NodalCurvature(
        node=node,
        points=x[node],
        normal=normal,
        curvature=_fitted(both[:, 0], step, bent, normal),
        first=first,
        edges=step,
        factor=1.0 if degree == 1 else 0.0,
    )


def misfit(one: NodalCurvature, other: NodalCurvature, fit: bool) -> Misfit | None:
    """Greatest distance of facets from the smooth surface where two surfaces meet; None where they meet nowhere.

    With ``fit`` the surfaces meet where they overlap, and ``gap`` is the deepest overlap, negative.  Otherwise they
    meet where they conform to each other with about the smallest gap.
    """
    found = [_seen(a, b, fit) for a, b in ((one, other), (other, one))]
    off, gap, meet = (np.concatenate(parts) for parts in zip(*found, strict=True))
    if not meet.any():
        return None
    least = float(gap[meet].min())
    near = meet & (gap <= (0.0 if fit else 2.0 * max(least, 0.0) + off))
    return Misfit(off=float(off[near].max(initial=0.0)), gap=least)


def _seen(one: NodalCurvature, other: NodalCurvature, fit: bool) -> tuple[Array, Array, Array]:
    """Distances (p,) of the facets of ``other`` at the nodes of ``one``, gaps (p,), and True (p,) where they meet."""
    far, near = cKDTree(other.points).query(one.points)
    away = one.points - other.points[near]
    height = np.einsum("pd,pd->p", away, other.normal[near])
    step = away - height[:, None] * other.normal[near]
    length = np.linalg.norm(step, axis=1)
    unit = step / np.where(length > 0.0, length, 1.0)[:, None]
    own, opposite = (s.along(k, unit) for s, k in ((one, np.arange(len(near))), (other, near)))
    gap = height + 0.5 * opposite * length**2
    reach = np.sqrt(np.maximum.reduceat(np.einsum("ed,ed->e", other.edges, other.edges), other.first[:-1]))[near]
    facing = np.einsum("pd,pd->p", one.normal, other.normal[near]) < -np.cos(SHARP)
    beside = facing & (length <= reach)
    if fit:
        return other.off(near, step), gap, beside & (gap < 0.0) & (far <= reach)
    greater = np.maximum(np.abs(own), np.abs(opposite))
    return other.off(near, step), gap, beside & (greater > 0.0) & (np.abs(own + opposite) <= CONFORMING * greater)


def _turned(normal: Array, both: IntArray, step: Array, back: IntArray, smooth: BoolArray) -> Array:
    """Normals (k, d) at the ends of a surface, turned as if it went on; those of one facet stand askew.

    An edge (e, d) that no other one continues at its first node, but one at its second, has the same angle to both
    normals on a circle.  ``back`` (e,) is the number of the reversed edge.
    """
    unit = step / np.linalg.norm(step, axis=1, keepdims=True)
    _, continued = continued_edges(both[:, 0], unit)
    end = np.flatnonzero(~continued & continued[back] & smooth[both].all(axis=1))
    slope = np.einsum("ed,ed->e", normal[both[end, 1]] + normal[both[end, 0]], unit[end])
    out = normal.copy()
    np.add.at(out, both[end, 0], -slope[:, None] * unit[end])
    return np.asarray(out / np.linalg.norm(out, axis=1, keepdims=True))


def _fitted(node: IntArray, step: Array, bent: Array, normal: Array) -> Array:
    """Curvature tensors (k, d, d) that fit the curvatures ``bent`` (e,) along the edges ``step`` (e, d) best."""
    basis = tangents(normal)
    local = np.einsum("ekd,ed->ek", basis[node], step)
    local /= np.linalg.norm(local, axis=1, keepdims=True)
    rows, columns = np.triu_indices(local.shape[1])
    weight = np.where(rows == columns, 1.0, np.sqrt(2.0))  # the least norm is then that of the tensor
    terms = local[:, rows] * local[:, columns] * weight
    matrix, right = np.zeros((len(normal), len(rows), len(rows))), np.zeros((len(normal), len(rows)))
    np.add.at(matrix, node, terms[:, :, None] * terms[:, None, :])
    np.add.at(right, node, terms * bent[:, None])
    values = np.einsum("kij,kj->ki", np.linalg.pinv(matrix, rcond=1e-6, hermitian=True), right)
    tensor = np.zeros((len(normal), local.shape[1], local.shape[1]))
    tensor[:, rows, columns] = tensor[:, columns, rows] = values / weight
    return np.asarray(np.einsum("kia,kij,kjb->kab", basis, tensor, basis))
