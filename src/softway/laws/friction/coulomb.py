"""Dry friction (Amontons, Coulomb)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.laws.friction_law import at_least_zero
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Coulomb:
    """Coulomb friction: ``|t| <= mu p`` at rest, ``|t| = mu p`` in slip, without regularisation.

    Parameters
    ----------
    mu
        Coefficient of friction, zero or more.

    References
    ----------
    Coulomb (1785), Theorie des machines simples.

    Examples
    --------
    >>> float(Coulomb(mu=0.3).limit(np.array(10.0)))
    3.0
    """

    mu: Pure
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(mu=self.mu)

    def limit(self, pressure: Array) -> Array:
        """``mu p`` (...,) [Pa]."""
        return np.asarray(self.mu * pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """``mu p`` (...,) and its derivatives, at any speed."""
        value = self.mu * np.broadcast_arrays(pressure, speed)[0]
        return value, np.zeros_like(value), np.full_like(value, self.mu)
