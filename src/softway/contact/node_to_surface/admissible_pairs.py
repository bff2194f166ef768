"""Nodes and facets, and pairs of edges, that may touch each other where one method handles many surfaces.

A surface that may touch itself has pairs that never meet: neighbours, and the back of the wall that a facet belongs to.
Those are told by the mesh and the reference positions, and are the same throughout a march.
"""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.node_to_surface.facet_projection import SMOOTH
from softway.contact.node_to_surface.pairs import NodeFacetPairs
from softway.contact.surfaces.boundary import ContactSurface, Edges
from softway.kernels.geometry.closest_points import dot

WALL = 3.0
"""Thickness in facet sizes up to which a wall is seen through."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Members:
    """Surfaces that may touch each other.

    Parameters
    ----------
    nodes, facets
        (n, k) and (f, k) True where a node or facet belongs to a surface.
    meet
        (k, k) symmetric; True for surfaces that may touch each other.
    """

    nodes: BoolArray
    facets: BoolArray
    meet: BoolArray

    def nodes_and_facets(self, node: IntArray, facet: IntArray) -> BoolArray:
        """True for pairs (p,) of surfaces that may touch."""
        return np.asarray(((self.nodes[node] @ self.meet) & self.facets[facet]).any(axis=1))

    def edges(self, one: IntArray, two: IntArray) -> BoolArray:
        """True for pairs of edges with the ends (p, 2), of surfaces that may touch."""
        first, second = (self.nodes[ends[:, 0]] & self.nodes[ends[:, 1]] for ends in (one, two))
        return np.asarray(((first @ self.meet) & second).any(axis=1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AdmissiblePairs:
    """Pairs that may touch.

    Parameters
    ----------
    points
        (n, d) reference positions [m].
    body
        (n,) number of the body of each node.
    side
        Facets of all surfaces.
    members
        Surfaces that may touch each other.
    apart
        Surfaces that are left out, as they have a contact of their own.
    glue
        (n, n) pattern of nodes that ties move together, and of each node with itself: their neighbours never meet.
    whole
        (w, b) groups of nodes that are neighbours; by default the nodes of each facet.

    Examples
    --------
    A channel: its walls may meet each other, but the inner side of a wall not its own outer side.

    >>> points = np.array([[0, 0], [4, 0], [4, 3], [3, 3], [3, 1], [1, 1], [1, 3], [0, 3]], float)
    >>> side = ContactSurface(facets={"bar2": np.array([[k, (k + 1) % 8] for k in range(8)])})
    >>> every = Members(nodes=np.ones((8, 1), bool), facets=np.ones((8, 1), bool), meet=np.ones((1, 1), bool))
    >>> pairs = AdmissiblePairs(points=points, body=np.zeros(8, int), side=side, members=every)
    >>> pairs.nodes_and_facets(np.array([3, 5]), np.array([5, 7])).tolist()
    [True, False]
    """

    points: Array
    body: IntArray
    side: ContactSurface
    members: Members
    apart: tuple[Members, ...] = ()
    glue: sp.csr_array | None = None
    whole: IntArray | None = None
    ring: sp.csr_array = field(init=False)
    beside: sp.csr_array = field(init=False)
    normals: Array = field(init=False)

    def __post_init__(self) -> None:
        at = _incidence(self.side.table, len(self.points))
        among = at if self.whole is None else _incidence(self.whole, len(self.points))
        beside = sp.csr_array(among @ among.T)
        if self.glue is not None:
            beside = sp.csr_array(self.glue @ beside @ self.glue)
        ring = sp.csr_array(beside @ at)
        for found in (beside, ring):
            found.sort_indices()
        normals = np.zeros_like(self.points)
        normals[self.side.nodes] = self.side.nodal_normals(self.points)
        for name, value in (("ring", ring), ("beside", beside), ("normals", normals)):
            object.__setattr__(self, name, value)

    def nodes_and_facets(self, node: IntArray, facet: IntArray) -> BoolArray:
        """True for nodes and facets (p,) that may touch."""
        out = self.members.nodes_and_facets(node, facet)
        for pair in self.apart:
            out &= ~pair.nodes_and_facets(node, facet)
        same = self.body[node] == self.body[self.side.table[facet, 0]]
        own = np.flatnonzero(out if self.glue is not None else out & same)
        near = _entries(self.ring, node[own], facet[own])
        out[own[near]] = False
        own = np.flatnonzero(out & same)
        out[own] = ~self._through(node[own], facet[own])
        return out

    def edges(self, one: Edges, two: Edges) -> BoolArray:
        """True for pairs of edges (p,) that may touch."""
        out = self.members.edges(one.ends, two.ends)
        for pair in self.apart:
            out &= ~pair.edges(one.ends, two.ends)
        for a in one.ends.T:
            for b in two.ends.T:
                out &= ~_entries(self.beside, a, b)
        return out

    def _through(self, node: IntArray, facet: IntArray) -> BoolArray:
        """True for nodes behind facets (p,) of their own body at rest, on the other side of a wall: the way from the
        facet leaves the body at the node.  Parts of one smooth convex surface may still meet in a fold.
        """
        pairs = NodeFacetPairs(side=self.side, slave=np.arange(len(node)), node=node, facet=facet)
        feet = pairs.feet(self.points)
        corners = self.points[pairs.masters]
        size = np.linalg.norm(corners.max(axis=1) - corners.min(axis=1), axis=1)
        behind = dot(feet.normal, feet.offset) < 0.0
        close = dot(feet.offset, feet.offset) <= (WALL * size) ** 2
        leaving = dot(self.normals[node], feet.offset) > 0.0
        turned = dot(self.normals[node], feet.normal) < SMOOTH
        return np.asarray(behind & close & leaving & turned)


def _incidence(table: IntArray, nodes: int) -> sp.csr_array:
    """Pattern (nodes, k) of the nodes in the groups ``table`` (k, b)."""
    group = np.repeat(np.arange(len(table)), table.shape[1])
    return sp.csr_array((np.ones(table.size, np.int32), (table.ravel(), group)), shape=(nodes, len(table)))


def _entries(matrix: sp.csr_array, row: IntArray, column: IntArray) -> BoolArray:
    """True where a sparse matrix has entries at ``row``, ``column`` (p,)."""
    if not len(row):
        return np.zeros(0, bool)
    return np.asarray(matrix[row, column]).ravel() != 0
