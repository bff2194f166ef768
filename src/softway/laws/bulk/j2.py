"""J2 plasticity: elastic-plastic and elastic-viscoplastic metals at any strain."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.elasticity.elastic_constants import checked, lame
from softway.laws.law import Increment, Response
from softway.laws.objective_rates import Jaumann, Rate
from softway.laws.plasticity.deviator import deviator, equivalent_stress, projector, volumetric
from softway.laws.plasticity.hardening import Hardening, LinearHardening
from softway.laws.plasticity.rate_dependence import Flow, RateIndependent
from softway.laws.plasticity.return_mapping import returned
from softway.laws.plasticity.softening import Softening, factor, greatest_factor
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class J2:
    """Von Mises plasticity with isotropic and kinematic hardening and rate dependence, by radial return.

    In corotational axes the strain increment of a slab (time step) is the sum of an elastic and a plastic part.  The
    plastic part has the direction of the deviator of ``s - b`` at the end of the slab (backward Euler), with the back
    stress b.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive; at the factor one where moduli depend on the temperature, as ``kinematic``.
    nu
        Poisson's ratio, between -1 and 1/2.
    yield_stress
        Initial yield stress in tension [Pa].
    hardening
        Hardening: yield stress as a function of the plastic strain.
    kinematic
        Modulus of linear kinematic hardening (Prager) in tension [Pa], not negative: ``b' = 2/3 H d_plastic``.
    flow
        Rate dependence of the flow stress.
    rate
        Objective rate of the stress.
    softening
        Factor of the flow stress by the temperature of the solid, which needs ``thermal``; none by default.

    References
    ----------
    Simo, Hughes (1998), Computational inelasticity, 3.3; Krieg, Key (1976), Implementation of a time independent
    plasticity theory into structural computer programs, ASME AMD 20.

    Examples
    --------
    >>> law = J2(E=1.0, nu=0.0, yield_stress=0.1)
    >>> given = Increment(stress=np.zeros((3, 3)), memory=law.virgin(1), strain=np.diag([1.0, -0.5, -0.5]), span=1.0)
    >>> float(equivalent_stress(deviator(law.respond(given).stress))[0].round(12))
    0.1
    """

    E: Pascal
    nu: Pure
    yield_stress: Pascal
    hardening: Hardening = LinearHardening()
    kinematic: Pascal = 0.0
    flow: Flow = RateIndependent()
    rate: Rate = Jaumann()
    softening: Softening | None = None

    def __post_init__(self) -> None:
        checked(self.E, self.nu)
        if not self.yield_stress >= 0.0:
            raise InputError("yield_stress", f"{self.yield_stress:g} Pa is negative", "zero or more")
        if self.yield_stress == 0.0 and isinstance(self.flow, RateIndependent):
            raise InputError("yield_stress", "0 Pa without rate dependence gives no strength", "a positive stress")
        if not self.kinematic >= 0.0:
            raise InputError("kinematic", f"{self.kinematic:g} Pa is negative", "zero or more")
        least = -3.0 * lame(self.E, self.nu)[1]
        fall = self.hardening.least_slope()
        fall = fall * greatest_factor(self.softening) if fall < 0.0 else fall
        if fall + self.kinematic <= least:
            problem = f"slope {fall:g} Pa softens faster than -3 mu = {least:g} Pa"
            raise InputError("hardening", f"{problem}: the stress would snap back", "a slope above -3 mu")

    def virgin(self, points: int) -> Mapping[str, Array]:
        """Equivalent plastic strain (points,) and back stress (points, 3, 3) [Pa]."""
        none = {"plastic_strain": np.zeros(points)}
        return none | {"back_stress": np.zeros((points, 3, 3))} if self.kinematic > 0.0 else none

    def respond(self, increment: Increment) -> Response:
        """Stress by radial return; elastic strain and back stress store energy."""
        bulk_part, shear = lame(self.E, self.nu)
        e, p = increment.strain, increment.memory["plastic_strain"]
        back = increment.memory.get("back_stress")
        trial = self._trial(increment)
        relative = trial if back is None else trial - back
        norm = equivalent_stress(relative)
        gain = self._gain(norm, increment)[0]
        n = 1.5 * relative / np.where(norm > 0.0, norm, 1.0)[..., None, None]
        plastic = gain[..., None, None] * n
        pressure = tensors.trace(increment.stress) / 3.0 + (bulk_part + 2.0 / 3.0 * shear) * tensors.trace(e)
        stress = trial - 2.0 * shear * plastic + pressure[..., None, None] * tensors.IDENTITY
        dissipated = tensors.double_dot(stress, plastic)
        stored = tensors.double_dot(0.5 * (increment.stress + stress), e - plastic)
        memory = {"plastic_strain": p + gain}
        if back is not None:
            moved = back + 2.0 / 3.0 * self.kinematic * plastic
            memory["back_stress"] = moved
            kept = tensors.double_dot(0.5 * (back + moved), plastic)
            stored, dissipated = stored + kept, dissipated - kept
        return Response(stress=stress, memory=memory, stored=stored, dissipated=dissipated)

    def _trial(self, increment: Increment) -> Array:
        shear = lame(self.E, self.nu)[1]
        return deviator(increment.stress) + 2.0 * shear * deviator(increment.strain)

    def _gain(self, norm: Array, increment: Increment) -> tuple[Array, Array]:
        """Increment (...,) of the equivalent plastic strain for the trial stress ``norm`` (...,) [Pa]; its slope."""
        slope, p = 3.0 * lame(self.E, self.nu)[1] + self.kinematic, increment.memory["plastic_strain"]
        soft = factor(self.softening, increment.temperature)
        if increment.stiffness is not None:
            soft = (1.0 if soft is None else soft) / increment.stiffness
        return returned(norm, slope, p, increment.span, self.yield_stress, self.hardening, self.flow, soft)

    def moduli(self, increment: Increment) -> Array:
        """Consistent moduli (..., 3, 3, 3, 3) [Pa]."""
        bulk_part, shear = lame(self.E, self.nu)
        back = increment.memory.get("back_stress")
        relative = self._trial(increment) if back is None else self._trial(increment) - back
        norm = equivalent_stress(relative)
        gain, rise = self._gain(norm, increment)
        flowing = gain > 0.0
        safe = np.where(norm > 0.0, norm, 1.0)
        n = relative / safe[..., None, None]  # n : n = 2/3
        ratio = gain / safe
        soft = np.where(flowing, 2.0 * shear * (1.0 - 3.0 * shear * ratio), 2.0 * shear)
        along = np.where(flowing, 9.0 * shear**2 * (rise - ratio), 0.0)  # rise = d gain / d norm
        out = soft[..., None, None, None, None] * projector() + (bulk_part + 2.0 / 3.0 * shear) * volumetric()
        return out - along[..., None, None, None, None] * n[..., :, :, None, None] * n[..., None, None, :, :]

    def dissipation_factor(self, before: Array, after: Array) -> Array:
        """The factor at the end, that of the flow stress."""
        return after

    def elastic_moduli(self) -> Array:
        """Isotropic moduli, (3, 3, 3, 3) [Pa]."""
        return tensors.isotropic(*lame(self.E, self.nu))
