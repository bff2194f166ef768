"""Slave nodes and the facets that each of them may touch in a slab: which facet counts, its gap and its derivative.

For one slave and the facets that it may touch, at given positions:

*Inner* is a facet on which the foot of the slave lies; its gap is the height above it, ``normal . (x - X)``.  Beyond an
edge the gap is the distance to the edge, unless the slave stood above the facet when the slab began: then the facet is
continued beyond its edge up to the end of the slab, so that a slave does not fall past an edge that it slides over, nor
slip round a thin body that it has hit near the rim.

Only facets that look towards the slave when the slab begins are candidates, and the nearest one counts.  This is why a
thin body cannot be crossed: its far facets look away when the slab begins.  A slave that seems to be in front of its
nearest facet although it crossed another one on its straight way since then counts for the crossed one.

In every case the foot is stationary along the facet or its edge, therefore ``d gap = normal . (dx - sum_k N_k dx_k)``
is exact, and the forces ``normal`` on the slave and ``-N_k normal`` on the nodes have no resultant and no moment.
"""

from dataclasses import dataclass

import numpy as np

from softway.contact.facets import Feet, continued, nearest
from softway.contact.slave_pairs import EDGE, Pairs, View, firsts, view
from softway.contact.stencils import Stencils
from softway.kernels.closest import dot
from softway.typing import Array, BoolArray, IntArray

