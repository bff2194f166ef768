"""No friction."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from softway.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Frictionless:
    """No friction: surfaces slip freely.

    Examples
    --------
    >>> float(Frictionless().limit(np.array(5.0)))
    0.0
    """

    frictionless: ClassVar[bool] = True

    def limit(self, pressure: Array) -> Array:
        """Zero (...,)."""
        return np.zeros_like(pressure)

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """Zeros (...,)."""
        none = np.zeros(np.broadcast(speed, pressure).shape)
        return none, none, none
