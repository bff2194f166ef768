"""Contact surface: facets with their nodes, normals and sharp edges."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.surfaces.facet_geometry import kind_of, normals
from softway.errors import InputError
from softway.kernels.geometry.closest_points import dot
from softway.meshes.cells import CELLS

SHARP = np.deg2rad(30.0)
"""Angle between the normals of two facets beyond which their common edge is sharp."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Edges:
    """Edges between two facets of a surface.

    Parameters
    ----------
    ends
        (e, 2) corner nodes, in the sense of rotation of the first facet.
    wings
        (e, 2) corners of the first and of the second facet that follow the edge.
    """

    ends: IntArray
    wings: IntArray

    def subset(self, which: IntArray | BoolArray) -> "Edges":
        """Subset of the edges."""
        return Edges(ends=self.ends[which], wings=self.wings[which])

    def joined(self, other: "Edges") -> "Edges":
        """These edges, followed by the others."""
        return Edges(ends=np.concatenate([self.ends, other.ends]), wings=np.concatenate([self.wings, other.wings]))

    def normals(self, x: Array) -> tuple[Array, Array]:
        """Outward unit normals (e, d) of the first and the second facet at the edge, at positions x (n, d)."""
        first, last = x[self.ends[:, 0]], x[self.ends[:, 1]]
        one = np.cross(last - first, x[self.wings[:, 0]] - first)
        two = np.cross(first - last, x[self.wings[:, 1]] - last)
        return _unit(one), _unit(two)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactSurface:
    """Facets of one side of a contact, numbered kind by kind.

    Parameters
    ----------
    facets
        Kind -> (f, b) nodes in the numbering of the model, turned outward: ``point1`` in one dimension, ``bar2`` or
        ``bar3`` in two, ``tri3``, ``tri6``, ``quad4``, ``quad8`` or ``quad9`` in three.
    ends
        (f,) outward directions +1 or -1 of the facets ``point1``, see :func:`outward`; empty for the others.
    nodes
        (k,) sorted nodes of the facets.
    table
        (f, b) nodes of all facets; if kinds differ, shorter rows repeat their first node.

    Examples
    --------
    >>> side = ContactSurface(facets={"bar2": np.array([[0, 1], [1, 2]])})
    >>> side.dim, side.nodes.tolist()
    (2, [0, 1, 2])
    >>> side.nodal_normals(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])).round(3).tolist()
    [[0.0, -1.0], [0.707, -0.707], [1.0, 0.0]]
    """

    facets: Mapping[str, IntArray]
    ends: Array = field(default_factory=lambda: np.zeros(0))
    nodes: IntArray = field(init=False)
    table: IntArray = field(init=False)

    def __post_init__(self) -> None:
        facets = {kind: np.asarray(found, dtype=np.int64) for kind, found in self.facets.items() if len(found)}
        dims = {CELLS[kind].dim for kind in facets}
        if len(dims) != 1:
            raise InputError("facets", f"facets of kinds {', '.join(facets) or 'none'}", "facets of one dimension")
        if len(self.ends) != len(facets.get("point1", ())):
            raise InputError("ends", f"{len(self.ends)} outward directions", "one for every facet point1")
        width = max(found.shape[1] for found in facets.values())
        wide = [np.concatenate([f, np.repeat(f[:, :1], width - f.shape[1], axis=1)], axis=1) for f in facets.values()]
        object.__setattr__(self, "facets", facets)
        object.__setattr__(self, "ends", np.asarray(self.ends, dtype=float))
        object.__setattr__(self, "table", np.concatenate(wide))
        object.__setattr__(self, "nodes", np.unique(self.table))

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return CELLS[next(iter(self.facets))].dim + 1

    @property
    def numbers(self) -> Iterator[tuple[str, int, IntArray]]:
        """Kind, number of its first facet, and nodes (f, b) of its facets, for each kind."""
        first = 0
        for kind, found in self.facets.items():
            yield kind, first, found
            first += len(found)

    def nodal_normals(self, x: Array) -> Array:
        """Unit outward normals (k, d) at the nodes: means of the facets around them, weighted by their angles.

        ``x`` (n, d) are the positions of the nodes of the model.
        """
        total = np.zeros((len(self.nodes), x.shape[1]))
        for kind, _, found in self.numbers:
            for k, reference in enumerate(CELLS[kind].nodes):
                local = np.broadcast_to(reference, (len(found), len(reference)))
                normal = self.ends[:, None] if kind == "point1" else normals(kind, x[found], local)
                angle = _angles(kind, k, x[found])
                np.add.at(total, np.searchsorted(self.nodes, found[:, k]), angle[:, None] * normal)
        return _unit(total)

    def adjacent_facet_normals(self, x: Array) -> Array:
        """Outward normals (k, l, d) of the facets around each node.

        Entries beyond the number of facets of a node contain its nodal normal, at least one.  ``x`` (n, d) are the
        positions of the nodes of the model.
        """
        node, found = [], []
        for kind, _, nodes in self.numbers:
            for k, reference in enumerate(CELLS[kind].nodes):
                local = np.broadcast_to(reference, (len(nodes), len(reference)))
                node.append(np.searchsorted(self.nodes, nodes[:, k]))
                found.append(self.ends[:, None] if kind == "point1" else normals(kind, x[nodes], local))
        order = np.argsort(np.concatenate(node), kind="stable")
        count = np.bincount(np.concatenate(node), minlength=len(self.nodes))
        place = np.arange(len(order)) - np.repeat(np.cumsum(count) - count, count)
        out = np.repeat(self.nodal_normals(x)[:, None], count.max() + 1, axis=1)
        out[np.concatenate(node)[order], place] = np.concatenate(found)[order]
        return out

    def sharp_corners(self, points: Array) -> IntArray:
        """Nodes (c,) of the plane where two facets meet at a sharp convex corner, for points (n, 2) of the model."""
        ends = np.concatenate([found[:, :2] for found in self.facets.values()])
        tangent = _unit(points[ends[:, 1]] - points[ends[:, 0]])
        after = np.full(len(points), -1)
        after[ends[:, 0]] = np.arange(len(ends))
        before = np.flatnonzero(after[ends[:, 1]] >= 0)
        one, two = tangent[before], tangent[after[ends[before, 1]]]
        turn = np.arctan2(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], dot(one, two))
        return np.sort(ends[before[turn > SHARP], 1])

    def sharp_edges(self, points: Array) -> Edges:
        """Edges where two facets meet at a sharp convex angle, for points (n, 3) of the model."""
        edges = self.edges()
        one, two = edges.normals(points)
        first, last = points[edges.ends[:, 0]], points[edges.ends[:, 1]]
        turn = np.arctan2(dot(np.cross(one, two), _unit(last - first)), dot(one, two))
        return edges.subset(turn > SHARP)

    def nodes_on(self, edges: Edges) -> IntArray:
        """Sorted nodes (k,) of some of its edges: ends and, of quadratic facets, the nodes in their middle.

        Examples
        --------
        >>> side = ContactSurface(facets={"tri6": np.array([[0, 1, 2, 3, 4, 5]])})
        >>> side.nodes_on(Edges(ends=np.array([[2, 1]]), wings=np.array([[0, 0]]))).tolist()
        [1, 2, 4]
        """
        found = [edges.ends.ravel()]
        keys = edges.ends.min(axis=1) + 1j * edges.ends.max(axis=1)
        for kind, nodes in self.facets.items():
            count = CELLS[kind].corners
            if CELLS[kind].order == 1:
                continue
            first, second = nodes[:, :count], np.roll(nodes[:, :count], -1, axis=1)
            ours = np.isin(np.minimum(first, second) + 1j * np.maximum(first, second), keys)
            found.append(nodes[:, count : 2 * count][ours])
        return np.unique(np.concatenate(found))

    def edges(self) -> Edges:
        """All edges between two facets."""
        corners = [found[:, : CELLS[kind].corners] for kind, found in self.facets.items()]
        turned = [np.stack([np.roll(c, -k, axis=1).ravel() for k in range(3)], axis=1) for c in corners]
        rows = np.concatenate(turned)  # an edge and the corner that follows it
        rows = rows[np.lexsort((rows[:, 0], rows[:, :2].max(axis=1), rows[:, :2].min(axis=1)))]
        pair = np.flatnonzero((rows[:-1, 0] == rows[1:, 1]) & (rows[:-1, 1] == rows[1:, 0]))
        return Edges(ends=rows[pair, :2], wings=np.stack([rows[pair, 2], rows[pair + 1, 2]], axis=1))


