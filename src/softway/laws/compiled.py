"""The laws that also exist as stages of the fused kernels; the others are computed by NumPy alone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.kernels.compiled import Stage
from softway.kernels.hooke import hooke
from softway.kernels.neo_hookean import neo_hookean
from softway.kernels.strain import green, small
from softway.laws.bulk import LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.law import StoredEnergy
from softway.laws.moduli import lame
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
