"""Compressible neo-Hookean material."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.elasticity import volume_change
from softway.laws.elasticity.elastic_constants import checked, dilatational_speed, lame
from softway.laws.strain_measures import Green
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class NeoHookean:
    """Neo-Hookean law ``W = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2``.

    With Green's strain E and its invariants, ``I1 - 3 = 2 tr E`` and ``J^2 - 1 = j = 2 tr E + 4 I2(E) + 8 det E``.
    Therefore ``W = mu/2 (j - ln(1 + j) - 4 I2 - 8 det E) + lambda/8 ln(1 + j)^2``, which has no cancellation at small
    strain.  The stress is ``S = 2 mu C^-1 E + lambda ln J C^-1``.

    Parameters
    ----------
    E
        Young's modulus of small strains [Pa], positive.
    nu
        Poisson's ratio of small strains, between -1 and 1/2.

    References
    ----------
    Simo, Pister (1984), Remarks on rate constitutive equations for finite deformation problems, Comput. Methods Appl.
    Mech. Engrg. 46, 201-215; Bonet, Wood (2008), Nonlinear continuum mechanics for finite element analysis, 6.4.3.

    Examples
    --------
    >>> law = NeoHookean(E=1.0, nu=0.3)
    >>> float(law.energy(np.zeros((3, 3)))), float(law.energy(np.diag([-0.5, 0.0, 0.0])))
    (0.0, inf)
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
        higher, j = volume_change.jacobian(E)
        with np.errstate(divide="ignore", invalid="ignore"):
            W = 0.5 * shear * (volume_change.excess(j) - higher) + 0.125 * bulk_part * np.log1p(j) ** 2
        return np.where(j > -1.0, W, np.inf)

    def stress(self, E: Array) -> Array:
        """Second Piola-Kirchhoff stress, (..., 3, 3) [Pa]."""
        bulk_part, shear = lame(self.E, self.nu)
        inverse, logarithm = volume_change.inverse(E)
        return tensors.symmetric(2.0 * shear * (inverse @ E)) + (bulk_part * logarithm)[..., None, None] * inverse

    def tangent(self, E: Array) -> Array:
        """Moduli ``lambda C^-1 x C^-1 + 2 (mu - lambda ln J) dC^-1``, (..., 3, 3, 3, 3) [Pa]."""
        bulk_part, shear = lame(self.E, self.nu)
        inverse, logarithm = volume_change.inverse(E)
        squared = tensors.square_symmetric(inverse)
        squared *= 2.0 * (shear - bulk_part * logarithm)[..., None, None, None, None]
        squared += (bulk_part * inverse)[..., :, :, None, None] * inverse[..., None, None, :, :]
        return squared

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves in the undeformed volume [m/s]."""
        return dilatational_speed(self.E, self.nu, density)

    def youngs(self) -> float:
        """Young's modulus of small strains [Pa]."""
        return self.E
