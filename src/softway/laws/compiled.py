"""The laws that also exist as stages of the fused kernels; the others are computed by NumPy alone."""

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
    """Stages of a law, or None where it has none.

    Examples
    --------
    >>> compiled(NeoHookean(E=2.5, nu=0.25)).moduli
    array([1., 1.])
    """
    match material:
        case NeoHookean(E=E, nu=nu):
            return CompiledLaw(measure=green(), law=neo_hookean(), moduli=np.array(lame(E, nu)))
        case StVenantKirchhoff(E=E, nu=nu):
            return CompiledLaw(measure=green(), law=hooke(), moduli=np.array(lame(E, nu)))
        case LinearElastic(E=E, nu=nu):
            return CompiledLaw(measure=small(), law=hooke(), moduli=np.array(lame(E, nu)))
    return None
