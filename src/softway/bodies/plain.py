"""Internal force by NumPy, for every stored energy and section."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.points import MaterialPoints
from softway.bodies.sampling import Sampling, diagonal_blocks
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Plain:
    """Energy, force and tangent by arrays over all the points of a body.

    The displacement u is (n, d) [m].

    Parameters
    ----------
    sampling
        From the nodes to the points and back.
    points
        The material points.
    """

    sampling: Sampling
    points: MaterialPoints

    def derivatives(self, u: Array) -> Array:
        """Displacement derivatives (p, m, D) at the points."""
        return self.sampling.derivatives(u)

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative to the displacement, (n, d) [N]."""
        energy, flux = self.points.energy_and_flux(self.derivatives(u))
        return float(self.sampling.volume @ energy), self.sampling.nodal(flux, u)

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        H = self.derivatives(u)
        flux = np.zeros_like(H) if self.sampling.dilatation is None else self.points.flux(H)
        return self.sampling.matrix(self.points.moduli(H), flux, u)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        return (self.tangent(u) @ w.ravel()).reshape(w.shape)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        return diagonal_blocks(self.tangent(u), (u.shape[0], u.shape[1]))
