"""Nodes of a surface that follow another surface: dual mortar weights for all components, without inequalities.

The dual basis makes the matrix of the following nodes diagonal, so that their motion is an explicit mean of that of the
other surface (docs/theory/contact/ties.md).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.arrays import Array, IntArray
from softway.contact.mortar.facet_pairs import unit
from softway.contact.mortar.gap_weights import gap_weights
from softway.contact.mortar.linear_surface import LINEAR, LinearSurface
from softway.contact.mortar.mortar import Mortar
from softway.contact.mortar.overlap import Overlap
from softway.kernels.mortar.simplices import vector_areas
from softway.kernels.mortar.tables import Functions

LEAST = 1e-14
"""Weight below which a node has no part in the motion of another."""
SLIVER = 1e-6
"""Covered fraction of a simplex, or around a node, below which it is off the surface."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Following:
    """Nodes that follow a surface.

    Parameters
    ----------
    node
        (m,) nodes that follow.
    weights
        (m, n) their motion from that of all nodes; the rows add up to one, and are empty for nodes off the surface.
    covered, facing
        Cell name -> (f,) covered fractions of the facets of the nodes, and of those of the surface that they follow.
    """

    node: IntArray
    weights: sp.csr_array
    covered: Mapping[str, Array]
    facing: Mapping[str, Array]


