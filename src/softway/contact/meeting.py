"""Slave nodes and the facets that each of them may touch in a slab: which facet counts, its gap and its derivative.

For one slave and one facet, at given positions: where the foot of the slave lies on the facet the gap is its height
above it, ``normal . (x - X)``.  Beyond an edge the gap is the distance to the edge, unless the slave stood over the
facet when the slab began: then the facet is extended over its edge up to the end of the slab, so that a slave does not
fall past an edge that it slides over, nor slip round a thin body that it has hit near the rim.

Only facets that look towards the slave when the slab begins are candidates, and the nearest one counts.  This is why a
thin body cannot be crossed: its far facets look away when the slab begins.  A slave that seems to be in front of its
nearest facet although it crossed another one on its straight way since then counts for the crossed one.

In every case the foot is stationary along the facet or its edge, therefore ``d gap = normal . (dx - sum_k N_k dx_k)``
is exact, and the forces ``normal`` on the slave and ``-N_k normal`` on the nodes have no resultant and no moment.
"""

from dataclasses import dataclass

import numpy as np

from softway.contact.choice import choose
from softway.contact.facets import Feet, continued
from softway.contact.sight import sight
from softway.contact.slave_pairs import Pairs
from softway.contact.stencils import Stencils
from softway.kernels.closest import dot
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Meeting:
    """What may touch in a slab; each slave has the same number of rows.

    Parameters
    ----------
    pairs
        Slaves and facets that may touch.
    count, slots
        Number of slaves, and of rows of each.
    start
        (n, d) positions when the slab began [m].
    size
        (p,) size of the facets [m].
    above
        (p,) height of the slaves above the facets when the slab began [m].
    """

    pairs: Pairs
    count: int
    slots: int
    start: Array
    size: Array
    above: Array

    @property
    def found(self) -> int:
        """Pairs that the search came up with."""
        return len(self.pairs.facet)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, d)."""
        seen = sight(self.pairs, x, self.size)
        choice = choose(seen, self.count, self.slots, self.start, self.above)
        rows = np.flatnonzero(choice.pair >= 0)
        pair = choice.pair.ravel()[rows]
        taken, inner = self.pairs.take(pair), seen.inner[pair]
        feet = Feet(shapes=seen.feet.shapes[pair], offset=seen.feet.offset[pair], normal=seen.feet.normal[pair])
        gap = np.where(inner, seen.height[pair], seen.distance[pair])
        normal = np.where(inner[:, None], feet.normal, feet.offset / np.where(inner, 1.0, gap)[:, None])
        again = np.flatnonzero(choice.extended[pair])
        if len(again):
            there = taken.take(again).feet(x, continued)
            feet.shapes[again], normal[again] = there.shapes, there.normal
            gap[again] = dot(there.normal, there.offset)
        return taken.stencils(rows, choice.pair.size, feet, gap, normal, len(x))

    def held(self, x: Array) -> "Held":
        """The meeting with the facet of every row kept as it is at x (n, d), continued beyond its edges.

        Rows whose facet is kept do not chatter between two facets.  Nothing penetrates by that: at a convex edge the
        body is where the slave is behind both facets, so in front of one of them is outside, whichever it is; at a
        concave edge the body is where it is behind either, and each of the two facets keeps a row of its own.
        """
        seen = sight(self.pairs, x, self.size)
        choice = choose(seen, self.count, self.slots, self.start, self.above)
        rows = np.flatnonzero(choice.pair >= 0)
        pair = choice.pair.ravel()[rows]
        keep = seen.inner[pair] | choice.extended[pair] | (seen.height[pair] > 0.0)
        return Held(pairs=self.pairs.take(pair[keep]), rows=rows[keep], count=choice.pair.size)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Held:
    """Rows (p,) out of ``count`` with facets that do not change and have no edges."""

    pairs: Pairs
    rows: IntArray
    count: int

    @property
    def found(self) -> int:
        """Pairs that are kept."""
        return len(self.rows)

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, d)."""
        feet = self.pairs.feet(x, continued)
        gap = dot(feet.normal, feet.offset)
        return self.pairs.stencils(self.rows, self.count, feet, gap, feet.normal, len(x))
