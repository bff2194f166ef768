"""Bulge of the edges of linear facets: the body that was meshed is curved, the facets are its chords.

Around each node the facets that smooth edges join tell the curvature: a quadratic function of the position in the
tangent plane is fitted to their nodes. The surface over an edge is the parabola with the mean curvature of both ends.
Where the ends disagree in the reference, the weaker curvature counts: none beside a kink.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.surfaces.boundary import SHARP
from softway.contact.surfaces.continued_edges import continued_edges
from softway.contact.tangential_rows import tangents

EVEN = 2.0
"""Length of an edge, relative to the one that continues it, up to which the angle at their node curves it fully: the
angle between the chord of a small round and a long flat facet belongs to the round."""
DAMPED = 1e-5
"""Weight of the least curvature in its fit: nodes in a cross do not tell the twist."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Corners:
    """Corners of facets.

    Parameters
    ----------
    node
        (c,) nodes.
    after, before
        (c,) neighbours on both edges of the facet; in the plane both are the other end.
    around
        (c, b - 1) other nodes of the facet; the first one again where it has fewer.
    normal
        (c, d) unit outward normals.
    weighted
        (c, d) normals with their weights in the mean around a node, which is exact on circles and spheres (Max, 1999).
    """

    node: IntArray
    after: IntArray
    before: IntArray
    around: IntArray
    normal: Array
    weighted: Array


def bulges(facets: Mapping[str, IntArray], points: Array) -> dict[str, sp.csr_array]:
    """Offsets of the curved surface from the middles of the edges of linear facets, as sums of nodal positions.

    Parameters
    ----------
    facets
        Kind -> (f, b) nodes, turned outward: ``bar2``, ``tri3`` or ``quad4``.
    points
        (n, d) reference positions [m].

    Returns
    -------
    Kind -> (f e, n) offsets of the edges that follow the corners, facet after facet; one edge of a segment.

    Examples
    --------
    >>> turn = np.arange(4) * np.pi / 10
    >>> arc = np.column_stack([np.cos(turn), np.sin(turn)])
    >>> found = bulges({"bar2": np.array([[0, 1], [1, 2], [2, 3]])}, arc)["bar2"]
    >>> np.linalg.norm(found @ arc, axis=1).round(3).tolist()
    [0.012, 0.012, 0.012]
    """
    if not facets:
        return {}
    corners = _corners(facets, points)
    fan, closed = _fans(corners)
    normal = np.zeros((len(closed), points.shape[1]))
    np.add.at(normal, fan, corners.weighted)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    ends, known = _ends(corners, fan, closed, normal, points)
    out, start = {}, 0
    for kind, cells in facets.items():
        f, b = cells.shape
        number = start + np.arange(f * b).reshape(f, b)
        one, two = (number[:, :1], number[:, 1:]) if b == 2 else (number, np.roll(number, -1, axis=1))
        pair, middle = (2 * one.ravel(), 2 * two.ravel() + 1), normal[fan[one.ravel()]] + normal[fan[two.ravel()]]
        out[kind] = _joined(ends, known, pair, middle, points)
        start += f * b
    return out


def _joined(
    ends: sp.csr_array, known: BoolArray, pair: tuple[IntArray, IntArray], middle: Array, points: Array
) -> sp.csr_array:
    """Bulges (e, n) of edges from those that both ends tell, rows ``pair`` of ``ends``, if they are ``known``.

    ``middle`` (e, d) are directions outward.
    """
    middle = middle / np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1.0)
    told = [known[rows] for rows in pair]
    rise = [np.einsum("ed,ed->e", ends[rows] @ points, middle) for rows in pair]
    rise = [np.where(told[k], rise[k], rise[1 - k]) for k in range(2)]
    mean = 0.5 * (rise[0] + rise[1])
    weaker = np.where(rise[0] * rise[1] > 0.0, np.minimum(np.abs(rise[0]), np.abs(rise[1])), 0.0)
    share = weaker / np.where(mean != 0.0, np.abs(mean), 1.0)
    count = np.maximum(told[0].astype(float) + told[1], 1.0)
    parts = (sp.diags_array(share * t / count) @ ends[rows] for t, rows in zip(told, pair, strict=True))
    return sp.csr_array(sum(parts))


