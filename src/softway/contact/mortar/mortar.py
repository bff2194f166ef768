"""Mortar contact of deformable bodies: gaps weighted over the overlap of the surfaces.

The multiplier of a slave node is interpolated by a dual shape function; the row is divided by its weight, so that it
is a gap in metres and its multiplier a nodal force (docs/theory/contact/mortar.md).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.mortar import overlap_2d, overlap_3d
from softway.contact.mortar.facet_pairs import FacetPairs, Margin, facet_pairs, unit, vector_areas
from softway.contact.mortar.gap_weights import gap_weights
from softway.contact.mortar.linear_surface import LinearSurface, linear_surface
from softway.contact.mortar.overlap import Overlap
from softway.contact.stencils import Stencils, interleaved, open_rows

STEEP = 0.2
"""Lower bound of the cosine between two surfaces when their distance is measured."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Mortar:
    """Contact of two surfaces in the plane or in space, one row for each slave node.

    Parameters
    ----------
    slave_facets, master_facets
        Facet cell name -> (f, b) node numbers of the model, turned outward.
    thickness
        (n,) thickness of the bodies behind the nodes [m]; by default infinite.

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
    slave: LinearSurface = field(init=False, repr=False)
    master: LinearSurface = field(init=False, repr=False)
    support: sp.csr_array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "slave", linear_surface(self.slave_facets))
        object.__setattr__(self, "master", linear_surface(self.master_facets))
        object.__setattr__(self, "support", self._vertex_weights(np.arange(len(self.slave.corner))))

    @property
    def node(self) -> IntArray:
        """Slave node (m,) of each row."""
        return self.slave.node

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> "MortarContact":
        """Pairs that may touch on the way from x0 to x1 (n, d), and within ``reach`` [m] of it.

        With a ``margin`` [m], there are pairs only around the nodes of slave simplices that come within it.
        """
        control, lift = self.slave.onto(len(x0)), self.master.spread @ self.master.onto(len(x0))
        spread = self.slave.spread @ control
        slave = tuple(corners_of(spread @ x, self.slave.corner) for x in (x0, x1))
        master = tuple(corners_of(lift @ x, self.master.corner) for x in (x0, x1))
        thickness = self.slave.thickness(self.thickness), self.master.thickness(self.thickness)
        close = None if margin is None else Margin(distance=margin, support=self.support)
        pairs = facet_pairs((slave[0], slave[1]), (master[0], master[1]), reach, thickness, close)
        return MortarContact(
            slave=self.slave,
            master=self.master,
            control=control,
            lift=lift,
            pairs=pairs,
            vertex_weights=self._vertex_weights(np.unique(pairs.slave)),
        )

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
    slave, master
        The surfaces.
    control
        (c, n) control points of the slave from the nodes of the model.
    lift
        (v, n) vertices of the master from the nodes of the model.
    pairs
        Simplices that may touch.
    vertex_weights
        (m, p) weights of the slave simplices that may touch for the nodes.
    """

    slave: LinearSurface
    master: LinearSurface
    control: sp.csr_array
    lift: sp.csr_array
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
        points = self.control @ x
        to_slave = self.slave.spread @ self.control
        slave_nodes = self.slave.spread @ points
        slave = corners_of(slave_nodes, self.slave.corner)
        master = corners_of(self.lift @ x, self.master.corner)
        areas = vector_areas(slave)
        normal = -unit(self.vertex_weights @ areas.T, axis=1)
        common = self.overlap(slave, areas, master, normal)
        i, j = self.pairs.slave[common.pair], self.pairs.master[common.pair]
        size = np.sqrt(np.sum(areas**2, axis=0))
        functions = gap_weights(self.slave, points, size, common.mass(i, len(size)))
        nodal = self.slave.nodal
        own = nodal(functions.own)
        cross = nodal(functions.integrals(i, common.cross, self.master.corner.T[:, j], self.lift.shape[0]))
        total, covered = cross.sum(axis=1), own.sum(axis=1)
        met = (total > 0.0) & (covered > 0.0)
        weights = _over(own @ self.control, covered, met) - _over(cross @ self.lift, total, met)
        square = np.take(unit(areas), i, axis=1)
        facing = _seen(square, master, j)
        normal = np.where(met[:, None], unit(nodal(functions.means(i, common.cross, facing)), axis=1), normal)
        turn = _turning(slave, master, facing, common, (i, j))
        parts = (
            functions.integrals(i, common.own * n + turn * p, self.slave.corner.T[:, i], len(slave_nodes)) @ to_slave
            - functions.integrals(i, common.cross * n, self.master.corner.T[:, j], self.lift.shape[0]) @ self.lift
            for n, p in zip(facing, square, strict=True)
        )
        slopes = interleaved([_over(nodal(sp.csr_array(p)), total, met) for p in parts])
        gap = np.where(met, slopes @ x.ravel(), np.inf)
        return Stencils(gap=gap, normal=normal, weights=weights, slopes=slopes)

    def overlap(self, slave: Array, areas: Array, master: Array, normal: Array) -> Overlap:
        """Overlap of the pairs within their limits.

        Arguments: corners (d, k, p) and vector areas (d, p) of the slave simplices, corners of the master simplices,
        normals (m, d) of the rows.
        """
        i, j = self.pairs.slave, self.pairs.master
        if len(slave) == 2:
            common = overlap_2d.overlap(slave, -corners_of(normal, self.slave.corner), master, i, j)
        else:
            common = overlap_3d.overlap(slave, master, i, j)
        i, j = i[common.pair], j[common.pair]
        apart = np.einsum("ks,dks->ds", common.cross.sum(axis=0), np.take(master, j, axis=2))
        apart -= np.einsum("ks,dks->ds", common.own.sum(axis=0), np.take(slave, i, axis=2))
        height, measure = np.sum(apart * np.take(unit(areas), i, axis=1), axis=0), common.measure
        return common.subset((measure > 0.0) & (np.abs(height) <= self.pairs.limit[common.pair] * measure))


