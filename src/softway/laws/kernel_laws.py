"""Laws with a compiled form for the fused kernels; all other laws are evaluated with NumPy."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.kernels.fused.plastic import MODULI, NUMBERS, hypoelastic, j2_linear, j2_voce
from softway.kernels.fused.slab_kinematics import midpoint
from softway.kernels.fused.stored_energies import hooke, neo_hookean
from softway.kernels.fused.strain_stages import green, small
from softway.kernels.jit.compilation import Stage
from softway.laws.bulk import J2, Hypoelastic, LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.elasticity.elastic_constants import lame
from softway.laws.law import RateLaw, StoredEnergy
from softway.laws.objective_rates import Jaumann
from softway.laws.plasticity.hardening import LinearHardening, Voce
from softway.laws.plasticity.rate_dependence import RateIndependent

_STAGES: dict[type, tuple[Callable[[], Stage], Callable[[], Stage]]] = {
    NeoHookean: (green, neo_hookean),
    StVenantKirchhoff: (green, hooke),
    LinearElastic: (small, hooke),
}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CompiledLaw:
    """Compiled form of a law.

    Parameters
    ----------
    measure
        Stage that computes the strain from the displacement derivatives.
    law
        Stage that computes stress, moduli and energy from the strain.
    moduli
        Constants of the law [Pa].
    """

    measure: Stage
    law: Stage
    moduli: Array


def compiled(material: StoredEnergy) -> CompiledLaw | None:
    """Compiled form of a law, or None if it has none.

    Subclasses of the laws of softway have none, since they may override their methods.

    Examples
    --------
    >>> compiled(NeoHookean(E=2.5, nu=0.25)).moduli
    array([1., 1.])
    """
    match material:
        case NeoHookean() | StVenantKirchhoff() | LinearElastic() if type(material) in _STAGES:
            measure, law = _STAGES[type(material)]
            return CompiledLaw(measure=measure(), law=law(), moduli=np.array(lame(material.E, material.nu)))
    return None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CompiledRateLaw:
    """Compiled form of a law with a history.

    Parameters
    ----------
    motion
        Stage that computes the strain and the rotation of a slab (time step).
    law
        Stage that computes stress, history variables, energies and moduli from the strain.
    constants
        Constants of the law, see :mod:`softway.kernels.fused.plastic`.
    """

    motion: Stage
    law: Stage
    constants: Array

    def numbers(self, moduli: bool) -> Array:
        """Constants of the law for its stage, with the flag for the moduli."""
        out = self.constants.copy()
        out[MODULI] = moduli
        return out


def compiled_rate(material: RateLaw) -> CompiledRateLaw | None:
    """Compiled form of a law with a history, or None if it has none.

    Examples
    --------
    >>> compiled_rate(Hypoelastic(E=2.5, nu=0.25)).constants[:2].round(12).tolist()
    [1.666666666667, 1.0]
    """
    found = _rate_law(material) if material.rate == Jaumann() else None
    if found is None:
        return None
    law, E, nu, numbers = found
    bulk_part, shear = lame(E, nu)
    constants = np.zeros(NUMBERS)
    constants[: 2 + len(numbers)] = bulk_part + 2.0 / 3.0 * shear, shear, *numbers
    return CompiledRateLaw(motion=midpoint(), law=law(), constants=constants)


def _rate_law(material: RateLaw) -> tuple[Callable[[], Stage], float, float, tuple[float, ...]] | None:
    """Stage and constants of a law; None for subclasses, which may override methods."""
    match material:
        case Hypoelastic() if type(material) is Hypoelastic:
            return hypoelastic, material.E, material.nu, ()
        case J2(softening=None) if type(material) is J2 and type(material.flow) is RateIndependent:
            hard, start = material.hardening, (material.yield_stress, material.kinematic)
            if type(hard) is LinearHardening:
                return j2_linear, material.E, material.nu, (*start, hard.modulus)
            if type(hard) is Voce:
                return j2_voce, material.E, material.nu, (*start, hard.modulus, hard.saturation, hard.exponent)
    return None


def resting() -> Stage:
    """Stage that keeps the stress of a material at rest."""
    return hypoelastic()
