"""St. Venant-Kirchhoff material: a linear law in Green's strain."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.elasticity.elastic_constants import checked, dilatational_speed, lame
from softway.laws.strain_measures import Green
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class StVenantKirchhoff:
    """St. Venant-Kirchhoff law ``W = lambda/2 (tr E)^2 + mu E:E`` with Green's strain E.

    For small strains and arbitrary rotations.  It softens without limit in strong compression (below a stretch of
    ``1/sqrt(3)`` in a bar); use :class:`~softway.laws.bulk.NeoHookean` there.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive.
    nu
        Poisson's ratio, between -1 and 1/2.

    Examples
    --------
    >>> round(float(StVenantKirchhoff(E=2.0).stress(np.diag([0.1, 0.0, 0.0]))[0, 0]), 12)
    0.2
    """

    E: Pascal
    nu: Pure = 0.0
    measure: ClassVar[Green] = Green()
    linear: ClassVar[bool] = False

    def __post_init__(self) -> None:
        checked(self.E, self.nu)

    def energy(self, E: Array) -> Array:
        """Energy per reference volume (...,) [J/m^3] of Green's strain E (..., 3, 3)."""
        bulk_part, shear = lame(self.E, self.nu)
        return 0.5 * bulk_part * tensors.trace(E) ** 2 + shear * tensors.double_dot(E, E)

    def stress(self, E: Array) -> Array:
        """Second Piola-Kirchhoff stress ``lambda tr(E) I + 2 mu E``, (..., 3, 3) [Pa]."""
        bulk_part, shear = lame(self.E, self.nu)
        return (bulk_part * tensors.trace(E))[..., None, None] * tensors.IDENTITY + 2.0 * shear * E

    def tangent(self, E: Array) -> Array:
        """Constant moduli, (..., 3, 3, 3, 3) [Pa]."""
        return np.broadcast_to(tensors.isotropic(*lame(self.E, self.nu)), (*E.shape, 3, 3))

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves in the undeformed volume [m/s]."""
        return dilatational_speed(self.E, self.nu, density)

    def youngs(self) -> float:
        """Young's modulus [Pa]."""
        return self.E
