"""Slave nodes and the facets that they may touch in a slab: active facet, gap and derivative.

For one slave and one facet, at given positions: if the foot of the slave lies on the facet, the gap is the height of
the slave above it, ``normal . (x - X)``.  Beyond an edge the gap is the distance to the edge, unless the slave was
above the facet at the start of the slab.  Then the facet is extended over its edge up to the end of the slab: a slave
does not fall past an edge that it slides over, and does not slip round a thin body that it has hit near the rim.

Only facets that face the slave at the start of the slab are considered, and the nearest one is active.  Therefore a
slave cannot cross a thin body: its far facets face away at the start.  If a slave is in front of its nearest facet but
has crossed another one on its straight path since the start, the crossed facet is active.

In every case the foot is stationary along the facet or its edge, therefore ``d gap = normal . (dx - sum_k N_k dx_k)``
is exact, and the forces ``normal`` on the slave and ``-N_k normal`` on the nodes have no resultant and no moment.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.node_to_surface.facet_projection import project
from softway.contact.node_to_surface.facet_selection import choose_facets
from softway.contact.node_to_surface.pairs import NodeFacetPairs
from softway.contact.stencils import Stencils, open_rows
from softway.contact.surfaces.facet_geometry import ClosestPoints, continued
from softway.kernels.geometry.closest_points import dot


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodeFacetContact:
    """Contact of nodes with facets in a slab; each slave has the same number of rows.

    Parameters
    ----------
    pairs
        Slaves and facets that may touch.
    count, slots
        Number of slaves, and of rows of each.
    start
        (n, d) positions at the start of the slab [m].
    size
        (p,) size of the facets [m].
    above
        (p,) height of the slaves above the facets at the start of the slab [m].
    over
        True if there are rows only for slaves over a facet or its extension: edges have rows of their own.
    """

    pairs: NodeFacetPairs
    count: int
    slots: int
    start: Array
    size: Array
    above: Array
    over: bool = False

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        return len(self.pairs.facet)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, d)."""
        if not self.found:
            return open_rows(self.count * self.slots, *x.shape)
        seen = project(self.pairs, x, self.size)
        choice = choose_facets(seen, self.count, self.slots, self.start, self.above)
        rows = np.flatnonzero(choice.pair >= 0)
        pair = choice.pair.ravel()[rows]
        if self.over:
            here = seen.inner[pair] | choice.extended[pair]
            rows, pair = rows[here], pair[here]
        taken, inner = self.pairs.subset(pair), seen.inner[pair]
        feet = ClosestPoints(
            shapes=seen.feet.shapes[pair], offset=seen.feet.offset[pair], normal=seen.feet.normal[pair]
        )
        gap = np.where(inner, seen.height[pair], seen.distance[pair])
        normal = np.where(inner[:, None], feet.normal, feet.offset / np.where(inner, 1.0, gap)[:, None])
        again = np.flatnonzero(choice.extended[pair])
        if len(again):
            there = taken.subset(again).feet(x, continued)
            feet.shapes[again], normal[again] = there.shapes, there.normal
            gap[again] = dot(there.normal, there.offset)
        return taken.stencils(rows, choice.pair.size, feet, gap, normal, len(x))

    def with_kept_facets(self, x: Array) -> "KeptFacets":
        """Contact with the facet of every row kept as it is at x (n, d) and continued beyond its edges.

        Rows with a kept facet do not alternate between two facets.  This permits no penetration: at a convex edge a
        slave is inside the body if it is behind both facets, so being in front of either one is enough; at a concave
        edge it is inside if it is behind either facet, and each of the two facets keeps a row of its own.
        """
        seen = project(self.pairs, x, self.size)
        choice = choose_facets(seen, self.count, self.slots, self.start, self.above)
        rows = np.flatnonzero(choice.pair >= 0)
        pair = choice.pair.ravel()[rows]
        keep = seen.inner[pair] | choice.extended[pair] | ((seen.height[pair] > 0.0) & (not self.over))
        return KeptFacets(pairs=self.pairs.subset(pair[keep]), rows=rows[keep], count=choice.pair.size)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeptFacets:
    """Rows (p,) out of ``count`` with facets that do not change and are continued beyond their edges."""

    pairs: NodeFacetPairs
    rows: IntArray
    count: int

    @property
    def found(self) -> int:
        """Number of kept pairs."""
        return len(self.rows)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, d)."""
        feet = self.pairs.feet(x, continued)
        gap = dot(feet.normal, feet.offset)
        return self.pairs.stencils(self.rows, self.count, feet, gap, feet.normal, len(x))
