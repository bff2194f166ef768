"""Hardening of metals: yield stress as a function of the equivalent plastic strain."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.units import Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearHardening:
    """Linear hardening ``s = s0 + H p``.

    Parameters
    ----------
    modulus
        Hardening modulus H [Pa]; a negative value means softening.

    Examples
    --------
    >>> LinearHardening(modulus=2.0).stress(1.0, np.array([0.5])).tolist()
    [2.0]
    """

    modulus: Pascal = 0.0

    def stress(self, initial: float, p: Array) -> Array:
        """Yield stress [Pa] at the plastic strain p; ``initial`` is the initial yield stress [Pa]."""
        return initial + self.modulus * p

    def slope(self, initial: float, p: Array) -> Array:
        """Derivative with respect to p [Pa]."""
        return np.full_like(p, self.modulus)

    def least_slope(self) -> float:
        """Least possible slope [Pa]."""
        return self.modulus


@dataclass(frozen=True, slots=True, kw_only=True)
class Voce:
    """Voce hardening ``s = s0 + (s_inf - s0)(1 - exp(-delta p)) + H p``, which saturates for H = 0.

    Parameters
    ----------
    saturation
        Saturation stress s_inf [Pa].
    exponent
        Exponent delta, positive.
    modulus
        Modulus H of the linear part [Pa].

    References
    ----------
    Voce (1948), The relationship between stress and strain for homogeneous deformation, J. Inst. Metals 74, 537-562.

    Examples
    --------
    >>> Voce(saturation=2.0, exponent=10.0).stress(1.0, np.array([0.0, 100.0])).tolist()
    [1.0, 2.0]
    """

    saturation: Pascal
    exponent: Pure
    modulus: Pascal = 0.0

    def __post_init__(self) -> None:
        if not self.exponent > 0.0:
            raise InputError("exponent", f"{self.exponent:g} is not positive", "a positive number, 10 to 20 for metals")

    def stress(self, initial: float, p: Array) -> Array:
        """Yield stress [Pa] at the plastic strain p; ``initial`` is the initial yield stress [Pa]."""
        return initial - (self.saturation - initial) * np.expm1(-self.exponent * p) + self.modulus * p

    def slope(self, initial: float, p: Array) -> Array:
        """Derivative with respect to p [Pa]."""
        return (self.saturation - initial) * self.exponent * np.exp(-self.exponent * p) + self.modulus

    def least_slope(self) -> float:
        """Least possible slope [Pa]."""
        return self.modulus


@dataclass(frozen=True, slots=True, kw_only=True)
class PowerHardening:
    """Power-law hardening ``s = s0 + B p^n`` of Johnson and Cook (Ludwik's law).

    Parameters
    ----------
    modulus
        Hardening modulus B [Pa], not negative.
    exponent
        Hardening exponent n, above 0 and at most 1.

    References
    ----------
    Johnson, Cook (1983), A constitutive model and data for metals subjected to large strains, high strain rates and
    high temperatures, Proc. 7th Int. Symp. Ballistics, 541-547.

    Examples
    --------
    >>> PowerHardening(modulus=2.0, exponent=0.5).stress(1.0, np.array([0.25])).tolist()
    [2.0]
    """

    modulus: Pascal
    exponent: Pure

    def __post_init__(self) -> None:
        if not self.modulus >= 0.0:
            raise InputError("modulus", f"{self.modulus:g} Pa is negative", "zero or more")
        if not 0.0 < self.exponent <= 1.0:
            raise InputError("exponent", f"{self.exponent:g} is not in (0, 1]", "a number such as 0.3")

    def stress(self, initial: float, p: Array) -> Array:
        """Yield stress [Pa] at the plastic strain p; ``initial`` is the initial yield stress [Pa]."""
        return initial + self.modulus * np.maximum(p, 0.0) ** self.exponent

    def slope(self, initial: float, p: Array) -> Array:
        """Derivative with respect to p [Pa]; below p = 1e-12 the value at 1e-12."""
        return self.modulus * self.exponent * np.maximum(p, 1e-12) ** (self.exponent - 1.0)

    def least_slope(self) -> float:
        """Least possible slope [Pa]."""
        return 0.0


Hardening = LinearHardening | Voce | PowerHardening
