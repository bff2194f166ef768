"""Contact of nodes of one surface with facets of the other, in one, two and three dimensions."""

from dataclasses import dataclass
from functools import reduce

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.node_to_surface.admissible_pairs import AdmissiblePairs
from softway.contact.node_to_surface.facet_projection import BEHIND, FacetProjection, convex_drop, project
from softway.contact.node_to_surface.facet_selection import SAME
from softway.contact.node_to_surface.pairs import NodeFacetPairs, firsts
from softway.contact.node_to_surface.slab_pairs import NodeFacetContact
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.broad_phase import Sweep, near, sweep
from softway.contact.surfaces.wall_thickness import admissible_depth, thickness_of
from softway.kernels.geometry.closest_points import dot
from softway.meshes.cells import CELLS

INSIDE = 0.1
"""Depth at the start of a slab, as a fraction of the facet size, up to which a slave inside a body is pushed out; less
where a body is thin, see :func:`~softway.contact.surfaces.wall_thickness.admissible_depth`."""
FACING = -0.2
"""Product of the normals of a facet and of the surface around a slave below which they face each other."""
SWELLING = {"quad8": 1.0}
"""Distance, relative to its width, by which a facet may extend beyond the box of its nodes: 0.3 of other quadratic
facets, zero of linear ones."""
LEBESGUE = {"quad8": 3.0}
"""Greatest motion of a point of a facet, relative to that of its nodes: 5/3 on other quadratic facets, 1 on linear
ones."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodeToFacet:
    """Contact of slave nodes with the facets of a surface.

    Row ``i * slots`` of slave i has its first facet, see :mod:`softway.contact.node_to_surface.slab_pairs`;
    further rows have facets that face it at an angle: the other walls of a corner or a wedge.  Facets that contain the
    slave are excluded.

    Parameters
    ----------
    slaves
        (s,) nodes.
    side
        Facets that the slaves may touch.
    slots
        Rows of each slave; by default the dimension of space.
    own
        Surface of the slaves.  A facet is excluded if no facet of this surface around the slave faces it: the lower
        corner of a block on top of another one does not touch the side walls of the other one.
    thickness
        (n,) thickness of the bodies behind the nodes [m]; by default infinite.
    admissible
        Pairs that may touch where one method handles many surfaces; by default all.
    over
        True if only slaves over a facet have rows, where all edges have rows of their own.

    Examples
    --------
    A node 0.1 above the middle of a segment:

    >>> x = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, -0.1]])
    >>> contact = NodeToFacet(slaves=np.array([2]), side=ContactSurface(facets={"bar2": np.array([[0, 1]])}), slots=1)
    >>> rows = contact.meet(x, x, reach=0.5).at(x)
    >>> [v.round(12).tolist() for v in (rows.gap, rows.normal, rows.weights.toarray())]
    [[0.1], [[0.0, -1.0]], [[-0.5, -0.5, 1.0]]]
    """

    slaves: IntArray
    side: ContactSurface
    slots: int = 0
    own: ContactSurface | None = None
    thickness: Array | None = None
    admissible: AdmissiblePairs | None = None
    over: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "slaves", np.asarray(self.slaves, dtype=np.int64))
        object.__setattr__(self, "slots", self.slots or self.side.dim)

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return np.repeat(self.slaves, self.slots)

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> NodeFacetContact:
        """Find the pairs that may touch in a slab.

        Parameters
        ----------
        x0, x1
            (n, d) positions at its start, and expected positions at its end [m].
        reach
            Distance by which the motion may differ from the expected one [m], greater than zero.
        margin
            Distance within which a slave must have a facet to have pairs at all [m]; by default the reach.
        """
        kinds = [(kind, CELLS[kind].order > 1) for kind in self.side.facets]
        swelling = max(SWELLING.get(kind, 0.3 if curved else 0.0) for kind, curved in kinds)
        magnified = max(LEBESGUE.get(kind, 5.0 / 3.0 if curved else 1.0) for kind, curved in kinds)
        facets = sweep(x0, x1, self.side.table, swelling)
        nodes = sweep(x0, x1, self.slaves[:, None])
        rows = None if margin is None else np.unique(self._near(nodes, facets, margin)[0])
        slave, facet = self._near(nodes, facets, reach, rows)
        pairs = NodeFacetPairs(side=self.side, slave=slave, node=self.slaves[slave], facet=facet)
        if not len(slave):
            none = np.zeros(0)
            return NodeFacetContact(
                pairs=pairs, count=len(self.slaves), slots=self.slots, start=x0, size=none, above=none
            )
        widths = np.linalg.norm(facets.half, axis=1) / (0.5 + swelling)
        size = widths[facet] if self.side.dim > 1 else np.full(len(facet), reach)
        seen = project(pairs, x0, size)
        apart = [(x1 - x0)[nodes] - (x1 - x0)[pairs.node] for nodes in pairs.masters.T]
        travel = np.sqrt(reduce(np.maximum, [dot(shift, shift) for shift in apart]))
        close = seen.distance <= magnified * travel + reach
        walls = thickness_of(self.thickness, pairs.node[:, None]) + thickness_of(self.thickness, pairs.masters)
        keep = close & _in_front(seen, admissible_depth(INSIDE * size, walls)) & self._in_view(seen)
        return NodeFacetContact(
            pairs=pairs.subset(keep),
            count=len(self.slaves),
            slots=self.slots,
            start=x0,
            size=size[keep],
            above=seen.height[keep],
            over=self.over,
        )

    def _near(
        self, nodes: Sweep, facets: Sweep, reach: float, rows: IntArray | None = None
    ) -> tuple[IntArray, IntArray]:
        """Slaves, only the ``rows`` (k,) among them, and facets within reach that may touch."""
        slave, facet = near(nodes, facets, reach, rows)
        own = (self.side.table.T[:, facet] == self.slaves[slave]).any(axis=0)
        if self.admissible is not None and len(slave):
            own |= ~self.admissible.nodes_and_facets(self.slaves[slave], facet)
        return slave[~own], facet[~own]

    def _in_view(self, seen: FacetProjection) -> BoolArray:
        """True for facets (p,) that the surface around their slave faces."""
        if self.own is None or self.side.dim == 1 or not len(seen.size):
            return np.ones(len(seen.size), bool)
        normals = self.own.adjacent_facet_normals(seen.x)[np.searchsorted(self.own.nodes, seen.pairs.node)]
        return np.asarray(np.einsum("pkd,pd->pk", normals, seen.feet.normal).min(axis=1) <= FACING)


def _in_front(seen: FacetProjection, inside: Array) -> BoolArray:
    """True for facets (p,) that face their slave.

    A slave that touches a convex surface is behind the facets next to the touched one; these are accepted within the
    curvature of the surface.  The nearest facets are accepted even if the slave begins behind them, unless it is deeper
    than ``inside`` (p,) [m]: it has to come out there.
    """
    slave, size = seen.pairs.slave, seen.size
    tied = seen.distance <= seen.pairs.least(seen.distance) + SAME * size
    square = np.where(tied, np.abs(seen.height), -1.0)
    order = np.lexsort((-square, slave))
    nearest = order[firsts(slave[order])]
    normal = np.repeat(seen.feet.normal[nearest], np.diff(firsts(slave), append=len(slave)), axis=0)
    slope = convex_drop(dot(seen.feet.normal, normal))
    return np.asarray(seen.height >= -np.where(tied, inside, slope * seen.distance + BEHIND * size))
