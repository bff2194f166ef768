"""Friction with a limit that does not depend on the pressure (Tresca)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array
from softway.laws.friction_law import at_least_zero
from softway.units import Pascal


@dataclass(frozen=True, slots=True, kw_only=True)
class Tresca:
    """Tresca friction: ``|t| <= shear`` at rest, ``|t| = shear`` in slip, wherever surfaces are in contact.

    Parameters
    ----------
    shear
        Tangential traction in slip [Pa], zero or more.

    Examples
    --------
    >>> float(Tresca(shear=2.0).limit(np.array(10.0)))
    2.0
    """

    shear: Pascal
    frictionless: ClassVar[bool] = False

    def __post_init__(self) -> None:
        at_least_zero(shear=self.shear)

    def limit(self, pressure: Array) -> Array:
        """``shear`` (...,) [Pa]."""
        return np.full_like(pressure, self.shear)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """``shear`` (...,) and its derivatives, zero."""
        value = np.full(np.broadcast(speed, pressure).shape, self.shear)
        return value, np.zeros_like(value), np.zeros_like(value)
