"""Hypoelastic material: the stress rate is linear in the rate of deformation."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.elasticity.elastic_constants import checked, lame
from softway.laws.law import Increment, Response
from softway.laws.objective_rates import Jaumann, Rate
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Hypoelastic:
    """Hypoelastic law: ``rate of the Cauchy stress = lambda tr(D) I + 2 mu D``.

    The law has no elastic potential: a closed cycle of large strain absorbs or releases energy, and leaves residual
    stress.  With the rate ``Logarithmic`` it does not, as the stress is a function of the stretch
    (docs/theory/bodies/rates.md).  The work of the stress is recorded as stored energy.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive.
    nu
        Poisson's ratio, between -1 and 1/2.
    rate
        Objective rate of the stress.

    References
    ----------
    Truesdell, Noll (1965), The non-linear field theories of mechanics, 99-103.

    Examples
    --------
    >>> law = Hypoelastic(E=2.5, nu=0.25)
    >>> stretch = np.diag([0.1, 0.0, 0.0])
    >>> given = Increment(stress=np.zeros((3, 3)), memory={}, strain=stretch, span=1.0)
    >>> law.respond(given).stress.diagonal().round(12).tolist()
    [0.3, 0.1, 0.1]
    """

    E: Pascal
    nu: Pure = 0.0
    rate: Rate = Jaumann()

    def __post_init__(self) -> None:
        checked(self.E, self.nu)

    def virgin(self, points: int) -> Mapping[str, Array]:
        """History variables: none besides the stress."""
        return {}

    def respond(self, increment: Increment) -> Response:
        """Stress (..., 3, 3) [Pa]; the stored energy is the work of the mean stress."""
        bulk_part, shear = lame(self.E, self.nu)
        e = increment.strain
        stress = increment.stress + 2.0 * shear * e + bulk_part * tensors.trace(e)[..., None, None] * tensors.IDENTITY
        stored = tensors.double_dot(0.5 * (increment.stress + stress), e)
        return Response(stress=stress, memory={}, stored=stored, dissipated=np.zeros_like(stored))

    def moduli(self, increment: Increment) -> Array:
        """Isotropic moduli, (..., 3, 3, 3, 3) [Pa]."""
        return np.broadcast_to(self.elastic_moduli(), (*increment.strain.shape, 3, 3))

    def dissipation_factor(self, before: Array, after: Array) -> Array:
        """The factor at the end: nothing is dissipated."""
        return after

    def elastic_moduli(self) -> Array:
        """Isotropic moduli, (3, 3, 3, 3) [Pa]."""
        return tensors.isotropic(*lame(self.E, self.nu))
