"""Isotropic linear elasticity (Hooke)."""

from dataclasses import dataclass
from typing import ClassVar

from softway.arrays import Array
from softway.laws.elasticity import hooke
from softway.laws.elasticity.elastic_constants import checked, dilatational_speed
from softway.laws.strain_measures import Small
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearElastic:
    """Hooke's law, ``W = lambda/2 (tr e)^2 + mu e:e`` with the linearised strain e.

    For small strains and small rotations; the force on a body is linear in its displacement.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive.
    nu
        Poisson's ratio, between -1 and 1/2.

    Examples
    --------
    >>> import numpy as np
    >>> round(float(LinearElastic(E=2.0).stress(np.diag([0.1, 0.0, 0.0]))[0, 0]), 12)
    0.2
    """

    E: Pascal
    nu: Pure = 0.0
    measure: ClassVar[Small] = Small()
    linear: ClassVar[bool] = True

    def __post_init__(self) -> None:
        checked(self.E, self.nu)

    def energy(self, E: Array) -> Array:
        """Energy per volume (...,) [J/m^3] of the strain E (..., 3, 3)."""
        return hooke.energy(E, self.E, self.nu)

    def stress(self, E: Array) -> Array:
        """Stress ``lambda tr(e) I + 2 mu e``, (..., 3, 3) [Pa]."""
        return hooke.stress(E, self.E, self.nu)

    def tangent(self, E: Array) -> Array:
        """Constant moduli, (..., 3, 3, 3, 3) [Pa]."""
        return hooke.moduli(E.shape, self.E, self.nu)

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves [m/s]."""
        return dilatational_speed(self.E, self.nu, density)

    def youngs(self) -> float:
        """Young's modulus [Pa]."""
        return self.E
