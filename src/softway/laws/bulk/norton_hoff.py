"""Norton-Hoff material: rigid-viscoplastic flow, for hot forming."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.law import Increment, Response
from softway.laws.objective_rates import Jaumann, Rate
from softway.laws.plasticity.deviator import deviator, projector, volumetric
from softway.laws.plasticity.softening import Softening, factor
from softway.units import Pascal, PerSecond, Pure

BULK = 1e5
"""Default bulk modulus, relative to the flow stress at a rate of 1/s."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NortonHoff:
    """Norton-Hoff law ``s = 2 K (sqrt(3) d)^(m-1) D'`` with ``d = sqrt(2/3 D':D')``; the pressure is ``-bulk ln J``.

    D is the mean rate of deformation in a slab (time step).  The deviatoric stress s is a function of this rate alone.
    The bulk modulus makes the material nearly incompressible, with the volume change ``pressure/bulk``: use
    ``dilatation = "mean"`` in the cells.

    Parameters
    ----------
    K
        Consistency [Pa s^m], positive.
    m
        Rate sensitivity, above 0 and at most 1.  The value 1 is a Newtonian fluid with the viscosity K; towards 0 the
        law tends to plasticity with the yield stress sqrt(3) K.
    bulk
        Bulk modulus [Pa]; by default 1e5 times K.
    still
        Strain rate [1/s] below which the viscosity no longer grows; nearly rigid regions creep.
    rate
        Objective rate of the stress; only the pressure depends on it.
    softening
        Factor of the consistency by the temperature of the solid, which needs ``thermal``; none by default.

    References
    ----------
    Norton (1929), The creep of steel at high temperatures; Hoff (1954), Approximate analysis of structures in the
    presence of moderately large creep deformations, Q. Appl. Math. 12, 49-55; the paper, eq. (3.6), for friction.

    Examples
    --------
    >>> law = NortonHoff(K=1.0, m=0.5)
    >>> shear = np.array([[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]])  # rate of shear 4
    >>> given = Increment(stress=np.zeros((3, 3)), memory={}, strain=shear, span=1.0)
    >>> float(law.respond(given).stress[0, 1].round(9))  # K rate^m
    2.0
    """

    K: Pure
    m: Pure
    bulk: Pascal | None = None
    still: PerSecond = 1e-9
    rate: Rate = Jaumann()
    softening: Softening | None = None

    def __post_init__(self) -> None:
        if not self.K > 0.0:
            raise InputError("K", f"{self.K:g} is not positive", "a positive consistency [Pa s^m]")
        if not 0.0 < self.m <= 1.0:
            raise InputError("m", f"{self.m:g} is not in (0, 1]", "a rate sensitivity such as 0.2; J2 for m = 0")
        if self.bulk is not None and not self.bulk > 0.0:
            raise InputError("bulk", f"{self.bulk:g} Pa is not positive", "about 1e5 times K")
        if not self.still > 0.0:
            raise InputError("still", f"{self.still:g} 1/s is not positive", "a rate far below the rates of interest")

    def virgin(self, points: int) -> Mapping[str, Array]:
        """History variables: none besides the stress."""
        return {}

    def respond(self, increment: Increment) -> Response:
        """Deviatoric stress from the mean rate, and pressure from the change of volume."""
        e = increment.strain
        s = (2.0 * self.viscosity(increment) / increment.span)[..., None, None] * deviator(e)
        before = tensors.trace(increment.stress) / 3.0
        pressure = before + self._bulk() * tensors.trace(e)
        return Response(
            stress=s + pressure[..., None, None] * tensors.IDENTITY,
            memory={},
            stored=0.5 * (before + pressure) * tensors.trace(e),
            dissipated=tensors.double_dot(s, e),
            viscous=s,
        )

    def viscosity(self, increment: Increment) -> Array:
        """Viscosity ``K (sqrt(3) d)^(m-1)``, (...,) [Pa s], times the factor of the softening."""
        found = np.asarray(self.K * (np.sqrt(3.0) * self._speed(increment)) ** (self.m - 1.0))
        soft = factor(self.softening, increment.temperature)
        return found if soft is None else soft * found

    def _speed(self, increment: Increment) -> Array:
        e = deviator(increment.strain)
        return np.asarray(np.sqrt(2.0 / 3.0 * tensors.double_dot(e, e) / increment.span**2 + self.still**2))

    def _bulk(self) -> float:
        return BULK * self.K if self.bulk is None else self.bulk

    def moduli(self, increment: Increment) -> Array:
        """Moduli ``2 viscosity/span (I' + (m - 1) 2/3 D' x D'/d^2) + bulk I x I``, (..., 3, 3, 3, 3) [Pa]."""
        return self.viscous_moduli(increment) + self._bulk() * volumetric()

    def viscous_moduli(self, increment: Increment) -> Array:
        """Moduli of the deviatoric stress, (..., 3, 3, 3, 3) [Pa]."""
        n = deviator(increment.strain) / (increment.span * self._speed(increment))[..., None, None]
        shape = projector() + 2.0 / 3.0 * (self.m - 1.0) * n[..., :, :, None, None] * n[..., None, None, :, :]
        stiff = 2.0 * self.viscosity(increment) / increment.span
        return np.asarray(stiff[..., None, None, None, None] * shape)

    def secant(self, increment: Increment) -> Array:
        """Moduli with the viscosity held fixed, for the fixed-point iteration, (..., 3, 3, 3, 3) [Pa]."""
        stiff = 2.0 * self.viscosity(increment) / increment.span
        return np.asarray(stiff[..., None, None, None, None] * projector() + self._bulk() * volumetric())

    def elastic_moduli(self) -> Array:
        """Moduli of the volume change, (3, 3, 3, 3) [Pa]."""
        return tensors.isotropic(self._bulk(), 0.0) + 1e-12 * self._bulk() * projector()