def outward(bars: IntArray, points: IntArray) -> Array:
    """Outward directions (f,) of the facets ``point1`` (f, 1) of bars (e, a) on the axis: -1 where a bar begins.

    Examples
    --------
    >>> outward(np.array([[0, 1], [1, 2]]), np.array([[0], [2]])).tolist()
    [-1.0, 1.0]
    """
    begins: BoolArray = np.isin(points[:, 0], bars[:, 0])
    return np.where(begins, -1.0, 1.0)


def _angles(kind: str, node: int, x: Array) -> Array:
    """Angles (f,) of facets (f, b, d) at one of their nodes."""
    cell = CELLS[kind]
    if cell.dim < 2 or node >= cell.corners:
        return np.full(len(x), 2.0 * np.pi if kind == "quad9" and node == 8 else np.pi)
    table, reference = kind_of(kind), cell.nodes
    tangents = [table.shapes(reference[node : node + 1], unit)[0] for unit in ((1, 0), (0, 1))]
    jacobian = np.einsum("rb,fbd->frd", tangents, x)
    one, two = (reference[(node + turn) % cell.corners] - reference[node] for turn in (1, -1))
    u, v = _unit(one @ jacobian), _unit(two @ jacobian)
    return np.arccos(np.clip(dot(u, v), -1.0, 1.0))


def _unit(vectors: Array) -> Array:
    """Unit vectors (p, d); zero vectors stay zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)