def _ends(
    corners: _Corners, fan: IntArray, closed: BoolArray, normal: Array, points: Array
) -> tuple[sp.csr_array, BoolArray]:
    """Bulges (2 c, n) of the edges of each corner to ``after`` and ``before``, as its fan tells, and if it does (2 c,).

    Closed fans tell by a fit, others by the edge that continues the edge, if there is one.
    """
    other = np.stack([corners.after, corners.before], axis=1).ravel()
    node, group = np.repeat(corners.node, 2), np.repeat(fan, 2)
    step = points[other] - points[node]
    length = np.linalg.norm(step, axis=1)
    opposite, continued = continued_edges(group, step / length[:, None])
    beyond = length[opposite]
    even = np.minimum(1.0, EVEN * beyond / length) ** 2
    scale = -0.25 * even * length**2 / (length + beyond)
    rows, n = np.arange(len(node)), len(points)
    straight = np.flatnonzero(continued & ~closed[group])
    terms = ((other, scale / length), (other[opposite], scale / beyond), (node, -scale / length - scale / beyond))
    row = np.concatenate([rows[straight]] * 3)
    column, value = (np.concatenate([t[k][straight] for t in terms]) for k in range(2))
    fitted = _fitted(corners, fan, closed, normal, points)
    inside = np.flatnonzero(closed[group])
    local = np.einsum("edk,ed->ek", fitted.basis[group[inside]], step[inside])
    made = fitted.along(group[inside], local, node[inside])
    row = np.concatenate([row, inside[made[0]]])
    column, value = np.concatenate([column, made[1]]), np.concatenate([value, even[inside[made[0]]] * made[2]])
    return sp.csr_array((value, (row, column)), shape=(len(node), n)), continued | closed[group]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Fit:
    """Second derivatives at the nodes of closed fans.

    Parameters
    ----------
    basis
        (g, d, d - 1) tangents.
    first, node
        (g + 1,) start of the nodes of each fan, and its nodes (t,).
    value
        (t, q) factors of the nodes, relative to the middle one, in the second derivatives 11, or 11, 12 and 22.
    """

    basis: Array
    first: IntArray
    node: IntArray
    value: Array

    def along(self, fan: IntArray, local: Array, middle: IntArray) -> tuple[IntArray, IntArray, Array]:
        """Rows, nodes and factors of minus an eighth of the second derivatives along steps (e, d - 1) of fans (e,)."""
        products = local**2
        if local.shape[1] == 2:
            products = np.stack([local[:, 0] ** 2, 2.0 * local[:, 0] * local[:, 1], local[:, 1] ** 2], axis=1)
        count = np.diff(self.first)[fan]
        row = np.repeat(np.arange(len(fan)), count)
        place = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count) + self.first[fan[row]]
        value = -0.125 * np.einsum("tq,tq->t", self.value[place], products[row])
        total = np.bincount(row, value, len(fan))
        rows = np.concatenate([row, np.arange(len(fan))])
        return rows, np.concatenate([self.node[place], middle]), np.concatenate([value, -total])


