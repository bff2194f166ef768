"""Viscoplastic friction, limited by the shear strength of the material and by dry friction."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.errors import positive
from softway.laws.friction_law import at_least_zero
from softway.units import MetrePerSecond, Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitedViscoplastic:
    """Limited viscoplastic friction ``|t| = min(alpha K (|v|/v0)^p, mbar sigma_eq/sqrt 3, mu p_n)``, for metal forming.

    Parameters
    ----------
    alpha
        Fraction of the consistency of the softer material, zero or more.
    p
        Exponent of the speed, positive; 1 is viscous friction.
    K
        Consistency of the softer material [Pa], zero or more.
    mbar
        Shear strength of the interface as a fraction of the shear strength of the softer material, zero or more.
    sigma_eq
        Yield stress of the softer material [Pa], zero or more.
    mu
        Coefficient of dry friction, zero or more.
    v0
        Reference speed [m/s], positive.

    References
    ----------
    Chenot, Bohatier et al., Numerical modelling of metal forming (Norton-Hoff friction with thresholds).

    Examples
    --------
    >>> law = LimitedViscoplastic(alpha=1.0, p=1.0, K=1.0, mbar=1.0, sigma_eq=10.0, mu=0.5)
    >>> law.resistance(np.array([1.0, 4.0]), np.array([4.0, 4.0]))[0].tolist()
    [1.0, 2.0]
    """

    alpha: Pure
    p: Pure
    K: Pascal
    mbar: Pure
    sigma_eq: Pascal
    mu: Pure
    v0: MetrePerSecond = 1.0
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(alpha=self.alpha, K=self.K, mbar=self.mbar, sigma_eq=self.sigma_eq, mu=self.mu)
        positive(p=self.p, v0=self.v0)

    def limit(self, pressure: Array) -> Array:
        """Zero (...,)."""
        return np.zeros_like(pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """Least of the three tractions (...,) [Pa] and its derivatives."""
        v, n = (np.asarray(a, float) for a in np.broadcast_arrays(speed, pressure))
        x, scale = np.maximum(v / self.v0, 0.0), self.alpha * self.K
        with np.errstate(divide="ignore"):
            slope = scale * self.p / self.v0 * x ** (self.p - 1.0) if scale > 0.0 else np.zeros_like(x)
        flow, dry = scale * x**self.p, self.mu * n
        strength = np.full_like(x, self.mbar * self.sigma_eq / np.sqrt(3.0))
        least = np.minimum(np.minimum(flow, strength), dry)
        none = np.zeros_like(x)
        return least, np.where(flow <= least, slope, none), np.where((dry <= least) & (flow > least), self.mu, none)
