"""Nodes of one side against the facets of the other, in one, two and three dimensions."""

from dataclasses import dataclass
from functools import reduce

import numpy as np

from softway.contact.choice import SAME
from softway.contact.meeting import Meeting
from softway.contact.search import near, sweep
from softway.contact.side import Side
from softway.contact.sight import BEHIND, Sight, dip, sight
from softway.contact.slave_pairs import Pairs, firsts
from softway.kernels.closest import dot
from softway.space.cells import CELLS
from softway.typing import Array, BoolArray, IntArray

INSIDE = 0.1
"""Share of the size of a facet by which a slave may begin a slab inside a body and is still led out."""
LOOKING = -0.2
"""Product of the normals of a facet and of the surface around a slave up to which they look at each other."""
SWELLING = 0.3
"""Share of its width by which a quadratic facet may stick out of the box of its nodes."""
LEBESGUE = 5.0 / 3.0
"""Greatest motion of a point of a quadratic facet over that of its nodes."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodesOnFaces:
    """Contact of slave nodes with the facets of a side.

    Row ``i * slots`` of slave i is the facet that counts first, see :mod:`softway.contact.meeting`; further rows are
    facets that face it at an angle: the other walls of a corner or a wedge.  Facets that contain the slave are never
    candidates.

    Parameters
    ----------
    slaves
        (s,) nodes.
    side
        Facets that the slaves may touch.
    slots
        Rows of each slave; by default the dimension of space.
    own
        Side that the slaves belong to.  A facet that none of its facets around a slave looks at is no candidate: the
        lower corner of a block that stands on another one does not touch the walls of that one.

    Examples
    --------
    A node 0.1 above the middle of a segment:

    >>> x = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, -0.1]])
    >>> contact = NodesOnFaces(slaves=np.array([2]), side=Side(facets={"bar2": np.array([[0, 1]])}), slots=1)
    >>> rows = contact.meet(x, x, reach=0.5).at(x)
    >>> [v.round(12).tolist() for v in (rows.gap, rows.normal, rows.weights.toarray())]
    [[0.1], [[0.0, -1.0]], [[-0.5, -0.5, 1.0]]]
    """

    slaves: IntArray
    side: Side
    slots: int = 0
    own: Side | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "slaves", np.asarray(self.slaves, dtype=np.int64))
        object.__setattr__(self, "slots", self.slots or self.side.dim)

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return np.repeat(self.slaves, self.slots)

    def meet(self, x0: Array, x1: Array, reach: float) -> Meeting:
        """What may touch in a slab.

        Parameters
        ----------
        x0, x1
            (n, d) positions at its start, and those expected at its end [m].
        reach
            Distance by which the motion may differ from the expected one [m], greater than zero.
        """
        curved = max(CELLS[kind].order for kind in self.side.facets) > 1
        swelling = SWELLING if curved else 0.0
        facets = sweep(x0, x1, self.side.table, swelling)
        slave, facet = near(sweep(x0, x1, self.slaves[:, None]), facets, reach)
        own = (self.side.table.T[:, facet] == self.slaves[slave]).any(axis=0)
        slave, facet = slave[~own], facet[~own]
        pairs = Pairs(side=self.side, slave=slave, node=self.slaves[slave], facet=facet)
        widths = np.linalg.norm(facets.half, axis=1) / (0.5 + swelling)
        size = widths[facet] if self.side.dim > 1 else np.full(len(facet), reach)
        seen = sight(pairs, x0, size)
        apart = [(x1 - x0)[nodes] - (x1 - x0)[pairs.node] for nodes in pairs.masters.T]
        travel = np.sqrt(reduce(np.maximum, [dot(way, way) for way in apart]))
        close = seen.distance <= (LEBESGUE if curved else 1.0) * travel + reach
        keep = close & _in_front(seen) & self._looked_at(seen)
        return Meeting(
            pairs=pairs.take(keep),
            count=len(self.slaves),
            slots=self.slots,
            start=x0,
            size=size[keep],
            above=seen.height[keep],
        )

    def _looked_at(self, seen: Sight) -> BoolArray:
        """Facets (p,) that the surface around their slave looks at."""
        if self.own is None or self.side.dim == 1:
            return np.ones(len(seen.size), bool)
        looks = self.own.looks(seen.x)[np.searchsorted(self.own.nodes, seen.pairs.node)]
        return np.asarray(np.einsum("pkd,pd->pk", looks, seen.feet.normal).min(axis=1) <= LOOKING)


def _in_front(seen: Sight) -> BoolArray:
    """Facets (p,) that look towards their slave, out of those that it may reach.

    A slave that touches a convex piece of surface is behind the facets next to the one that it touches; as far as the
    surface may dip they count.  The nearest facets count even when the slave begins behind them, unless it does so
    deep: it has to come out there.
    """
    slave, size = seen.pairs.slave, seen.size
    tied = seen.distance <= seen.pairs.least(seen.distance) + SAME * size
    square = np.where(tied, np.abs(seen.height), -1.0)
    order = np.lexsort((-square, slave))
    nearest = order[firsts(slave[order])]
    normal = np.repeat(seen.feet.normal[nearest], np.diff(firsts(slave), append=len(slave)), axis=0)
    slope = dip(dot(seen.feet.normal, normal))
    return np.asarray(seen.height >= -np.where(tied, INSIDE * size, slope * seen.distance + BEHIND * size))
