"""Arrays of two surfaces for the compiled loops: they depend on the facets alone."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.contact.mortar.curved_surface import CurvedSurface, forms
from softway.contact.mortar.linear_surface import LinearSurface, pieces
from softway.kernels.mortar.tables import Facets, Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfaceTables:
    """Arrays of a slave and a master.

    Parameters
    ----------
    node
        (u,) model nodes of both surfaces, ascending.
    below, above
        (v, u) and (w, u) vertices of the slave and of the master from these nodes.
    slave, master
        The same for the loops, with the simplices.
    facets
        Facets of the slave.
    curved
        Heights of both surfaces, with offsets from the u nodes; None if both are flat.
    """

    node: IntArray
    below: sp.csr_array
    above: sp.csr_array
    slave: Vertices
    master: Vertices
    facets: Facets
    curved: tuple[CurvedSurface, CurvedSurface] | None

    def vertices(self, x: Array) -> tuple[Array, Array]:
        """Vertices (v, d) of the slave and (w, d) of the master at the positions x (n, d) of all nodes."""
        here = x[self.node]
        return self.below @ here, self.above @ here

    def heights(self, x: Array, below: Array, above: Array) -> tuple[Array, Array]:
        """Heights (p, k, k) and (q, k, k) of both surfaces above their simplices at the positions x (n, d), with their
        vertices, as quadratic forms of coordinates [m]; none if both are flat.
        """
        if self.curved is None:
            none = np.zeros((0, below.shape[1], below.shape[1]))
            return none, none
        one, two = self.curved
        here, simplices = x[self.node], (self.slave.corner, self.master.corner)
        return (
            forms(one.offsets @ here, below, simplices[0]) + one.fixed,
            forms(two.offsets @ here, above, simplices[1]) + two.fixed,
        )


def surface_tables(
    slave: LinearSurface, master: LinearSurface, curved: tuple[CurvedSurface, CurvedSurface] | None = None
) -> SurfaceTables:
    """Arrays of two surfaces, which may be ``curved``.

    Examples
    --------
    >>> from softway.contact.mortar.linear_surface import linear_surface
    >>> one, two = linear_surface({"bar2": np.array([[5, 4]])}), linear_surface({"bar2": np.array([[7, 8]])})
    >>> made = surface_tables(one, two)
    >>> made.node.tolist(), made.facets.cells.tolist(), made.slave.column.tolist(), made.master.column.tolist()
    ([4, 5, 7, 8], [[1, 0]], [0, 1], [2, 3])
    """
    node = np.union1d(slave.node, master.node)
    below, above = (_from_nodes(surface, node) for surface in (slave, master))
    if curved is not None:
        one, two = (CurvedSurface(offsets=sp.csr_array(c.offsets[:, node]), fixed=c.fixed) for c in curved)
        curved = one, two
    return SurfaceTables(
        node=node,
        below=below,
        above=above,
        slave=_vertices(below, slave),
        master=_vertices(above, master),
        curved=curved,
        facets=_facets(slave),
    )


def _from_nodes(surface: LinearSurface, node: IntArray) -> sp.csr_array:
    """Vertices (v, u) of a surface from the nodes (u,)."""
    made = sp.csr_array(surface.spread @ surface.control).tocoo()
    row, column = made.coords
    place = np.searchsorted(node, surface.node)
    return sp.csr_array((made.data, (row, place[column])), (made.shape[0], len(node)))


def _vertices(matrix: sp.csr_array, surface: LinearSurface) -> Vertices:
    """Matrix of the vertices, and simplices, for the loops."""
    start, column, corner = (np.ascontiguousarray(a, np.int64) for a in (matrix.indptr, matrix.indices, surface.corner))
    return Vertices(start=start, column=column, value=matrix.data, corner=corner, centre=surface.spread.shape[1])


def _facets(slave: LinearSurface) -> Facets:
    """Facets of a surface, and where the rows of its nodes find their test functions."""
    width = max(cells.shape[1] for cells in slave.facets.values())
    each = [(cells, len(pieces(kind))) for kind, cells in slave.facets.items()]
    cells = np.concatenate([np.pad(c, ((0, 0), (0, width - c.shape[1])), constant_values=-1) for c, _ in each])
    number = np.repeat([q for _, q in each], [len(c) for c, _ in each])
    found = np.flatnonzero(cells.ravel() >= 0)
    uses = sp.csr_array(
        (np.ones(len(found)), (cells.ravel()[found], found)), shape=(slave.control.shape[0], cells.size)
    )
    rows = sp.csr_array(slave.nodal(uses))
    rows.sort_indices()
    facet, place = np.divmod(rows.indices.astype(np.int64), width)
    return Facets(
        cells=np.ascontiguousarray(cells, np.int64),
        simplex=np.concatenate([[0], np.cumsum(number)]).astype(np.int64),
        start=rows.indptr.astype(np.int64),
        facet=facet,
        place=place,
        share=rows.data,
    )
