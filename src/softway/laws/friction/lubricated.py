"""Friction of a thin film of a viscous fluid."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.errors import positive
from softway.laws.friction_law import at_least_zero
from softway.units import Metre, PascalSecond


@dataclass(frozen=True, slots=True, kw_only=True)
class Lubricated:
    """Viscous friction of a lubricant film of constant thickness, ``t = -viscosity v/film``.

    Parameters
    ----------
    viscosity
        Viscosity of the fluid [Pa s], zero or more.
    film
        Thickness of the film [m], positive.

    Examples
    --------
    >>> Lubricated(viscosity=0.1, film=1e-3).resistance(np.array(2.0), np.array(0.0))[0]
    np.float64(200.0)
    """

    viscosity: PascalSecond
    film: Metre
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(viscosity=self.viscosity)
        positive(film=self.film)

    def limit(self, pressure: Array) -> Array:
        """Zero (...,)."""
        return np.zeros_like(pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """``viscosity |v|/film`` (...,) [Pa] and its derivatives."""
        v = np.broadcast_arrays(speed, pressure)[0]
        slope = np.full(v.shape, self.viscosity / self.film)
        return slope * v, slope, np.zeros(v.shape)
