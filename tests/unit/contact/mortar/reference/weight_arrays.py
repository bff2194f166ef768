"""NumPy reference: test functions that weight the gaps of the slave nodes, on every simplex of the slave surface."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from dual_arrays import dual_basis, warping

from softway.arrays import Array, IntArray
from softway.contact.mortar.linear_surface import LinearSurface, pieces

LEAST = 1e-9
"""Covered fraction of a facet below which it is ignored."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GapWeights:
    """Linear functions on the slave simplices; at most b of them do not vanish on each simplex.

    Parameters
    ----------
    row
        (b, p) control points that the functions belong to.
    values
        (b, k, p) values of the functions at the corners of the simplices.
    own
        (m, m) integrals of the functions times the shape functions of the slave, over the covered parts [m^r].
    """

    row: IntArray
    values: Array
    own: sp.csr_array

    def integrals(self, simplex: IntArray, cross: Array, corner: IntArray, vertices: int) -> sp.csr_array:
        """Integrals (m, v) of the functions times the shape functions of the master [m^r].

        Parameters
        ----------
        simplex
            (s,) slave simplex of each pair.
        cross
            (k, k, s) integrals of the pairs.
        corner
            (k, s) vertices of the master simplices.
        vertices
            Number v of the vertices of the master.
        """
        block = np.einsum("bks,kls->bls", np.take(self.values, simplex, axis=2), cross)
        return _summed(np.take(self.row, simplex, axis=1)[:, None], corner[None], block, (self.own.shape[0], vertices))

    def means(self, simplex: IntArray, cross: Array, vectors: Array) -> Array:
        """Integrals (m, d) of the functions times vectors (d, s) that are constant over each pair."""
        block = np.einsum("bks,ks->bs", np.take(self.values, simplex, axis=2), cross.sum(axis=1))
        out = np.zeros((self.own.shape[0], len(vectors)), block.dtype)
        for row, value in zip(np.take(self.row, simplex, axis=1), block, strict=True):
            np.add.at(out, row, (value * vectors).T)
        return out


def gap_weights(slave: LinearSurface, points: Array, size: Array, mass: Array) -> GapWeights:
    """Dual functions on the covered part of a surface.

    Parameters
    ----------
    slave
        The surface.
    points
        (m, d) its control points [m].
    size
        (p,) length or area of its simplices [m^r].
    mass
        (k, k, p) integrals of the products of barycentric coordinates over the covered parts of the simplices [m^r].
    """
    k, p, m = len(mass), len(size), len(points)
    width = max(cells.shape[1] for cells in slave.facets.values())
    row, values = np.zeros((width, p), dtype=np.int64), np.zeros((width, k, p), mass.dtype)
    own, first = sp.csr_array((m, m)), 0
    for kind, cells in slave.facets.items():
        shapes = pieces(kind)
        (f, b), q = cells.shape, len(shapes)
        here = slice(first, first + f * q)
        facet_mass = np.einsum("qkb,klfq,qlc->fbc", shapes, mass[..., here].reshape(k, k, f, q), shapes, optimize=True)
        coverage = facet_mass.sum(axis=(1, 2)) / size[here].reshape(f, q).sum(axis=1)
        facet_mass *= (np.real(coverage) > LEAST)[:, None, None]
        made = dual_basis(facet_mass, coverage, warping(points[cells]) if kind == "quad4" else None)
        row[:b, here] = np.repeat(cells.T, q, axis=1)
        values[:b, :, here] = np.einsum("fbc,qkc->bkfq", made.coefficients, shapes).reshape(b, k, f * q)
        own = own + _summed(cells[:, :, None], cells[:, None, :], made.own, (m, m))
        first += f * q
    return GapWeights(row=row, values=values, own=own)


def _summed(row: IntArray, column: IntArray, value: Array, shape: tuple[int, int]) -> sp.csr_array:
    """Sparse matrix of values with their rows and columns, which are broadcast to the values."""
    parts = (value.ravel(), tuple(np.broadcast_to(index, value.shape).ravel() for index in (row, column)))
    made = sp.csr_array(parts, shape=shape)
    made.eliminate_zeros()
    return made
