"""What a law of friction must say about itself."""

from typing import Protocol

import numpy as np

from softway.errors import InputError
from softway.typing import Array


class FrictionLaw(Protocol):
    """An isotropic resistance to slip, set-valued at rest as a rigid-viscoplastic law of the bulk.

    The tangential traction t on a surface that slips with the velocity v on its opponent is ::

        t = -resistance(|v|, p) v/|v|  where v != 0,    |t| <= limit(p)  where v = 0,

    with the normal pressure p >= 0.  Speeds and pressures come as arrays of one shape (...,).
    """

    @property
    def frictionless(self) -> bool:
        """Whether there is no friction at all."""
        ...

    def limit(self, pressure: Array) -> Array:
        """Greatest traction (...,) held at rest [Pa]."""
        ...

    def resistance(self, speed: Array, pressure: Array) -> tuple[Array, Array, Array]:
        """Traction of slip (...,) [Pa], at the speed zero its limit from above, with its derivatives to the speed
        [Pa s/m] and to the pressure.
        """
        ...


def at_least_zero(**values: float) -> None:
    """Refuse negative or infinite parameters.

    Raises
    ------
    InputError
        Naming the parameter.

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
            raise InputError(name, f"{value:g} is not finite", "a number")


def positive(**values: float) -> None:
    """Refuse parameters that are not positive numbers.

    Raises
    ------
    InputError
        Naming the parameter.
    """
    for name, value in values.items():
        if not 0.0 < value < np.inf:
            raise InputError(name, f"{value:g} is not positive", "a positive number")
