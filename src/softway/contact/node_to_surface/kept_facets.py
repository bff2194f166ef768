"""Rows that keep their facets and edges while a slab is solved; missing ones are added.

A node that alternates between two facets, or an edge pair that appears and disappears, would prevent convergence.
Kept rows do not change any more.  If the solution still overlaps, the rows found there are added: the set only grows.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.contact.node_to_surface.edge_to_edge import EdgeContact, edge_crossings, edge_stencils
from softway.contact.node_to_surface.pairs import NodeFacetPairs
from softway.contact.node_to_surface.slab_pairs import KeptFacets, NodeFacetContact
from softway.contact.stencils import Stencils


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeptEdges:
    """Pairs of edges that do not change, treated as infinite lines."""

    edges: EdgeContact

    @property
    def found(self) -> int:
        """Number of kept pairs."""
        return len(self.edges.row)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions ``x`` (n, 3)."""
        edges = self.edges
        return edge_stencils(edges, edge_crossings(x, edges.one, edges.two), np.arange(len(edges.row)), len(x))


def keep_facets(
    contact: NodeFacetContact | EdgeContact, x: Array, before: KeptFacets | KeptEdges | None
) -> KeptFacets | KeptEdges:
    """Contact with its rows kept as they are at ``x`` (n, d), added to those that were kept ``before``."""
    if isinstance(contact, EdgeContact):
        live = contact.live(edge_crossings(x, contact.one, contact.two))
        now = KeptEdges(edges=contact.subset(live))
        return _more_edges(before.edges, now.edges) if isinstance(before, KeptEdges) else now
    found = contact.with_kept_facets(x)
    return _more_faces(before, found, contact.slots) if isinstance(before, KeptFacets) else found


def _more_edges(old: EdgeContact, new: EdgeContact) -> KeptEdges:
    """Kept edges, with a pair for each row that had none."""
    fresh = np.flatnonzero(~np.isin(new.row, old.row))
    row = np.concatenate([old.row, new.row[fresh]])
    order = np.argsort(row, kind="stable")
    one = old.one.joined(new.one.subset(fresh)).subset(order)
    two = old.two.joined(new.two.subset(fresh)).subset(order)
    return KeptEdges(edges=EdgeContact(row=row[order], one=one, two=two, count=old.count))


def _more_faces(old: KeptFacets, new: KeptFacets, slots: int) -> KeptFacets:
    """Kept facets, with the new ones of every node in its free slots."""
    a, b = old.pairs, new.pairs
    size = 1 + max(int(a.facet.max(initial=0)), int(b.facet.max(initial=0)))
    fresh = np.flatnonzero(~np.isin(b.slave * size + b.facet, a.slave * size + a.facet))
    used = set(old.rows.tolist())
    chosen, rows = [], []
    for i in fresh.tolist():
        first = int(b.slave[i]) * slots
        free = next((r for r in range(first, first + slots) if r not in used), None)
        if free is not None:
            used.add(free)
            chosen.append(i)
            rows.append(free)
    more = b.subset(np.array(chosen, int))
    every = np.concatenate([old.rows, np.array(rows, int)])
    order = np.argsort(every, kind="stable")
    joined = NodeFacetPairs(
        side=a.side,
        slave=np.concatenate([a.slave, more.slave]),
        node=np.concatenate([a.node, more.node]),
        facet=np.concatenate([a.facet, more.facet]),
    )
    return replace(old, pairs=joined.subset(order), rows=every[order])
