"""Mortar contact of deformable bodies: gaps weighted over the overlap of the surfaces.

The multiplier of a slave node is interpolated by a dual shape function; the row is divided by its weight, so that it
is a gap in metres and its multiplier a nodal force (docs/theory/contact/mortar.md).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.contact.mortar.curved_surface import CurvedSurface, curved_surface
from softway.contact.mortar.facet_pairs import FacetPairs, Margin, facet_pairs, unit
from softway.contact.mortar.gap_weights import gap_weights
from softway.contact.mortar.linear_surface import LinearSurface, linear_surface
from softway.contact.mortar.overlap import Overlap, overlap
from softway.contact.mortar.surface_tables import SurfaceTables, surface_tables
from softway.contact.stencils import Stencils, open_rows
from softway.kernels.mortar.rows.gap_rows import gap_rows
from softway.kernels.mortar.simplices import vector_areas


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Mortar:
    """Contact of two surfaces in the plane or in space, one row for each slave node.

    Parameters
    ----------
    slave_facets, master_facets
        Facet cell name -> (f, b) node numbers of the model, turned outward.
    thickness
        (n,) thickness of the bodies behind the nodes [m]; by default infinite.
    points
        (n, d) reference positions, at which the surfaces are curved [m]; by default they are flat.

    Examples
    --------
    A segment of length one, half a metre below one of length three:

    >>> x = np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.5], [2.0, 0.5]])
    >>> mortar = Mortar(slave_facets={"bar2": np.array([[1, 0]])}, master_facets={"bar2": np.array([[2, 3]])})
    >>> rows = mortar.meet(x, x, 1.0).at(x)
    >>> rows.gap.tolist(), rows.normal[:, 1].tolist(), (3.0 * rows.weights.toarray()[0]).round(12).tolist()
    ([0.5, 0.5], [-1.0, -1.0], [3.0, 0.0, -2.0, -1.0])
    """

    slave_facets: Mapping[str, IntArray]
    master_facets: Mapping[str, IntArray]
    thickness: Array | None = None
    points: Array | None = None
    slave: LinearSurface = field(init=False, repr=False)
    master: LinearSurface = field(init=False, repr=False)
    tables: SurfaceTables = field(init=False, repr=False)
    support: sp.csr_array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "slave", linear_surface(self.slave_facets))
        object.__setattr__(self, "master", linear_surface(self.master_facets))
        curved = None if self.points is None else self._curved(self.points)
        object.__setattr__(self, "tables", surface_tables(self.slave, self.master, curved))
        object.__setattr__(self, "support", self._vertex_weights(np.arange(len(self.slave.corner))))

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return self.slave.node

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> "MortarContact":
        """Pairs that may touch on the way from x0 to x1 (n, d), and within ``reach`` [m] of it.

        With a ``margin`` [m], there are pairs only around the nodes of slave simplices that come within it.
        """
        start, end = self.tables.vertices(x0), self.tables.vertices(x1)
        slave = tuple(corners_of(x, self.slave.corner) for x in (start[0], end[0]))
        master = tuple(corners_of(x, self.master.corner) for x in (start[1], end[1]))
        thickness = self.slave.thickness(self.thickness), self.master.thickness(self.thickness)
        close = None if margin is None else Margin(distance=margin, support=self.support)
        pairs = facet_pairs((slave[0], slave[1]), (master[0], master[1]), reach, thickness, close)
        some = pairs.slave[np.diff(pairs.slave, prepend=-1) > 0]
        weights = self.support if len(some) == len(self.slave.corner) else self._vertex_weights(some)
        return MortarContact(slave=self.slave, tables=self.tables, pairs=pairs, vertex_weights=weights)

    @property
    def greatest_height(self) -> float:
        """Bound of the heights of both surfaces above their simplices in the reference, added up [m]."""
        if self.points is None:
            return 0.0
        found = self.tables.heights(self.points, *self.tables.vertices(self.points))
        return sum(float(form.max(initial=0.0)) for form in found)

    def _curved(self, points: Array) -> tuple[CurvedSurface, CurvedSurface] | None:
        """Heights of both surfaces above their simplices; None if both are flat."""
        one = curved_surface(self.slave, self.slave_facets, points)
        two = curved_surface(self.master, self.master_facets, points)
        return None if one.flat and two.flat else (one, two)

    def _vertex_weights(self, taking_part: IntArray) -> sp.csr_array:
        """Weights (m, p) of the slave simplices ``taking_part`` (k,) for the nodes."""
        p, k = self.slave.corner.shape
        if not len(taking_part):
            return sp.csr_array((len(self.slave.node), p))
        column, row = np.repeat(taking_part, k), self.slave.corner[taking_part].ravel()
        incidence = sp.csr_array((np.full(len(row), 1.0 / k), (row, column)), (self.slave.spread.shape[0], p))
        return self.slave.nodal(sp.csr_array(self.slave.spread.T @ incidence))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MortarContact:
    """Mortar contact in a slab.

    Parameters
    ----------
    slave
        The slave surface.
    tables
        Arrays of both surfaces.
    pairs
        Simplices that may touch.
    vertex_weights
        (m, p) weights of the slave simplices that may touch for the nodes.
    """

    slave: LinearSurface
    tables: SurfaceTables
    pairs: FacetPairs
    vertex_weights: sp.csr_array

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        return len(self.pairs.slave)

    def at(self, x: Array) -> Stencils:
        """Gaps at the positions x (n, d) [m]; their derivatives keep the weights at x constant.

        Where no opponent is in reach the normal is that of the surface, or zero if no facet may touch in the slab.
        """
        if not self.found:
            return open_rows(self.vertex_weights.shape[0], *x.shape)
        tables, (n, d) = self.tables, x.shape
        below, above = tables.vertices(x)
        areas = vector_areas(below, tables.slave.corner)
        normal = -unit(self.vertex_weights @ areas, axis=1)
        common = self.overlap(below, above, areas, normal)
        size = np.sqrt(np.sum(areas**2, axis=1))
        functions = gap_weights(tables.facets, below, size, common.mass(len(size)))
        gap, made = gap_rows(
            (tables.slave, tables.master, tables.facets),
            functions,
            common.pairs(len(size)),
            (below, above),
            tables.heights(x, below, above),
            size,
            tables.node,
            x[tables.node],
            normal,
        )
        weights = _rows(made.weight, made.column, made.first, n)
        slopes = _rows(made.slope, made.component, made.start, n * d)
        return Stencils(gap=gap, normal=normal, weights=weights, slopes=slopes)

    def overlap(self, below: Array, above: Array, areas: Array, normal: Array) -> Overlap:
        """Overlap of the pairs; arguments as of :func:`~softway.contact.mortar.overlap.overlap`."""
        return overlap(self.tables, self.pairs, below, above, areas, normal)


def corners_of(vertices: Array, corner: IntArray) -> Array:
    """Coordinates (d, k, p) of the corners (p, k) of simplices, for vertices (v, d)."""
    return np.take(np.ascontiguousarray(vertices.T), corner.T, axis=1)


def _rows(value: Array, column: IntArray, start: IntArray, width: int) -> sp.csr_array:
    """Rows (m, width) of entries for which there is more place than needed."""
    return sp.csr_array((value[: start[-1]], column[: start[-1]], start), (len(start) - 1, width))
