"""Internal force of path-dependent laws by NumPy, for every law, rate and section."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array
from softway.bodies.elements.strain_operator import StrainOperator, diagonal_blocks
from softway.bodies.internal_force.inelastic.material_points import PointResponse, RatePoints
from softway.bodies.internal_force.material_state import MaterialState
from softway.laws.law import Damped, Viscous


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RateArrayEvaluation:
    """Evaluation of a slab by arrays over all points of a body.

    The slab of length ``span`` [s] starts from the material state ``state`` and ends at the displacement u (n, d) [m].

    Parameters
    ----------
    sampling
        Strain operator between nodes and quadrature points.
    points
        Material points.
    """

    sampling: StrainOperator
    points: RatePoints

    def response(self, u: Array, state: MaterialState, span: float) -> tuple[Array, PointResponse]:
        """Displacement derivatives (p, m, D) at the end, and the response of the points."""
        H0, H1 = self.sampling.derivatives(state.displacement), self.sampling.derivatives(u)
        return H1, self.points.respond(H0, H1, state, span)

    def energy_and_force(self, u: Array, state: MaterialState, span: float) -> tuple[float, Array]:
        """Stored energy plus the energy dissipated in the slab [J], and the force (n, d) [N] at the end of the slab."""
        return self._energy_and_force(u, state, *self.response(u, state, span))

    def _energy_and_force(self, u: Array, state: MaterialState, H: Array, found: PointResponse) -> tuple[float, Array]:
        with np.errstate(invalid="ignore"):
            taken = found.ratio * (found.response.stored + found.response.dissipated)
            flux = self.points.body_flux(self.points.stress(found), found.F, H, found.eigenstrain)
        energy = float(self.sampling.volume @ (state.stored + taken))
        return energy if np.isfinite(energy) else np.inf, self.sampling.nodal(flux, u)

    def end_force(self, u: Array, state: MaterialState, span: float) -> tuple[float, Array, Array | None]:
        """Energy [J] and force of :meth:`energy_and_force`, and the part of the force due to the mean rate of the slab,
        (n, d) [N], None without viscosity, in one evaluation.
        """
        H, found = self.response(u, state, span)
        stress = self.points.viscous_stress(found)
        viscous = None if stress is None else self.sampling.nodal(self.points.flux(stress, found.F, H), u)
        return *self._energy_and_force(u, state, H, found), viscous

    def tangent(self, u: Array, state: MaterialState, span: float) -> csc_array:
        """Derivative of the force, made symmetric, (n d, n d) [N/m]."""
        return self._stiffness(u, state, span, secant=False)

    def secant(self, u: Array, state: MaterialState, span: float) -> csc_array:
        """Tangent at fixed viscosity where the law has such moduli, otherwise :meth:`tangent`, (n d, n d) [N/m]."""
        return self._stiffness(u, state, span, secant=isinstance(self.points.law, Viscous))

    def _stiffness(self, u: Array, state: MaterialState, span: float, secant: bool) -> csc_array:
        H, found = self.response(u, state, span)
        flux = self.points.flux(self.points.geometric_stress(found), found.F, H)
        return self.sampling.matrix(self.points.moduli(found, H, secant), flux, u)

    def viscous_tangent(self, u: Array, state: MaterialState, span: float) -> csc_array | None:
        """Derivative of the viscous part of the force on the pattern of the tangent, (n d, n d) [N/m]; None without."""
        law = self.points.law
        if not isinstance(law, Damped):
            return None
        H, found = self.response(u, state, span)
        return self.sampling.matrix(self.points.viscous_moduli(law, found, H), np.zeros_like(H), u)

    def tangent_product(self, u: Array, state: MaterialState, span: float, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return np.asarray(self.tangent(u, state, span) @ w.ravel()).reshape(w.shape)

    def tangent_diagonal_blocks(self, u: Array, state: MaterialState, span: float) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        return diagonal_blocks(self.tangent(u, state, span), (u.shape[0], u.shape[1]))

    def committed(self, u: Array, state: MaterialState, span: float) -> MaterialState:
        """Material state at the end of the slab."""
        return self.points.committed(self.response(u, state, span)[1], state, u)

    def stored_force(self, state: MaterialState) -> tuple[float, Array, Array | None]:
        """Stored energy [J], force (n, d) and its viscous part (n, d) or None [N], of a committed state."""
        u = state.displacement
        H = self.sampling.derivatives(u)
        F = self.points.gradient(H, state.lateral)
        force = self.sampling.nodal(self.points.body_flux(state.stress, F, H, state.eigenstrain), u)
        viscous = None if state.viscous is None else self.sampling.nodal(self.points.flux(state.viscous, F, H), u)
        return float(self.sampling.volume @ state.stored), force, viscous
