"""Test functions that weight the gaps of the slave nodes, on every simplex of the slave surface."""

import numpy as np

from softway.arrays import Array
from softway.contact.mortar.dual_basis import dual_basis, warping
from softway.contact.mortar.linear_surface import LinearSurface, pieces
from softway.kernels.mortar.tables import Functions

LEAST = 1e-9
"""Covered fraction of a facet below which it is ignored."""


def gap_weights(slave: LinearSurface, points: Array, size: Array, mass: Array) -> Functions:
    """Dual functions on the covered part of a surface.

    Parameters
    ----------
    slave
        The surface.
    points
        (v, d) its vertices [m].
    size
        (p,) length or area of its simplices [m^r].
    mass
        (p, k, k) integrals of the products of barycentric coordinates over the covered parts of the simplices [m^r].
    """
    width, count = max(c.shape[1] for c in slave.facets.values()), sum(map(len, slave.facets.values()))
    values, own = np.zeros((len(size), width, mass.shape[1])), np.zeros((count, width, width))
    facet = simplex = 0
    for kind, cells in slave.facets.items():
        shapes = pieces(kind)
        (f, b), q = cells.shape, len(shapes)
        here = slice(simplex, simplex + f * q)
        parts = mass[here].reshape(f, q, *mass.shape[1:])
        facet_mass = (np.swapaxes(shapes, 1, 2) @ parts @ shapes).sum(axis=1)
        coverage = facet_mass.sum(axis=(1, 2)) / size[here].reshape(f, q).sum(axis=1)
        facet_mass *= (coverage > LEAST)[:, None, None]
        made = dual_basis(facet_mass, coverage, warping(points[cells]) if kind == "quad4" else None)
        at_corners = made.coefficients[:, None] @ np.swapaxes(shapes, 1, 2)
        values[here, :b] = at_corners.reshape(f * q, b, -1)
        own[facet : facet + f, :b, :b] = made.own
        facet, simplex = facet + f, here.stop
    return Functions(values=values, own=own)
