"""Material points of a path-dependent body: stresses, fluxes and moduli from the deformation of a slab."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.internal_force.inelastic.eigenstrain import FreeStrainModuli, Relief, dilation, unstressed
from softway.bodies.internal_force.inelastic.slab_kinematics import SlabDeformation, push_forward, slab_deformation
from softway.bodies.internal_force.material_state import MaterialState
from softway.kernels.linalg import tensors
from softway.laws.law import Damped, Increment, RateLaw, Response, Scalable, Viscous
from softway.laws.objective_rates import Rate, Truesdell

TOLERANCE = 1e-12
"""Last correction of the lateral strain at which the faces are taken as free of stress."""
LIMIT = 40
"""Greatest number of corrections of the lateral strain."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointResponse:
    """Response of the points to a slab; leading axis p.

    Parameters
    ----------
    response
        Response of the law, in the axes of the middle of the slab; ``deformation.second`` maps them to the end.
    deformation
        Deformation of the slab.
    F
        (p, 3, 3) deformation gradient at the end.
    ratio
        (p,) volume ratio in the middle, the factor of the energies of the law.
    increment
        Argument of the law.
    lateral
        (p, k) stretches of the free axes at the end.
    eigenstrain
        (p,) free strain that the law knows at the end; None if it knows none.
    """

    response: Response
    deformation: SlabDeformation
    F: Array
    ratio: Array
    increment: Increment
    lateral: Array
    eigenstrain: Array | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RatePoints:
    """Points p of a path-dependent material in elements of m dimensions in a space of D dimensions.

    Arguments ``H`` are displacement derivatives (p, m, D), see :mod:`softway.laws.strain_measures`.

    Parameters
    ----------
    law
        Material law.
    free
        Axes outside the element whose normal stress is zero.
    directions
        (p, m, D) or (1, m, D) orthonormal reference directions.
    moduli_of_free_strain
        Moduli of the law for a free strain; None without free axes.
    """

    law: RateLaw
    free: tuple[int, ...]
    directions: Array
    moduli_of_free_strain: FreeStrainModuli | None = None

    def gradient(self, H: Array, lateral: Array) -> Array:
        """Deformation gradient (p, 3, 3) with the stretches (p, k) of the free axes; for a bar in its own axes."""
        f = self.directions + H
        m, size = f.shape[-2:]
        F = np.zeros((len(H), 3, 3))
        F[:, range(3), range(3)] = 1.0
        if m == 1:
            F[:, 0, 0] = np.sqrt(np.einsum("pJi,pJi->p", f, f))
        else:
            F[:, :size, :size] = np.swapaxes(f, 1, 2) @ self.directions  # F_iK = f_Ji g_JK
        for k, axis in enumerate(self.free):
            F[:, axis, axis] = lateral[:, k]
        return F

    def respond(self, H0: Array, H1: Array, state: MaterialState, span: float) -> PointResponse:
        """Response to a slab from H0 to H1; ``nan`` where the material is inverted."""
        F0 = self.gradient(H0, state.lateral)
        lateral = state.lateral
        with np.errstate(all="ignore"):
            relief = self._relief(H0, H1, state)
            found = self._response(F0, self.gradient(H1, lateral), state, span, lateral, relief)
            for _ in range(LIMIT if self.free else 0):
                step = self._lateral_correction(found)
                lateral = np.asarray(lateral * np.exp(np.clip(step, -0.5, 0.5)))
                found = self._response(F0, self.gradient(H1, lateral), state, span, lateral, relief)
                if not np.any(np.abs(step) > TOLERANCE):
                    break
            return found if relief is None else self._relieved(self._released(found), relief, state)

    def _relief(self, H0: Array, H1: Array, state: MaterialState) -> Relief | None:
        before, after, moduli = state.eigenstrain, state.coming_eigenstrain, self.moduli_of_free_strain
        if before is None or after is None or moduli is None:
            return None
        ends = dilation(H0, self.directions)[0], dilation(H1, self.directions)[0]
        return Relief(moduli=moduli, before=before, after=after, dilations=ends, lateral=state.lateral)

    def _relieved(self, found: PointResponse, relief: Relief, state: MaterialState) -> PointResponse:
        """Response with the energies of the strain, of which the law has seen the elastic part."""
        given, response = found.increment, found.response
        mean = 0.5 * (given.stress + response.stress)
        if response.viscous is not None and state.viscous is not None:
            before = push_forward(state.viscous, found.deformation.first, self.law.rate)
            mean = mean + 0.5 * (response.viscous - before)
        factor: Array | float = 1.0
        if state.stiffness is not None and given.stiffness is not None:
            factor = 0.5 * (state.stiffness + given.stiffness)
        ends = found.lateral, found.ratio
        response = relief.accounted(response, found.deformation.strain, mean, ends, factor)
        return replace(found, response=response, eigenstrain=relief.after)

    def _response(
        self, F0: Array, F1: Array, state: MaterialState, span: float, lateral: Array, relief: Relief | None
    ) -> PointResponse:
        rate = self.law.rate
        inverted = ~(tensors.determinant(F1) > 0.0)
        if inverted.any():
            F1 = np.where(inverted[:, None, None], np.nan, F1)
            F1 = np.where(np.isfinite(F1), F1, np.eye(3))
        deformation = slab_deformation(rate, F0, F1)
        if relief is not None:
            deformation = replace(deformation, strain=relief.strain(deformation.strain, lateral))
        increment = Increment(
            stress=push_forward(state.stress, deformation.first, rate),
            memory=_pushed_forward(state.law, deformation.first, rate),
            strain=deformation.strain if relief is None else relief.elastic(deformation.strain),
            span=span,
            temperature=state.middle_temperature(span),
            stiffness=state.coming_stiffness(span),
        )
        response = self._scaled(self.law.respond(increment), state.stiffness, increment.stiffness)
        if inverted.any():
            stress = np.where(inverted[:, None, None], np.nan, response.stress)
            response = replace(response, stress=stress, stored=np.where(inverted, np.nan, response.stored))
        ratio = tensors.determinant(0.5 * (F0 + F1))
        return PointResponse(
            response=response, deformation=deformation, F=F1, ratio=ratio, increment=increment, lateral=lateral
        )

    def _scaled(self, response: Response, before: Array | None, after: Array | None) -> Response:
        """Response that dissipates with factors (p,) of the moduli at both ends."""
        if before is None or after is None or not isinstance(self.law, Scalable):
            return response
        return replace(response, dissipated=self.law.dissipation_factor(before, after) * response.dissipated)

    def _lateral_correction(self, found: PointResponse) -> Array:
        """Changes (p, k) of the logarithmic lateral strains that remove the stress on the free faces."""
        axes = np.array(self.free)
        C = self.law.moduli(found.increment)[:, axes, axes][:, :, axes, axes]
        pull = found.response.stress[:, axes, axes]
        viscous, factor = found.response.viscous, found.increment.stiffness
        if viscous is not None and factor is not None:  # it has no factor, unlike the rest of the stress
            pull = pull + (1.0 / factor[:, None] - 1.0) * viscous[:, axes, axes]
        out = -np.linalg.solve(np.where(np.isfinite(C), C, np.eye(len(axes))), pull[..., None])[..., 0]
        return np.where(np.isfinite(out), out, 0.0)

    def _released(self, found: PointResponse) -> PointResponse:
        """Response without the stress on the free faces that the rounding of the lateral stretches leaves.

        In a plastic flow, which hardly resists, it would move the nodes.
        """
        axes = np.array(self.free)
        more = self.law.moduli(found.increment)[..., axes, axes] @ self._lateral_correction(found)[:, None, :, None]
        return replace(found, response=replace(found.response, stress=found.response.stress + more[..., 0]))

    def stress(self, found: PointResponse) -> Array:
        """Cauchy stress (p, 3, 3) at the end [Pa]."""
        return push_forward(found.response.stress, found.deformation.second, self.law.rate)

    def _geometric(self, found: PointResponse) -> Array:
        viscous = isinstance(self.law, Viscous)
        return np.zeros_like(found.response.stress) if viscous else found.response.stress

    def geometric_stress(self, found: PointResponse) -> Array:
        """Cauchy stress (p, 3, 3) of the geometric stiffness [Pa]: the stress at the end, zero for viscous laws.

        In nearly incompressible viscous flow the pressure of an iterate may be far from equilibrium, and would make the
        tangent indefinite.
        """
        return push_forward(self._geometric(found), found.deformation.second, self.law.rate)

    def viscous_stress(self, found: PointResponse) -> Array | None:
        """Part of :meth:`stress` due to the mean rate of the slab, (p, 3, 3) [Pa]; None without viscosity."""
        viscous = found.response.viscous
        return None if viscous is None else push_forward(viscous, found.deformation.second, self.law.rate)

    def body_flux(self, sigma: Array, F: Array, H: Array, eigenstrain: Array | None) -> Array:
        """Flux (p, m, D) [Pa] of the stress of a law that knows an eigenstrain (p,), and of that eigenstrain."""
        flux = self.flux(sigma, F, H)
        if eigenstrain is None or self.moduli_of_free_strain is None:
            return flux
        return flux + (self.moduli_of_free_strain.held * eigenstrain)[:, None, None] * dilation(H, self.directions)[1]

    def flux(self, sigma: Array, F: Array, H: Array) -> Array:
        """First Piola-Kirchhoff stress along the directions, (p, m, D) [Pa], of a Cauchy stress (p, 3, 3)."""
        J = tensors.determinant(F)
        m, size = H.shape[1:]
        if m == 1:
            f = self.directions + H
            return (J * sigma[:, 0, 0] / F[:, 0, 0] ** 2)[:, None, None] * f
        P = J[:, None, None] * (np.linalg.inv(F) @ sigma)  # P_Ki
        return self.directions @ P[:, :size, :size]

    def committed(self, found: PointResponse, state: MaterialState, u: Array) -> MaterialState:
        """Material state at the end of the slab from ``state`` to the displacement u (n, d)."""
        response = found.response
        return MaterialState(
            displacement=np.array(u),
            stress=self.stress(found),
            law=_pushed_forward(response.memory, found.deformation.second, self.law.rate),
            lateral=found.lateral.copy(),
            stored=state.stored + found.ratio * response.stored,
            dissipated=state.dissipated + found.ratio * response.dissipated,
            viscous=self.viscous_stress(found),
            temperature=state.temperature,
            warming=state.warming,
            stiffness=state.stiffness,
            stiffening=state.stiffening,
            eigenstrain=found.eigenstrain,
            coming_eigenstrain=found.eigenstrain,
            unforeseen=state.unforeseen,
        )

    def moduli(self, found: PointResponse, H: Array, secant: bool = False) -> Array:
        """Derivative of the flux with respect to H at stress-free faces, made symmetric, (p, m, D, m, D) [Pa].

        The stress of the geometric part is :meth:`geometric_stress`.
        """
        sigma, law = self._geometric(found), self.law
        own = law.secant(found.increment) if secant and isinstance(law, Viscous) else law.moduli(found.increment)
        return self._flux_moduli(own, sigma, found, H)

    def _flux_moduli(self, own: Array, sigma: Array, found: PointResponse, H: Array) -> Array:
        C = spatial(own, sigma, self.law.rate)
        J = tensors.determinant(found.F)
        m, size = H.shape[1:]
        if m == 1:
            return self._bar_moduli(C, sigma, found, H, J)
        C = unstressed(C, self.free)
        B = found.deformation.second
        if isinstance(self.law.rate, Truesdell):
            B = tensors.rotation(B)
        to = self.directions @ np.linalg.inv(found.F)[:, :size, :] @ B  # (p, m, 3): F^-1 in the axes of the middle
        turned = B[:, :size, :]  # (p, D, 3): components i in the axes of the middle
        left = np.einsum("pJa,pib,pabcd->pJicd", to, turned, C, optimize=True)
        out = np.einsum("pJicd,pLc,pld->pJiLl", left, to, turned, optimize=True)
        spin = np.einsum("pJa,pab,pLb->pJL", to, sigma, to, optimize=True)
        out += spin[:, :, None, :, None] * np.eye(size)[:, None, :]
        return J[:, None, None, None, None] * out

    def viscous_moduli(self, law: Damped, found: PointResponse, H: Array) -> Array:
        """Part of :meth:`moduli` due to the mean rate of the slab; ``law`` is the law of the points."""
        own, still = self.law.moduli(found.increment), np.zeros_like(found.F)
        more = own + law.viscous_moduli(found.increment)
        return self._flux_moduli(more, still, found, H) - self._flux_moduli(own, still, found, H)

    def _bar_moduli(self, C: Array, sigma: Array, found: PointResponse, H: Array, J: Array) -> Array:
        """Moduli (p, 1, D, 1, D) of a bar: axial stiffness, and geometric stiffness across the axis."""
        C = unstressed(C, self.free)
        length = found.F[:, 0, 0]
        along = (self.directions + H)[:, 0] / length[:, None]
        axis = along[:, :, None] * along[:, None, :]
        stiff = (J * C[:, 0, 0, 0, 0] / length**2)[:, None, None]
        pull = (J * sigma[:, 0, 0] / length**2)[:, None, None]
        return ((stiff + pull) * axis + pull * (np.eye(H.shape[2]) - axis))[:, None, :, None, :]


def spatial(C: Array, sigma: Array, rate: Rate) -> Array:
    """Moduli (..., 3, 3, 3, 3) of the Truesdell rate of the Kirchhoff stress per present volume, made symmetric.

    ``s_T = C:D - D s - s D + tr(D) s`` where C belongs to a corotational rate of the Cauchy stress.
    """
    if isinstance(rate, Truesdell):
        return C
    one = np.eye(3)
    out = C + 0.5 * (
        sigma[..., :, :, None, None] * one[None, None, :, :] + one[:, :, None, None] * sigma[..., None, None, :, :]
    )
    part = one[:, None, :, None] * sigma[..., None, :, None, :] + sigma[..., :, None, :, None] * one[None, :, None, :]
    part = part + np.swapaxes(part, -1, -2)
    return np.asarray(out - 0.5 * part)


def _pushed_forward(history: Mapping[str, Array], A: Array, rate: Rate) -> Mapping[str, Array]:
    """History variables of a law after a map A (p, 3, 3): tensors are pushed forward, scalars stay."""
    return {n: push_forward(a, A, rate) if a.shape[1:] == (3, 3) else a for n, a in history.items()}