def _seen(square: Array, master: Array, j: IntArray) -> Array:
    """Derivatives (d, s) of the distance along the slave normals ``square`` (d, s) to the master simplices j (s,), when
    the slave shifts: the master normal divided by its cosine.  ``master`` (d, k, q) are the corners.
    """
    normal = np.take(unit(vector_areas(master)), j, axis=1)
    return np.asarray(normal / np.maximum(-np.sum(square * normal, axis=0), STEEP))


def _turning(slave: Array, master: Array, facing: Array, common: Overlap, pair: tuple[IntArray, IntArray]) -> Array:
    """Integrals (k, k, s) of coordinates on the slave times the change of the distance, when its corners move along
    the normal.

    The direction in which the distance is measured turns with the slave: without this term a row of two surfaces that
    are not parallel would have a moment.  Arguments: corners (d, k, p), (d, k, q); the slopes (d, s) of the distance.
    """
    i, j = pair
    own = np.einsum("dks,ds->ks", np.take(slave, i, axis=2), facing)
    other = np.einsum("dks,ds->ks", np.take(master, j, axis=2), facing)
    distance = np.einsum("abs,bs->as", common.own, own) - np.einsum("abs,bs->as", common.cross, other)
    lean = np.einsum("dks,ds->ks", np.take(_gradients(slave), i, axis=2), facing)
    return np.asarray(-distance[:, None] * lean[None])


def _gradients(corners: Array) -> Array:
    """Gradients (d, k, p), along the simplices, of the barycentric coordinates of corners (d, k, p).

    Examples
    --------
    >>> _gradients(np.array([[0.0, 2.0], [0.0, 0.0]])[:, :, None])[0, :, 0].tolist()
    [-0.5, 0.5]
    """
    if len(corners) == 2:
        run = corners[:, 1] - corners[:, 0]
        slope = run / np.sum(run**2, axis=0)
        return np.stack([-slope, slope], axis=1)
    edge = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    area = np.cross(edge[:, 0], edge[:, 1], axis=0)
    return np.asarray(np.cross(area[:, None], edge, axis=0) / np.sum(area**2, axis=0))


def corners_of(vertices: Array, corner: IntArray) -> Array:
    """Coordinates (d, k, p) of the corners (p, k) of simplices, for vertices (v, d)."""
    return np.take(np.ascontiguousarray(vertices.T), corner.T, axis=1)


def _over(matrix: sp.csr_array, total: Array, met: BoolArray) -> sp.csr_array:
    """Rows divided by their totals (m,) where ``met``; the other rows are empty."""
    factor = np.where(met, 1.0, 0.0) / np.where(met, total, 1.0)
    made = sp.csr_array(
        (matrix.data * np.repeat(factor, np.diff(matrix.indptr)), matrix.indices, matrix.indptr), matrix.shape
    )
    made.eliminate_zeros()
    return made