def _fitted(corners: _Corners, fan: IntArray, closed: BoolArray, normal: Array, points: Array) -> _Fit:
    """Fit quadratic functions to the nodes around those of closed fans."""
    inside, n = closed[fan], len(points)
    middle = np.zeros(len(closed), dtype=np.int64)
    middle[fan] = corners.node
    pairs = np.unique((fan[inside, None] * n + corners.around[inside]).ravel())
    group, node = np.divmod(pairs, n)
    basis = np.swapaxes(tangents(normal), 1, 2)
    local = np.einsum("tdk,td->tk", basis[group], points[node] - points[middle[group]])
    count = np.bincount(group, minlength=len(closed))
    size = np.sqrt(np.bincount(group, np.sum(local**2, axis=1), len(closed)) / np.maximum(count, 1))[group]
    local = local / size[:, None]
    second = [0.5 * local[:, 0] ** 2]
    if local.shape[1] == 2:
        second += [local[:, 0] * local[:, 1], 0.5 * local[:, 1] ** 2]
    terms = np.column_stack([local, *second])
    width, tangential = terms.shape[1], local.shape[1]
    matrix = np.zeros((len(closed), width, width))
    np.add.at(matrix, group, terms[:, :, None] * terms[:, None, :])
    least = np.where(np.arange(width) < tangential, 0.0, DAMPED) + np.where(count > 0, 0.0, 1.0)[:, None]
    matrix += least[:, :, None] * np.eye(width)
    value = np.einsum("tij,tj->ti", np.linalg.inv(matrix)[group], terms)[:, tangential:] / size[:, None] ** 2
    first = np.searchsorted(group, np.arange(len(closed) + 1))
    return _Fit(basis=basis, first=first, node=node, value=value)


def _corners(facets: Mapping[str, IntArray], points: Array) -> _Corners:
    """Corners of all facets, facet after facet."""
    nodes = [cells.ravel() for cells in facets.values()]
    after = np.concatenate([np.roll(cells, -1, axis=1).ravel() for cells in facets.values()])
    before = np.concatenate([np.roll(cells, 1, axis=1).ravel() for cells in facets.values()])
    node, width = np.concatenate(nodes), max(cells.shape[1] for cells in facets.values()) - 1
    around = [
        np.stack([np.roll(cells, -k, axis=1) for k in range(1, cells.shape[1])], axis=2) for cells in facets.values()
    ]
    wide = [np.concatenate([a, np.repeat(a[:, :, :1], width - a.shape[2], axis=2)], axis=2) for a in around]
    one, two = points[after] - points[node], points[before] - points[node]
    if points.shape[1] == 2:
        along = np.where(np.arange(len(node)) % 2 == 0, 1.0, -1.0)[:, None] * one
        area, weight = np.stack([along[:, 1], -along[:, 0]], axis=1), np.sum(one**2, axis=1)
    else:
        area, weight = np.cross(one, two), np.sum(one**2, axis=1) * np.sum(two**2, axis=1)
    size = np.linalg.norm(area, axis=1, keepdims=True)
    return _Corners(
        node=node,
        after=after,
        before=before,
        around=np.concatenate([w.reshape(-1, width) for w in wide]),
        normal=area / np.where(size > 0.0, size, 1.0),
        weighted=area / weight[:, None],
    )


def _fans(corners: _Corners) -> tuple[IntArray, BoolArray]:
    """Number (c,) of the fan of each corner: corners at a node that smooth edges join to each other.

    The fans (k,) around the whole node are closed.
    """
    plane, c = corners.normal.shape[1] == 2, len(corners.node)
    width = int(max(corners.node.max(), corners.after.max())) + 1
    out = corners.node * width + (corners.node if plane else corners.after)
    back = corners.node * width + (corners.node if plane else corners.before)
    order = np.argsort(back, kind="stable")
    first, last = (np.searchsorted(back[order], out, side) for side in ("left", "right"))
    count = last - first
    one = np.repeat(np.arange(c), count)
    place = np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(first, count)
    two = order[place]
    smooth = np.einsum("ed,ed->e", corners.normal[one], corners.normal[two]) >= np.cos(SHARP)
    joined = sp.csr_array((np.ones(int(smooth.sum())), (one[smooth], two[smooth])), shape=(c, c))
    fan = np.asarray(connected_components(joined, directed=False)[1], dtype=np.int64)
    follows = np.diff(joined.indptr) > (1 if plane else 0)  # in the plane a corner is at its own node
    return fan, np.bincount(fan, ~follows) == 0.0
