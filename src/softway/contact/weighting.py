"""The functions by which the gaps of the slave nodes are weighted, on every simplex of the slave surface."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.contact.dual import dual, warping
from softway.contact.straight import Straight, pieces
from softway.typing import Array, IntArray

LEAST = 1e-9
"""Share of a facet below which its being covered does not count."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Weighting:
    """Linear functions on the slave simplices, of which at most b do not vanish on each.

    Parameters
    ----------
    row
        (b, p) control points that the functions belong to.
    values
        (b, k, p) of the functions at the corners of the simplices.
    own
        (m, m) integrals of the functions times the slave's shape functions, over what is covered [m^r].
    """

    row: IntArray
    values: Array
    own: sp.csr_array

    def integrals(self, simplex: IntArray, cross: Array, corner: IntArray, vertices: int) -> sp.csr_array:
        """Integrals (m, v) of the functions times the master's shape functions [m^r].

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
        out = np.zeros((self.own.shape[0], len(vectors)))
        for row, value in zip(np.take(self.row, simplex, axis=1), block, strict=True):
            np.add.at(out, row, (value * vectors).T)
        return out


def weighting(slave: Straight, points: Array, size: Array, mass: Array) -> Weighting:
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
    row, values = np.zeros((width, p), dtype=np.int64), np.zeros((width, k, p))
    own, first = sp.csr_array((m, m)), 0
    for kind, cells in slave.facets.items():
        shapes = pieces(kind)
        (f, b), q = cells.shape, len(shapes)
        part = slice(first, first + f * q)
        whole = np.einsum("qkb,klfq,qlc->fbc", shapes, mass[..., part].reshape(k, k, f, q), shapes, optimize=True)
        share = whole.sum(axis=(1, 2)) / size[part].reshape(f, q).sum(axis=1)
        whole *= (share > LEAST)[:, None, None]
        made = dual(whole, share, warping(points[cells]) if kind == "quad4" else None)
        row[:b, part] = np.repeat(cells.T, q, axis=1)
        values[:b, :, part] = np.einsum("fbc,qkc->bkfq", made.coefficients, shapes).reshape(b, k, f * q)
        own = own + _summed(cells[:, :, None], cells[:, None, :], made.own, (m, m))
        first += f * q
    return Weighting(row=row, values=values, own=own)


def _summed(row: IntArray, column: IntArray, value: Array, shape: tuple[int, int]) -> sp.csr_array:
    """Sparse matrix of values that belong to rows and columns, both broadcast to them."""
    parts = (value.ravel(), tuple(np.broadcast_to(index, value.shape).ravel() for index in (row, column)))
    made = sp.csr_array(parts, shape=shape)
    made.eliminate_zeros()
    return made
