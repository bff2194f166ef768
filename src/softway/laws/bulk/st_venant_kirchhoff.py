"""St. Venant-Kirchhoff material: a linear law in Green's strain."""

from dataclasses import dataclass
from typing import ClassVar

from softway.arrays import Array
from softway.laws.elasticity import hooke
from softway.laws.elasticity.elastic_constants import checked, dilatational_speed
from softway.laws.strain_measures import Green
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class StVenantKirchhoff:
    """St. Venant-Kirchhoff law ``W = lambda/2 (tr E)^2 + mu E:E`` with Green's strain E.

    For small strains and arbitrary rotations.  It softens without limit in strong compression (below a stretch of
    0.58 in a bar, and of 0.71 in a volume with ``nu`` = 0.3); use :class:`~softway.laws.bulk.NeoHookean` there.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive.
    nu
        Poisson's ratio, between -1 and 1/2.

    Examples
    --------
    >>> import numpy as np
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
        return hooke.energy(E, self.E, self.nu)

    def stress(self, E: Array) -> Array:
        """Second Piola-Kirchhoff stress ``lambda tr(E) I + 2 mu E``, (..., 3, 3) [Pa]."""
        return hooke.stress(E, self.E, self.nu)

    def tangent(self, E: Array) -> Array:
        """Constant moduli, (..., 3, 3, 3, 3) [Pa]."""
        return hooke.moduli(E.shape, self.E, self.nu)

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves in the undeformed volume [m/s]."""
        return dilatational_speed(self.E, self.nu, density)

    def youngs(self) -> float:
        """Young's modulus [Pa]."""
        return self.E
