"""Dry friction that is greater at rest than in slip."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.laws.friction_law import at_least_zero
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class StaticKinetic:
    """Static and kinetic friction: ``|t| <= mu_s p`` at rest, ``|t| = mu_k p`` in slip.

    From the instant on at which a slipping body comes to rest the limit is ``mu_s p``.  Points that come to rest alone,
    within a time step (slab), have to be held by ``mu_k p`` in it.

    Parameters
    ----------
    mu_s, mu_k
        Coefficients of static and kinetic friction, ``mu_s >= mu_k >= 0``.

    Examples
    --------
    >>> float(StaticKinetic(mu_s=0.4, mu_k=0.2).limit(np.array(10.0)))
    4.0
    """

    mu_s: Pure
    mu_k: Pure
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(mu_s=self.mu_s, mu_k=self.mu_k)
        if self.mu_s < self.mu_k:
            raise InputError("mu_s", f"{self.mu_s:g} is less than mu_k = {self.mu_k:g}", "mu_s >= mu_k")

    def limit(self, pressure: Array) -> Array:
        """``mu_s p`` (...,) [Pa]."""
        return np.asarray(self.mu_s * pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """``mu_k p`` (...,) and its derivatives, at any speed."""
        value = self.mu_k * np.broadcast_arrays(pressure, speed)[0]
        return value, np.zeros_like(value), np.full_like(value, self.mu_k)