def following(slave: Mapping[str, IntArray], master: Mapping[str, IntArray], x: Array, reach: float) -> Following:
    """Nodes of the facets ``slave`` that follow the facets ``master``, both cell name -> (f, b) nodes turned outward.

    Parameters
    ----------
    slave, master
        The surfaces.
    x
        (n, d) positions at which they are glued [m].
    reach
        Greatest distance of the surfaces [m].

    Examples
    --------
    >>> x = np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [2.0, 0.0]])
    >>> found = following({"bar2": np.array([[1, 0]])}, {"bar2": np.array([[2, 3]])}, x, 0.1)
    >>> (3.0 * found.weights.toarray()).round(12).tolist(), found.facing["bar2"].round(12).tolist()
    ([[0.0, 0.0, 2.0, 1.0], [0.0, 0.0, 1.0, 2.0]], [0.333333333333])
    """
    both = common_parts(slave, master, x, reach)
    return Following(
        node=both.mortar.slave.node,
        weights=_weights(both),
        covered=_of_facets(slave, both.mortar.slave, both.part, both.sizes[0]),
        facing=_of_facets(
            master,
            both.mortar.master,
            np.bincount(both.common.master, both.common.measure, len(both.sizes[1])).astype(float),
            both.sizes[1],
        ),
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CommonParts:
    """Common parts of two surfaces.

    Parameters
    ----------
    mortar
        The surfaces.
    nodes
        Number n of the nodes of the model.
    weights
        (m, p) weights of the simplices that may overlap for the nodes.
    common
        Overlaps of their simplices.
    functions
        Dual functions on the covered parts.
    part
        (p,) covered length or area of the simplices of the first surface [m^r].
    sizes
        Lengths or areas (p,) and (q,) of the simplices [m^r].
    """

    mortar: Mortar
    nodes: int
    weights: sp.csr_array
    common: Overlap
    functions: Functions
    part: Array
    sizes: tuple[Array, Array]

    @property
    def own(self) -> sp.csr_array:
        """Integrals (m, c) of the dual functions times those of the control points [m^r]."""
        slave, facets = self.mortar.slave, self.mortar.tables.facets
        facet, row, column = np.nonzero(self.functions.own)
        cells, c = facets.cells[facet], slave.control.shape[0]
        place = (np.take_along_axis(cells, k[:, None], axis=1).ravel() for k in (row, column))
        return slave.nodal(sp.csr_array((self.functions.own[facet, row, column], tuple(place)), (c, c)))

    @property
    def cross(self) -> sp.csr_array:
        """Integrals (m, n) of the dual functions times the motion of the other surface [m^r]."""
        slave, master, facets = self.mortar.slave, self.mortar.master, self.mortar.tables.facets
        block = self.functions.values[self.common.slave] @ self.common.cross
        cells = np.repeat(facets.cells, np.diff(facets.simplex), axis=0)[self.common.slave]
        pair, row, column = np.nonzero(block)
        place = cells[pair, row], master.corner[self.common.master][pair, column]
        shape = (slave.control.shape[0], master.spread.shape[0])
        found = slave.nodal(sp.csr_array((block[pair, row, column], place), shape))
        return sp.csr_array(found @ (master.spread @ master.onto(self.nodes)))


def common_parts(slave: Mapping[str, IntArray], master: Mapping[str, IntArray], x: Array, reach: float) -> CommonParts:
    """Common parts of two surfaces; arguments as of :func:`following`."""
    mortar = Mortar(slave_facets=slave, master_facets=master)
    met, tables = mortar.meet(x, x, reach), mortar.tables
    below, above = tables.vertices(x)
    areas = vector_areas(below, tables.slave.corner)
    common = met.overlap(below, above, areas, -unit(met.vertex_weights @ areas, axis=1))
    mass = common.mass(len(areas))
    size, other = (np.sqrt(np.sum(a**2, axis=1)) for a in (areas, vector_areas(above, tables.master.corner)))
    part = mass.sum(axis=(1, 2))
    return CommonParts(
        mortar=mortar,
        nodes=len(x),
        weights=met.vertex_weights,
        common=common,
        functions=gap_weights(
            tables.facets, below, np.where(part > SLIVER * size, part, size), mass
        ),  # dual where covered
        part=part,
        sizes=(size, other),
    )


def _weights(both: CommonParts) -> sp.csr_array:
    """Weights (m, n): the means of the surface, less what the control points have from other nodes than their own."""
    slave, own, cross = both.mortar.slave, both.own, both.cross
    if slave.sharing is not None:
        on = np.where(own.diagonal() > SLIVER * _around(slave, both.sizes[0]), 1.0, 0.0)
        whole = sp.diags_array(on) @ own @ slave.control + sp.diags_array(1.0 - on)
        return _solved(sp.csc_array(whole), sp.csc_array(sp.diags_array(on) @ cross))
    total = own.diagonal()
    means = sp.csr_array(sp.diags_array(np.where(total > 0.0, 1.0, 0.0) / np.where(total > 0.0, total, 1.0)) @ cross)
    main = slave.control.diagonal()
    others = sp.csr_array(slave.control - sp.diags_array(main))  # of corners, which are their own control points
    return _without_rounding(sp.csr_array(sp.diags_array(1.0 / main) @ (means - others @ means)))


def _around(surface: LinearSurface, sizes: Array) -> Array:
    """Length or area (m,) around the control points of the nodes, from those (p,) of the simplices [m^r]."""
    corner = surface.corner
    share = np.repeat(sizes / corner.shape[1], corner.shape[1])
    around = np.bincount(corner.ravel(), share, surface.spread.shape[0])
    return np.asarray(around[: len(surface.node)], float)


def _solved(own: sp.csc_array, cross: sp.csc_array) -> sp.csr_array:
    """Solution (m, n) of own w = cross, where eight-node facets couple the nodes."""
    used = np.flatnonzero(np.diff(cross.indptr))
    dense = splu(own).solve(cross[:, used].toarray())
    spread = sp.csr_array((np.ones(len(used)), (np.arange(len(used)), used)), shape=(len(used), cross.shape[1]))
    return _without_rounding(sp.csr_array(sp.csr_array(dense) @ spread))


def _without_rounding(weights: sp.csr_array) -> sp.csr_array:
    """Weights without those that are rounding."""
    weights.data[np.abs(weights.data) < LEAST] = 0.0
    weights.eliminate_zeros()
    weights.sort_indices()
    return weights


def _of_facets(facets: Mapping[str, IntArray], surface: LinearSurface, part: Array, whole: Array) -> dict[str, Array]:
    """Fractions (f,) of the facets by cell name, from the parts (p,) of the simplices of their linear surface."""
    of_kind, first = {}, 0
    for kind, cells in surface.facets.items():
        of_kind[kind] = first
        first += len(cells) * (4 if kind == "quad4" else 1)
    out = {}
    for cell, nodes in facets.items():
        if len(nodes):
            kind, parts = LINEAR[cell]
            q = len(parts) * (4 if kind == "quad4" else 1)
            here = slice(of_kind[kind], of_kind[kind] + q * len(nodes))
            of_kind[kind] = here.stop
            out[cell] = part[here].reshape(-1, q).sum(axis=1) / whole[here].reshape(-1, q).sum(axis=1)
    return out
