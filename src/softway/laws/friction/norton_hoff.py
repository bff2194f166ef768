"""Viscoplastic friction in the form of the Norton-Hoff law."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.errors import positive
from softway.laws.friction_law import at_least_zero
from softway.units import MetrePerSecond, Pascal, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class NortonHoff:
    """Viscoplastic friction ``t = -alpha K |v/v0|^(p-1) v/v0``, eq. (3.6) of the paper.

    There is no friction at rest, and the traction does not depend on the pressure.

    Parameters
    ----------
    alpha
        Fraction of the consistency of the softer material, zero or more.
    p
        Exponent of the speed, positive; 1 is viscous friction.
    K
        Consistency of the softer material [Pa], zero or more.
    v0
        Reference speed [m/s], positive.

    Examples
    --------
    >>> NortonHoff(alpha=0.5, p=2.0, K=3.0).resistance(np.array(2.0), np.array(0.0))[0]
    np.float64(6.0)
    """

    alpha: Pure
    p: Pure
    K: Pascal = 1.0
    v0: MetrePerSecond = 1.0
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(alpha=self.alpha, K=self.K)
        positive(p=self.p, v0=self.v0)

    def limit(self, pressure: Array) -> Array:
        """Zero (...,)."""
        return np.zeros_like(pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """``alpha K (|v|/v0)^p`` (...,) [Pa] and its derivatives; the slope at rest is infinite for p < 1."""
        x = np.maximum(np.broadcast_arrays(speed, pressure)[0] / self.v0, 0.0)
        scale = self.alpha * self.K
        with np.errstate(divide="ignore"):
            slope = scale * self.p / self.v0 * x ** (self.p - 1.0) if scale > 0.0 else np.zeros_like(x)
        return scale * x**self.p, slope, np.zeros_like(x)
