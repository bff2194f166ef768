"""Functions of the nodes that spread heat in a body and interpolate its temperature (docs/theory/heat/conduction.md).

The integrals of quadratic shape functions are zero or negative at corners of ``tri6``, ``quad8``, ``tet10`` and
``hex20``, where no capacity can be.  There the functions are

    psi_i = beta N_i + (1 - beta) lambda_i

with the linear functions lambda_i of the corners, zero for other nodes.  They sum to one, and a linear temperature is
interpolated exactly between straight edges.  Elsewhere they are the shape functions.
"""

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.quadrature import Cells
from softway.meshes.cells import CELLS, linear
from softway.meshes.element import tabulate

QUADRATIC = {"tri6": 16 / 19, "quad8": 12 / 19, "tet10": 20 / 27, "hex20": 12 / 31}
"""Part beta of the quadratic shape functions, with which the integrals over a parallelepiped or a simplex are those of
the scaled diagonal of the mass: cells whose capacities are the integrals of these functions.
"""
LEAST = 0.1
"""Least integral of the function of a corner, relative to that of its linear function; around an axis beta is less."""


def heat_functions(cells: Cells) -> Array:
    """Functions (e, q, a) of the nodes at the quadrature points of cells; their integrals are positive.

    Examples
    --------
    >>> from softway.bodies.elements.quadrature import sampled_cells
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> from softway.meshes.generators.shapes import rectangle
    >>> (one,) = sampled_cells(rectangle((2.0, 1.0), (1, 1), cell="quad8"), PlaneStrain(), "point", False).kinds
    >>> (38 * np.einsum("eq,eqa->ea", one.volume, heat_functions(one))).round(9).tolist()
    [[3.0, 3.0, 3.0, 3.0, 16.0, 16.0, 16.0, 16.0]]
    """
    name, N = cells.element.cell, cells.element.N
    if name not in QUADRATIC:
        return np.broadcast_to(N, (*cells.volume.shape, N.shape[1]))
    corners = CELLS[name].corners
    flat = np.zeros_like(N)
    flat[:, :corners] = tabulate(linear(name), cells.element.points)[0]
    straight, whole = (cells.volume @ table[:, :corners] for table in (flat, N))
    allowed = (1.0 - LEAST) * straight / np.maximum(straight - whole, np.finfo(float).tiny)
    beta = np.minimum(QUADRATIC[name], allowed.min(axis=1))[:, None, None]
    return np.asarray(beta * N + (1.0 - beta) * flat)
