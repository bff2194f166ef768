"""Hencky's material: Hooke's law in the logarithmic strain."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg.spectral import moduli_in_axes, of_principal, principal
from softway.laws.elasticity.elastic_constants import checked, dilatational_speed, lame
from softway.laws.strain_measures import Green
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Hencky:
    """Hencky's law ``W = mu ln U : ln U + lambda/2 (tr ln U)^2`` with the right stretch ``U^2 = I + 2 E``.

    With the principal values e_a of Green's strain, the logarithmic strains are ``h_a = ln(1 + 2 e_a)/2``, accurate
    also at small strain.  The stress is ``S_a = (2 mu h_a + lambda tr h)/(1 + 2 e_a)`` along the same axes.  The moduli
    between two axes are ``(S_a - S_b)/(e_a - e_b)``, without cancellation where values are repeated.  Uniaxial stress
    gives ``J sigma = E ln(stretch)`` at any stretch.  The law describes metals well up to moderate strains; in strong
    tension (stretch above e) the energy is not convex.

    Parameters
    ----------
    E
        Young's modulus [Pa], positive.
    nu
        Poisson's ratio, between -1 and 1/2.

    References
    ----------
    Hencky (1928), Ueber die Form des Elastizitaetsgesetzes bei ideal elastischen Stoffen, Z. techn. Phys. 9, 215-220;
    Xiao, Chen (2002), Hencky's elasticity model and linear stress-strain relations in isotropic finite hyperelasticity,
    Acta Mech. 157, 51-60.

    Examples
    --------
    >>> law = Hencky(E=2.5, nu=0.25)
    >>> doubled = np.diag([1.5, 0.0, 0.0])  # stretch 2 without lateral strain: S = 3 ln 2/4
    >>> round(float(law.stress(doubled)[0, 0]), 9), float(law.energy(np.diag([-0.5, 0.0, 0.0])))
    (0.519860385, inf)
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
        h = _logarithms(_possible(E)[0])
        W = shear * np.sum(h * h, axis=-1) + 0.5 * bulk_part * np.sum(h, axis=-1) ** 2
        return np.where(np.isnan(W), np.inf, W)

    def stress(self, E: Array) -> Array:
        """Second Piola-Kirchhoff stress, (..., 3, 3) [Pa]."""
        e, axes = _possible(E)
        h = _logarithms(e)
        return of_principal(self._kirchhoff(h) / (1.0 + 2.0 * e), axes)

    def tangent(self, E: Array) -> Array:
        """Moduli dS/dE, (..., 3, 3, 3, 3) [Pa]."""
        bulk_part, shear = lame(self.E, self.nu)
        e, axes = _possible(E)
        h = _logarithms(e)
        tau, inverse = self._kirchhoff(h), 1.0 / (1.0 + 2.0 * e)
        products = inverse[..., :, None] * inverse[..., None, :]
        normal = products * bulk_part
        rows = np.arange(3)
        normal[..., rows, rows] += 2.0 * (shear - tau) * inverse**2
        mean = 1.0 + e[..., :, None] + e[..., None, :]
        slope = _atanh_ratio((e[..., :, None] - e[..., None, :]) / mean) / mean  # (h_a - h_b)/(e_a - e_b)
        sides = shear * slope * (inverse[..., :, None] + inverse[..., None, :])
        sides -= (tau[..., :, None] + tau[..., None, :]) * products
        return moduli_in_axes(normal, sides, axes)

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves in the undeformed volume [m/s]."""
        return dilatational_speed(self.E, self.nu, density)

    def youngs(self) -> float:
        """Young's modulus [Pa]."""
        return self.E

    def _kirchhoff(self, h: Array) -> Array:
        """Principal Kirchhoff stresses (..., 3) of the logarithmic strains."""
        bulk_part, shear = lame(self.E, self.nu)
        return 2.0 * shear * h + bulk_part * np.sum(h, axis=-1, keepdims=True)


def _possible(E: Array) -> tuple[Array, Array]:
    """Principal strains (..., 3), ``nan`` where the stretch is not positive, and their axes (..., 3, 3)."""
    e, axes = principal(E)
    return np.where(e > -0.5, e, np.nan), axes


def _logarithms(e: Array) -> Array:
    """``ln(1 + 2 e)/2`` (..., 3)."""
    return 0.5 * np.log1p(2.0 * e)


def _atanh_ratio(z: Array) -> Array:
    """``artanh(z)/z``, one at zero; exactly even in z."""
    z = np.abs(z)
    small = z < 1e-8  # the next term, z^2/3, is below rounding
    return np.where(small, 1.0, np.arctanh(np.where(small, 0.5, z)) / np.where(small, 1.0, z))