SAME = 1e-9
"""Share of the size of a facet by which distances are told apart."""
PARALLEL = float(np.cos(np.deg2rad(5.0)))
"""Facets whose normals differ by less than five degrees are one condition."""
BEHIND = 1e-3
"""Share of the size of a facet by which a slave may begin a slab behind it and still counts as in front of it."""
SMOOTH = 0.5
"""Cosine of the angle between the normals of two facets up to which one may continue the other smoothly."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Choice:
    """The pair (m,) of every row, -1 for none, and which pairs (p,) have a facet ``extended`` beyond its edges."""

    view: View
    pair: IntArray
    extended: BoolArray


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

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, d)."""
        choice = self._choose(x)
        rows = np.flatnonzero(choice.pair >= 0)
        pair, seen = choice.pair[rows], choice.view
        taken, inner = self.pairs.take(pair), seen.inner[pair]
        feet = Feet(shapes=seen.feet.shapes[pair], offset=seen.feet.offset[pair], normal=seen.feet.normal[pair])
        gap = np.where(inner, seen.height[pair], seen.distance[pair])
        normal = np.where(inner[:, None], feet.normal, feet.offset / np.where(inner, 1.0, gap)[:, None])
        again = np.flatnonzero(choice.extended[pair])
        if len(again):
            there = taken.take(again).feet(x, continued)
            feet.shapes[again], normal[again] = there.shapes, there.normal
            gap[again] = dot(there.normal, there.offset)
        return taken.stencils(rows, len(choice.pair), feet, gap, normal, len(x))

    def held(self, x: Array) -> "Held":
        """The meeting with the facet of every row kept as it is at x (n, d), continued beyond its edges.

        Rows whose facet is kept do not chatter between two facets.  Nothing penetrates by that: at a convex edge the
        body is where the slave is behind both facets, so in front of one of them is outside, whichever it is; at a
        concave edge the body is where it is behind either, and each of the two facets keeps a row of its own.
        """
        choice = self._choose(x)
        rows = np.flatnonzero(choice.pair >= 0)
        pair, seen = choice.pair[rows], choice.view
        keep = seen.inner[pair] | choice.extended[pair] | (seen.height[pair] > 0.0)
        return Held(pairs=self.pairs.take(pair[keep]), rows=rows[keep], count=len(choice.pair))

    def _choose(self, x: Array) -> Choice:
        """Facets of the rows at positions x (n, d)."""
        seen = view(self.pairs, x, self.size)
        pair, extended = np.full((self.count, self.slots), -1), np.zeros(len(self.size), dtype=bool)
        found = self._first(x, seen, extended)
        pair[self.pairs.slave[found], 0] = found
        struck = self._struck(x, seen, found, extended)
        pair[self.pairs.slave[struck], 0] = struck
        for slot in range(1, self.slots):
            found = self._further(x, seen, pair[:, :slot], extended) if len(found) else found
            pair[self.pairs.slave[found], slot] = found
        return Choice(view=seen, pair=pair.ravel(), extended=extended)

    def _first(self, x: Array, seen: View, extended: BoolArray) -> IntArray:
        """The nearest facet of each slave; marks those that are extended beyond an edge."""
        least = self.pairs.least(seen.distance)
        close = np.flatnonzero(seen.distance <= least + SAME * self.size)
        edge = close[~seen.inner[close]]
        extended[edge] = self._came_over(seen, edge) | self._within(x, seen, edge)
        gap = np.where(seen.inner | extended, seen.height, least)[close]
        order = close[np.lexsort((-seen.height[close], gap, self.pairs.slave[close]))]
        return order[firsts(self.pairs.slave[order])]

    def _came_over(self, seen: View, edge: IntArray) -> BoolArray:
        """Whether slaves beyond an edge of a facet were on the near side of that edge when the slab began."""
        nodes = self.start[self.pairs.masters[edge]]
        began = self.start[self.pairs.node[edge]] - np.einsum("pb,pbd->pd", seen.feet.shapes[edge], nodes)
        return np.asarray(dot(began, seen.beyond[edge]) < 0.0)

    def _within(self, x: Array, seen: View, edge: IntArray) -> BoolArray:
        """Whether slaves are inside a body at a concave edge: behind a facet whose neighbours rise before it.

        ``edge`` are pairs whose facets are nearest, at an edge.
        """
        slave, total = self.pairs.slave[edge], np.zeros((self.count, x.shape[1]))
        centre = x[self.pairs.masters[edge]].mean(axis=1)
        np.add.at(total, slave, centre)
        others = total[slave] / np.bincount(slave, minlength=self.count)[slave, None]
        foot = x[self.pairs.node[edge]] - seen.feet.offset[edge]
        rise = dot(seen.feet.normal[edge], others - foot)
        return np.asarray((seen.height[edge] < 0.0) & (rise > EDGE * self.size[edge]))

    def _struck(self, x: Array, seen: View, first: IntArray, extended: BoolArray) -> IntArray:
        """The facets that slaves crossed on their straight way, where their nearest facets do not show it.

        The nearest facet shows it when its gap is negative; and nothing happened when it continues the crossed facet
        smoothly: the slave slid over a convex piece of surface.  Marks crossed facets without feet as extended.
        """
        own, slave = seen.inner | extended, self.pairs.slave
        safe, out = np.zeros(self.count, dtype=bool), np.zeros((self.count, x.shape[1]))
        safe[slave[first]] = ~own[first] | (seen.height[first] >= 0.0)
        away = seen.feet.offset[first] / np.where(own, 1.0, seen.distance)[first, None]
        out[slave[first]] = np.where(own[first, None], seen.feet.normal[first], away)
        foot = np.zeros_like(out)
        foot[slave[first]] = x[self.pairs.node[first]] - seen.feet.offset[first]
        pair = np.flatnonzero((seen.height < 0.0) & (self.above > -BEHIND * self.size) & safe[slave])
        away = x[self.pairs.masters[pair]].mean(axis=1) - foot[slave[pair]]
        slope, cosine = dip(dot(seen.feet.normal[pair], out[slave[pair]]))
        pair = pair[dot(seen.feet.normal[pair], out[slave[pair]]) < SMOOTH]
        if not len(pair):
            return pair
        crossed, above = self.pairs.take(pair), np.maximum(self.above[pair], 0.0)
        share = above / (above - seen.height[pair])
        points, nodes = (
            self.start[k] + share.reshape(-1, *[1] * k.ndim) * (x[k] - self.start[k])
            for k in (crossed.node, crossed.masters)
        )
        feet = crossed.look(points, nodes, nearest)
        beyond = feet.offset - dot(feet.normal, feet.offset)[:, None] * feet.normal
        hit = dot(beyond, beyond) <= (EDGE * self.size[pair]) ** 2
        pair = pair[hit][np.lexsort((share[hit], slave[pair[hit]]))]
        pair = pair[firsts(slave[pair])]
        extended[pair] = ~seen.inner[pair]
        return pair

    def _further(self, x: Array, seen: View, before: IntArray, extended: BoolArray) -> IntArray:
        """The next facet of some slaves: one that faces those of the slots ``before`` (s, k) at an angle.

        The slave is over it, or was when the slab began, or it is over the other facet of their common edge; the two
        latter are marked as extended.
        """
        pair, hinged = np.arange(len(self.size)), seen.inner
        for slot in before.T:
            other = slot[self.pairs.slave[pair]]
            turned = (other >= 0) & (dot(seen.feet.normal[pair], seen.feet.normal[other]) < PARALLEL)
            pair, other, hinged = pair[turned], other[turned], hinged[turned]
            facing = self._faces(x, seen, pair, other) & self._faces(x, seen, other, pair)
            hinged = (hinged | self._hinged(seen, pair, other))[facing]
            pair = pair[facing]
        pair = pair[hinged | self._came_over(seen, pair)]
        pair = pair[np.lexsort((seen.distance[pair], self.pairs.slave[pair]))]
        pair = pair[firsts(self.pairs.slave[pair])]
        extended[pair] = ~seen.inner[pair]
        return pair

    def _hinged(self, seen: View, one: IntArray, two: IntArray) -> BoolArray:
        """Whether the closest point of the facet of a pair lies on its common edge with the facet of another."""
        used = np.abs(seen.feet.shapes[one]) > EDGE
        common = (self.pairs.masters[one][:, :, None] == self.pairs.masters[two][:, None, :]).any(axis=2)
        enough = used.sum(axis=1) >= self.start.shape[1] - 1
        return np.asarray(enough & (common | ~used).all(axis=1))

    def _faces(self, x: Array, seen: View, one: IntArray, two: IntArray) -> BoolArray:
        """Whether the facet of a pair looks towards the centre of the facet of another."""
        foot = x[self.pairs.node[one]] - seen.feet.offset[one]
        centre = x[self.pairs.masters[two]].mean(axis=1)
        return np.asarray(dot(seen.feet.normal[one], centre - foot) > 0.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Held:
    """Rows (p,) out of ``count`` with facets that do not change and have no edges."""

    pairs: Pairs
    rows: IntArray
    count: int

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, d)."""
        feet = self.pairs.feet(x, continued)
        gap = dot(feet.normal, feet.offset)
        return self.pairs.stencils(self.rows, self.count, feet, gap, feet.normal, len(x))
