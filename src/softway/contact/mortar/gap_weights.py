"""Test functions that weight the gaps of the slave nodes, on every simplex of the slave surface."""

import numpy as np

from softway.arrays import Array
from softway.kernels.mortar.gap_functions import gap_functions
from softway.kernels.mortar.tables import Facets, Functions


def gap_weights(facets: Facets, points: Array, size: Array, mass: Array) -> Functions:
    """Dual functions on the covered part of a surface.

    Parameters
    ----------
    facets
        Its facets.
    points
        (v, d) its vertices [m].
    size
        (p,) length or area of its simplices [m^r].
    mass
        (p, k, k) integrals of the products of barycentric coordinates over the covered parts of the simplices [m^r].
    """
    f, b = facets.cells.shape
    made = Functions(values=np.zeros((*mass.shape[:1], b, mass.shape[1])), own=np.zeros((f, b, b)))
    whole, coefficients = np.zeros((2, b, b))
    gap_functions(facets, points, size, mass, whole, np.zeros(4), coefficients, made.values, made.own)
    return made
