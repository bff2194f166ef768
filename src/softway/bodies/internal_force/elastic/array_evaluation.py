"""Internal force of stored energies by NumPy, for every law and section."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array
from softway.bodies.elements.strain_operator import StrainOperator, diagonal_blocks
from softway.bodies.internal_force.elastic.material_points import MaterialPoints


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ArrayEvaluation:
    """Energy, force and tangent by arrays over all points of a body.

    The displacement u is (n, d) [m].

    Parameters
    ----------
    sampling
        Strain operator between nodes and quadrature points.
    points
        Material points.
    """

    sampling: StrainOperator
    points: MaterialPoints

    def derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) at the points."""
        return self.sampling.derivatives(u)

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative with respect to the displacement, (n, d) [N]."""
        energy, flux = self.points.energy_and_flux(self.derivatives(u))
        return float(self.sampling.volume @ energy), self.sampling.nodal(flux, u)

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        H = self.derivatives(u)
        flux = np.zeros_like(H) if self.sampling.dilatation is None else self.points.flux(H)
        return self.sampling.matrix(self.points.moduli(H), flux, u)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return (self.tangent(u) @ w.ravel()).reshape(w.shape)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        return diagonal_blocks(self.tangent(u), (u.shape[0], u.shape[1]))
