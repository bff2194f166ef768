"""Protocol of friction laws, and checks of their parameters."""

from typing import Protocol

import numpy as np

from softway.arrays import Array
from softway.errors import InputError


class FrictionLaw(Protocol):
    """Isotropic friction law, set-valued at rest like a rigid-viscoplastic material law.

    The tangential traction t on a surface that slips with the velocity v over the other surface is ::

        t = -resistance(|v|, p) v/|v|  where v != 0,    |t| <= limit(p)  where v = 0,

    with the normal pressure p >= 0.  Speeds and pressures are arrays of the same shape (...,).
    """

    @property
    def frictionless(self) -> bool:
        """True if there is no friction at all."""
        ...

    def limit(self, pressure: Array) -> Array:
        """Greatest tangential traction (...,) at rest [Pa]."""
        ...

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """Traction in slip (...,) [Pa], with its derivatives with respect to the speed [Pa s/m] and the pressure.

        At zero speed the traction is the limit for a speed that tends to zero from above.
        """
        ...


def at_least_zero(**values: float) -> None:
    """Raise an error for negative or infinite parameters.

    Raises
    ------
    InputError
        If a parameter is negative or not finite; the error names it.

    Examples
    --------
    >>> at_least_zero(mu=-0.1)
    Traceback (most recent call last):
    softway.errors.InputError: mu: -0.1 is negative
      try: zero or more
    """
    for name, value in values.items():
        if not value >= 0.0:
            raise InputError(name, f"{value:g} is negative", "zero or more")
        if not np.isfinite(value):
            raise InputError(name, f"{value:g} is not finite", "a finite number")
