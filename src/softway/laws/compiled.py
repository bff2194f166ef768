"""The laws that also exist as stages of the fused kernels; the others are computed by NumPy alone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.kernels.compiled import Stage
from softway.kernels.hooke import hooke
from softway.kernels.motion import midpoint
from softway.kernels.neo_hookean import neo_hookean
from softway.kernels.plastic import MODULI, NUMBERS, hypoelastic, j2_linear, j2_voce
from softway.kernels.strain import green, small
from softway.laws.bulk import J2, Hypoelastic, LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.flow import RateIndependent
from softway.laws.hardening import LinearHardening, Voce
from softway.laws.law import RateLaw, StoredEnergy
from softway.laws.moduli import lame
from softway.laws.rates import Jaumann
from softway.typing import Array

_STAGES: dict[type, tuple[Callable[[], Stage], Callable[[], Stage]]] = {
    NeoHookean: (green, neo_hookean),
    StVenantKirchhoff: (green, hooke),
    LinearElastic: (small, hooke),
}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CompiledLaw:
    """A law for kernels.

    Parameters
    ----------
    measure
        Stage that makes the strain of displacement derivatives.
    law
        Stage that makes stress, moduli and energy of the strain.
    moduli
        Numbers of the law [Pa].
    """

    measure: Stage
    law: Stage
    moduli: Array


def compiled(material: StoredEnergy) -> CompiledLaw | None:
    """Stages of a law, or None where it has none: a law derived from one of ours may say something else.

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
    """A law with a history for kernels.

    Parameters
    ----------
    motion
        Stage that makes the strain and the turn of a slab.
    law
        Stage that makes stress, memory, energies and moduli of the strain.
    constants
        Numbers of the law, see :mod:`softway.kernels.plastic`.
    """

    motion: Stage
    law: Stage
    constants: Array

    def numbers(self, moduli: bool) -> Array:
        """Numbers of the law for its stage, and whether moduli are asked for."""
        out = self.constants.copy()
        out[MODULI] = moduli
        return out


def compiled_rate(material: RateLaw) -> CompiledRateLaw | None:
    """Stages of a law with a history, or None where it has none.

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
    """Stage and numbers of a law: a law derived from one of ours may say something else."""
    match material:
        case Hypoelastic() if type(material) is Hypoelastic:
            return hypoelastic, material.E, material.nu, ()
        case J2() if type(material) is J2 and type(material.flow) is RateIndependent:
            hard, start = material.hardening, (material.yield_stress, material.kinematic)
            if type(hard) is LinearHardening:
                return j2_linear, material.E, material.nu, (*start, hard.modulus)
            if type(hard) is Voce:
                return j2_voce, material.E, material.nu, (*start, hard.modulus, hard.saturation, hard.exponent)
    return None


def resting() -> Stage:
    """Stage that leaves the stress as it is where nothing moves."""
    return hypoelastic()
