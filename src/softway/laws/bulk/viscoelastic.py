"""Viscoelastic materials in corotational axes: Kelvin-Voigt model and generalised Maxwell model."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.elasticity.elastic_constants import checked, lame
from softway.laws.law import Increment, Response
from softway.laws.objective_rates import Jaumann, Rate
from softway.laws.plasticity.deviator import deviator, projector
from softway.units import Pascal, PascalSecond, Pure, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Kelvin:
    """Spring and dashpot in parallel (Kelvin-Voigt): ``s = lambda tr(e) I + 2 mu e + 2 eta D' + zeta tr(D) I``.

    The elastic part is hypoelastic.  Moduli that depend on the temperature leave the viscosities as they are.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive.
    nu
        Poisson's ratio, between -1 and 1/2.
    shear_viscosity
        Shear viscosity eta [Pa s], not negative.
    bulk_viscosity
        Bulk viscosity zeta [Pa s], not negative.
    rate
        Objective rate of the elastic stress.

    Examples
    --------
    >>> law = Kelvin(E=1.0, nu=0.0, shear_viscosity=0.5)
    >>> given = Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=0.1 * np.ones((1, 3, 3)), span=0.1)
    >>> float(law.respond(given).stress[0, 0, 1].round(12))  # 2 mu e + 2 eta e/h
    1.1
    """

    E: Pascal
    nu: Pure = 0.0
    shear_viscosity: PascalSecond
    bulk_viscosity: PascalSecond = 0.0
    rate: Rate = Jaumann()

    def __post_init__(self) -> None:
        checked(self.E, self.nu)
        for name in ("shear_viscosity", "bulk_viscosity"):
            if not getattr(self, name) >= 0.0:
                raise InputError(name, f"{getattr(self, name):g} Pa s is negative", "zero or more")

    def virgin(self, points: int) -> Mapping[str, Array]:
        """History variable: elastic part of the stress."""
        return {"elastic_stress": np.zeros((points, 3, 3))}

    def respond(self, increment: Increment) -> Response:
        """Elastic and viscous stress."""
        e, before = increment.strain, increment.memory["elastic_stress"]
        elastic = before + np.einsum("ijkl,...kl", self.elastic_moduli(), e)
        viscous = np.einsum("ijkl,...kl", self._viscosity(), e) / increment.span
        return Response(
            stress=elastic + viscous,
            memory={"elastic_stress": elastic},
            stored=tensors.double_dot(0.5 * (before + elastic), e),
            dissipated=tensors.double_dot(viscous, e),
            viscous=viscous,
        )

    def _viscosity(self) -> Array:
        """Viscosities (3, 3, 3, 3) [Pa s]."""
        return tensors.isotropic(self.bulk_viscosity, 0.0) + 2.0 * self.shear_viscosity * projector()

    def moduli(self, increment: Increment) -> Array:
        """Moduli of spring and dashpot, (..., 3, 3, 3, 3) [Pa]."""
        return self.viscous_moduli(increment) + self.elastic_moduli()

    def viscous_moduli(self, increment: Increment) -> Array:
        """Moduli of the dashpot, (..., 3, 3, 3, 3) [Pa], divided by the factor of those of the spring."""
        found = np.broadcast_to(self._viscosity() / increment.span, (*increment.strain.shape, 3, 3))
        return found if increment.stiffness is None else found / increment.stiffness[..., None, None, None, None]

    def dissipation_factor(self, before: Array, after: Array) -> Array:
        """One: the dashpot has no factor."""
        return np.ones_like(after)

    def elastic_moduli(self) -> Array:
        """Isotropic moduli, (3, 3, 3, 3) [Pa]."""
        return tensors.isotropic(*lame(self.E, self.nu))


@dataclass(frozen=True, slots=True, kw_only=True)
class Maxwell:
    """Spring and Maxwell branches in parallel (Prony series): the shear stress relaxes, the pressure does not.

    The relaxation modulus is ``mu (1 - sum g) + mu sum g_k exp(-t/t_k)`` with the instantaneous shear modulus mu.

    Parameters
    ----------
    E
        Instantaneous Young's modulus [Pa], positive.
    nu
        Instantaneous Poisson's ratio, between -1 and 1/2.
    shares
        Fractions g_k of the shear modulus, positive, with a sum of at most 1; one branch with the fraction 1 is a
        Maxwell fluid.
    times
        Relaxation times t_k [s], positive.
    rate
        Objective rate of the stress.

    References
    ----------
    Taylor, Pister, Goudreau (1970), Thermomechanical analysis of viscoelastic solids, Int. J. Numer. Methods Eng. 2,
    45-59: exact for a constant rate of strain in the slab.

    Examples
    --------
    >>> law = Maxwell(E=2.0, nu=0.0, shares=(1.0,), times=(1.0,))
    >>> given = Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=1e-9 * np.eye(3)[None], span=1e-9)
    >>> law.respond(given).stress[0, 0, 0] > 0.0
    np.True_
    """

    E: Pascal
    nu: Pure = 0.0
    shares: tuple[Pure, ...]
    times: tuple[Second, ...]
    rate: Rate = Jaumann()

    def __post_init__(self) -> None:
        checked(self.E, self.nu)
        if len(self.shares) != len(self.times) or not self.shares:
            raise InputError("times", f"{len(self.times)} times for {len(self.shares)} shares", "a time for each share")
        if min(self.shares) <= 0.0 or sum(self.shares) > 1.0 + 1e-12:
            raise InputError("shares", f"{list(self.shares)}", "positive numbers whose sum is at most 1")
        if min(self.times) <= 0.0:
            raise InputError("times", f"{min(self.times):g} s is not positive", "positive relaxation times")

    def virgin(self, points: int) -> Mapping[str, Array]:
        """History variables: stress of each branch."""
        return {f"branch_{k}": np.zeros((points, 3, 3)) for k in range(len(self.shares))}

    def respond(self, increment: Increment) -> Response:
        """Stress, and energies: each branch dissipates the work of its dashpot."""
        shear = lame(self.E, self.nu)[1]
        e, flow = increment.strain, deviator(increment.strain)
        spring = increment.stress - sum(increment.memory.values())
        stiff = np.einsum("ijkl,...kl", self._spring(), e)
        stress = spring + stiff
        stored = tensors.double_dot(spring + 0.5 * stiff, e)
        dissipated = np.zeros_like(stored)
        memory = {}
        for k, (share, time) in enumerate(zip(self.shares, self.times, strict=True)):
            x, modulus = increment.span / time, 2.0 * shear * share
            before = increment.memory[f"branch_{k}"]
            steady = modulus * flow / x  # limit of the stress at this strain rate
            after = before * np.exp(-x) - steady * np.expm1(-x)
            memory[f"branch_{k}"] = after
            stress = stress + after
            stored = stored + (tensors.double_dot(after, after) - tensors.double_dot(before, before)) / (2.0 * modulus)
            dissipated = dissipated + self._lost(before - steady, steady, x) / modulus
        return Response(stress=stress, memory=memory, stored=stored, dissipated=dissipated)

    @staticmethod
    def _lost(excess: Array, steady: Array, x: float) -> Array:
        """``int_0^x s:s dt`` of ``s = steady + excess exp(-t)``, never negative, (...,)."""
        one, two = -np.expm1(-x), -0.5 * np.expm1(-2.0 * x)
        ss, se, ee = (tensors.double_dot(a, b) for a, b in ((steady, steady), (steady, excess), (excess, excess)))
        return np.maximum(x * ss + 2.0 * one * se + two * ee, 0.0)

    def _spring(self) -> Array:
        """Moduli (3, 3, 3, 3) of the parallel spring [Pa]."""
        bulk_part, shear = lame(self.E, self.nu)
        left = 2.0 * shear * (1.0 - sum(self.shares))
        return tensors.isotropic(bulk_part + 2.0 / 3.0 * shear, 0.0) + left * projector()

    def moduli(self, increment: Increment) -> Array:
        """Moduli (..., 3, 3, 3, 3) [Pa]."""
        shear = lame(self.E, self.nu)[1]
        C = self._spring()
        for share, time in zip(self.shares, self.times, strict=True):
            x = increment.span / time
            C = C - 2.0 * shear * share * np.expm1(-x) / x * projector()
        return np.broadcast_to(C, (*increment.strain.shape, 3, 3))

    def dissipation_factor(self, before: Array, after: Array) -> Array:
        """The mean factor, with relaxation times that do not depend on the temperature."""
        return 0.5 * (before + after)

    def elastic_moduli(self) -> Array:
        """Instantaneous moduli, (3, 3, 3, 3) [Pa]."""
        return tensors.isotropic(*lame(self.E, self.nu))
