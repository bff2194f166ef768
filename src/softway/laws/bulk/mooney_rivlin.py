"""Compressible Mooney-Rivlin material, for rubber."""

from dataclasses import dataclass
from math import isfinite, sqrt
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.linalg import tensors
from softway.laws.elasticity import volume_change
from softway.laws.strain_measures import Green
from softway.units import Pascal


@dataclass(frozen=True, slots=True, kw_only=True)
class MooneyRivlin:
    """Mooney-Rivlin law ``W = c10 (I1 J^-2/3 - 3) + c01 (I2 J^-4/3 - 3) + bulk/4 (J^2 - 1 - 2 ln J)``.

    I1 and I2 are invariants of ``C = I + 2 E``.  The first two terms are independent of the volume, and the last term
    depends on the volume only.  With ``theta = I1/3``, the deviator e of E and ``d = e/theta``, the first two terms are
    functions of ``q = 4 I2(d) + 8 det d`` and I2(d), which avoids cancellation at small strain.  At small strain the
    shear modulus is ``2 (c10 + c01)`` and the bulk modulus is ``bulk``.  The law is polyconvex, since neither constant
    may be negative.

    Parameters
    ----------
    c10, c01
        Mooney constants [Pa]; not negative, and not both zero.
    bulk
        Bulk modulus [Pa], positive; 1000 times the shear modulus or more for real rubber, which needs elements that
        do not lock.

    References
    ----------
    Mooney (1940), A theory of large elastic deformation, J. Appl. Phys. 11, 582-592; Rivlin (1948), Phil. Trans. R.
    Soc. A 241, 379-397; the volumetric part of Simo, Hughes (1998), Computational inelasticity, chapter 9.

    Examples
    --------
    >>> law = MooneyRivlin(c10=1.0, c01=0.5, bulk=100.0)
    >>> float(law.energy(np.zeros((3, 3)))), round(law.youngs(), 6)
    (0.0, 8.910891)
    """

    c10: Pascal
    c01: Pascal = 0.0
    bulk: Pascal
    measure: ClassVar[Green] = Green()
    linear: ClassVar[bool] = False

    def __post_init__(self) -> None:
        for name in ("c10", "c01"):
            value = getattr(self, name)
            if not (isfinite(value) and value >= 0.0):
                raise InputError(name, f"{value:g} Pa is negative", "constants from a fit with c10 >= 0 and c01 >= 0")
        if self.c10 + self.c01 == 0.0:
            raise InputError("c10", "0 Pa together with c01 = 0 Pa gives no shear modulus", "a positive constant")
        if not (isfinite(self.bulk) and self.bulk > 0.0):
            raise InputError("bulk", f"{self.bulk:g} Pa is not positive", "for example 2000 times the shear modulus")

    def energy(self, E: Array) -> Array:
        """Energy per reference volume (...,) [J/m^3] of Green's strain E (..., 3, 3)."""
        theta, e = _split(E)
        j = volume_change.jacobian(E)[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            d = e / theta[..., None, None]
            minors = 4.0 * tensors.second_invariant(d)
            k = np.log1p(minors + 8.0 * tensors.determinant(d))
            first = 3.0 * np.expm1(-k / 3.0)
            second = 3.0 * np.expm1(-2.0 * k / 3.0) + minors * np.exp(-2.0 * k / 3.0)
            W = self.c10 * first + self.c01 * second + 0.25 * self.bulk * volume_change.excess(j)
        return np.where(_possible(j, theta) & np.isfinite(W), W, np.inf)

    def stress(self, E: Array) -> Array:
        """Second Piola-Kirchhoff stress, (..., 3, 3) [Pa]."""
        theta, e = _split(E)
        inverse, logarithm = volume_change.inverse(E)
        j = volume_change.jacobian(E)[1]
        square = e @ e
        square = square - (tensors.trace(square) / 3.0)[..., None, None] * tensors.IDENTITY
        a = np.exp(-2.0 / 3.0 * logarithm)[..., None, None]
        core = self.c10 * a * e + self.c01 * a * a * (theta[..., None, None] * e - 2.0 * square)
        return tensors.symmetric(4.0 * (inverse @ core)) + (0.5 * self.bulk * j)[..., None, None] * inverse

    def tangent(self, E: Array) -> Array:
        """Moduli dS/dE, (..., 3, 3, 3, 3) [Pa]."""
        theta, _ = _split(E)
        inverse, logarithm = volume_change.inverse(E)
        j = volume_change.jacobian(E)[1]
        C = tensors.IDENTITY + 2.0 * E
        B = (3.0 * theta)[..., None, None] * tensors.IDENTITY - C  # dI2/dC
        I2 = tensors.second_invariant(C)
        a = np.exp(-2.0 / 3.0 * logarithm)
        x, y = 4.0 / 3.0 * self.c10 * a, 2.0 * self.c01 * a * a
        one = tensors.square_symmetric(inverse)
        one *= (3.0 * x * theta + 4.0 / 3.0 * y * I2 - self.bulk * j)[..., None, None, None, None]
        both = x[..., None, None] * tensors.IDENTITY + (4.0 / 3.0 * y)[..., None, None] * B
        one -= _outer(both, inverse) + _outer(inverse, both)
        volumetric = x * theta + 8.0 / 9.0 * y * I2 + self.bulk * (1.0 + j)
        one += volumetric[..., None, None, None, None] * _outer(inverse, inverse)
        unit = _outer(tensors.IDENTITY, tensors.IDENTITY) - tensors.square_symmetric(tensors.IDENTITY)
        return one + 2.0 * y[..., None, None, None, None] * unit

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves in the undeformed volume [m/s]."""
        return sqrt((self.bulk + 8.0 / 3.0 * (self.c10 + self.c01)) / density)

    def youngs(self) -> float:
        """Young's modulus of small strains [Pa]."""
        shear = 2.0 * (self.c10 + self.c01)
        return 9.0 * self.bulk * shear / (3.0 * self.bulk + shear)


def _split(E: Array) -> tuple[Array, Array]:
    """One third of I1(C), (...,), and the deviator of E, (..., 3, 3)."""
    mean = tensors.trace(E) / 3.0
    return 1.0 + 2.0 * mean, E - mean[..., None, None] * tensors.IDENTITY


def _possible(j: Array, theta: Array) -> Array:
    """True where the deformation is possible: where det C and tr C are positive."""
    return np.asarray((j > -1.0) & (theta > 0.0))


def _outer(A: Array, B: Array) -> Array:
    """``A_ij B_kl``, (..., 3, 3, 3, 3)."""
    return A[..., :, :, None, None] * B[..., None, None, :, :]
