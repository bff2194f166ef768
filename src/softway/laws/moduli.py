"""Elastic moduli of isotropic materials."""

from math import isfinite, sqrt

from softway.errors import InputError


def checked(E: float, nu: float) -> None:
    """Raise :class:`~softway.errors.InputError` unless ``E > 0`` and ``-1 < nu < 1/2``.

    Examples
    --------
    >>> checked(1.0, 0.5)
    Traceback (most recent call last):
    softway.errors.InputError: nu: 0.5 is not between -1 and 0.5
      try: a value such as 0.3, or 0.49 for rubber
    """
    if not (isfinite(E) and E > 0.0):
        raise InputError("E", f"{E:g} Pa is not positive", "a positive Young's modulus")
    if not -1.0 < nu < 0.5:
        raise InputError("nu", f"{nu:g} is not between -1 and 0.5", "a value such as 0.3, or 0.49 for rubber")


def lame(E: float, nu: float) -> tuple[float, float]:
    """Lame constants lambda and mu [Pa] of Young's modulus E [Pa] and Poisson's ratio nu.

    Examples
    --------
    >>> lame(2.5, 0.25)
    (1.0, 1.0)
    """
    return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))


def dilatational_speed(E: float, nu: float, density: float) -> float:
    """``sqrt((lambda + 2 mu)/rho)`` [m/s] with rho [kg/m^3]."""
    bulk_part, shear = lame(E, nu)
    return sqrt((bulk_part + 2.0 * shear) / density)
