"""Rows that keep their facets and edges while a slab is solved; missing ones are added.

A node that alternates between two facets, or an edge pair that appears and disappears, would prevent convergence.
Kept rows do not change any more.  If the solution still overlaps, the rows found there are added: the set only grows.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.node_to_surface.edge_to_edge import EdgeContact, edge_crossings, edge_stencils
from softway.contact.node_to_surface.pairs import NodeFacetPairs
from softway.contact.node_to_surface.slab_pairs import KeptFacets, NodeFacetContact
from softway.contact.node_to_surface.split_facets import Rows, SplitContact
from softway.contact.stencils import Stencils

EXTENSION = 0.25
"""Fraction of their lengths by which kept edges with several rows are extended; nearly parallel lines cross anywhere
beyond.  Edges with one row are endless."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeptEdges:
    """Pairs of edges (p,) that do not change and are extended beyond their ends, with their ascending ``rows`` (p,)."""

    edges: EdgeContact
    rows: IntArray

    @property
    def found(self) -> int:
        """Number of kept pairs."""
        return len(self.rows)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions ``x`` (n, 3)."""
        edges = self.edges
        found = edge_crossings(x, edges.one, edges.two)
        outside = np.maximum(-np.minimum(found.s, found.t), np.maximum(found.s, found.t) - 1.0)
        live = np.flatnonzero(outside <= (EXTENSION if edges.slots > 1 else np.inf))
        return edge_stencils(edges, found, live, self.rows[live], len(x))


def keep_facets(contact: Rows, x: Array, before: Rows | None) -> Rows:
    """Contact with its rows kept as they are at ``x`` (n, d), added to those that were kept ``before``."""
    if isinstance(contact, SplitContact):
        old = before.contact if isinstance(before, SplitContact) else None
        found = keep_facets(contact.contact, contact.surface.positions(x), old)
        return SplitContact(contact=found, surface=contact.surface)
    if isinstance(contact, EdgeContact):
        live, rows = contact.live(edge_crossings(x, contact.one, contact.two))
        pairs = KeptEdges(edges=contact.subset(live), rows=rows)
        return _more_edges(before, pairs) if isinstance(before, KeptEdges) else pairs
    if isinstance(contact, NodeFacetContact):
        faces = contact.with_kept_facets(x)
        return _more_faces(before, faces, contact.slots) if isinstance(before, KeptFacets) else faces
    return contact


def _more_edges(old: KeptEdges, new: KeptEdges) -> KeptEdges:
    """Kept edges, with the new pairs of every edge in its free slots."""
    a, b = old.edges, new.edges
    chosen, rows = _placed((a.edge, a.other), (b.edge, b.other), old.rows, a.slots)
    more = b.subset(chosen)
    every = np.concatenate([old.rows, rows])
    order = np.argsort(every, kind="stable")
    joined = replace(
        a,
        edge=np.concatenate([a.edge, more.edge]),
        other=np.concatenate([a.other, more.other]),
        one=a.one.joined(more.one),
        two=a.two.joined(more.two),
    )
    return KeptEdges(edges=joined.subset(order), rows=every[order])


def _more_faces(old: KeptFacets, new: KeptFacets, slots: int) -> KeptFacets:
    """Kept facets, with the new ones of every node in its free slots."""
    a, b = old.pairs, new.pairs
    chosen, rows = _placed((a.slave, a.facet), (b.slave, b.facet), old.rows, slots)
    more = b.subset(chosen)
    every = np.concatenate([old.rows, rows])
    order = np.argsort(every, kind="stable")
    joined = NodeFacetPairs(
        side=a.side,
        slave=np.concatenate([a.slave, more.slave]),
        node=np.concatenate([a.node, more.node]),
        facet=np.concatenate([a.facet, more.facet]),
    )
    return replace(old, pairs=joined.subset(order), rows=every[order])


def _placed(
    old: tuple[IntArray, IntArray], new: tuple[IntArray, IntArray], taken: IntArray, slots: int
) -> tuple[IntArray, IntArray]:
    """New pairs, of slaves with opponents, that are not among the ``old`` ones, and their rows: free ``slots``.

    ``taken`` are the rows of the old pairs.
    """
    size = 1 + max(int(old[1].max(initial=0)), int(new[1].max(initial=0)))
    fresh = np.flatnonzero(~np.isin(new[0] * size + new[1], old[0] * size + old[1]))
    used = set(taken.tolist())
    chosen, rows = [], []
    for i in fresh.tolist():
        first = int(new[0][i]) * slots
        free = next((r for r in range(first, first + slots) if r not in used), None)
        if free is not None:
            used.add(free)
            chosen.append(i)
            rows.append(free)
    return np.array(chosen, int), np.array(rows, int)
