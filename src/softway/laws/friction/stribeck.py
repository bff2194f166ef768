"""Friction that first decreases and then increases with the speed (Stribeck)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive
from softway.laws.friction_law import at_least_zero
from softway.units import MetrePerSecond, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Stribeck:
    """Stribeck friction ``|t|/p = mu_k + (mu_s - mu_k) exp(-(|v|/v_s)^delta) + viscous |v|/v_s``.

    At rest the limit is ``mu_s p``.

    Parameters
    ----------
    mu_s, mu_k
        Coefficients of friction at rest and in fast slip, ``mu_s >= mu_k >= 0``.
    v_s
        Stribeck speed [m/s], positive.
    delta
        Exponent of the speed, positive.
    viscous
        Coefficient of the viscous part at the speed ``v_s``, zero or more.

    References
    ----------
    Stribeck (1902), Z. VDI 46; Bo, Pavelescu (1982), Wear 82, 277-289.

    Examples
    --------
    >>> law = Stribeck(mu_s=0.4, mu_k=0.2, v_s=0.01)
    >>> law.resistance(np.array([0.0, 1.0]), np.array([1.0, 1.0]))[0].round(12).tolist()
    [0.4, 0.2]
    """

    mu_s: Pure
    mu_k: Pure
    v_s: MetrePerSecond
    delta: Pure = 1.0
    viscous: Pure = 0.0
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(mu_s=self.mu_s, mu_k=self.mu_k, viscous=self.viscous)
        positive(v_s=self.v_s, delta=self.delta)
        if self.mu_s < self.mu_k:
            raise InputError("mu_s", f"{self.mu_s:g} is less than mu_k = {self.mu_k:g}", "mu_s >= mu_k")

    def limit(self, pressure: Array) -> Array:
        """``mu_s p`` (...,) [Pa]."""
        return np.asarray(self.mu_s * pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """Traction (...,) [Pa] and its derivatives."""
        v, n = (np.asarray(a, float) for a in np.broadcast_arrays(speed, pressure))
        x = np.maximum(v / self.v_s, 0.0)
        power = x**self.delta
        fall = (self.mu_s - self.mu_k) * np.exp(-power)
        mu = self.mu_k + fall + self.viscous * x
        with np.errstate(divide="ignore", invalid="ignore"):
            steep = np.where((fall > 0.0) & (n != 0.0), fall * self.delta * x ** (self.delta - 1.0), 0.0)
        return mu * n, n / self.v_s * (self.viscous - steep), mu
