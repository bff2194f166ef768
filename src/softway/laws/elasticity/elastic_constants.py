"""Elastic constants of isotropic materials, and moduli of plane waves."""

from itertools import product
from math import isfinite, sqrt

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, real

STIFF = 1e6
"""Bulk modulus for nu = 1/2 (nearly incompressible material), relative to the shear modulus."""
_TURNS = 300  # greatest number of iterations of the search for the fastest wave; few are needed


def checked(E: float, nu: float) -> None:
    """Raise :class:`~softway.errors.InputError` unless ``E > 0`` and ``-1 < nu <= 1/2``.

    Examples
    --------
    >>> checked(1.0, 0.6)
    Traceback (most recent call last):
    softway.errors.InputError: nu: 0.6 is not between -1 and 0.5
      try: a value such as 0.3, or 0.49 for rubber
    """
    for name, value in (("E", E), ("nu", nu)):
        real(value, name)
    if not (isfinite(E) and E > 0.0):
        raise InputError("E", f"{E:g} Pa is not positive", "a positive Young's modulus")
    if not -1.0 < nu <= 0.5:
        raise InputError("nu", f"{nu:g} is not between -1 and 0.5", "a value such as 0.3, or 0.49 for rubber")


def lame(E: float, nu: float) -> tuple[float, float]:
    """Lame constants lambda and mu [Pa] of Young's modulus E [Pa] and Poisson's ratio nu.

    For nu = 1/2 (nearly incompressible material) the bulk modulus is ``STIFF mu``: a pressure p causes the relative
    volume change ``p/(STIFF mu)``.

    Examples
    --------
    >>> lame(2.5, 0.25)
    (1.0, 1.0)
    """
    shear = E / (2.0 * (1.0 + nu))
    if nu == 0.5:
        return (STIFF - 2.0 / 3.0) * shear, shear
    return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), shear


def dilatational_speed(E: float, nu: float, density: float) -> float:
    """Speed of dilatational waves ``sqrt((lambda + 2 mu)/rho)`` [m/s] with the density rho [kg/m^3]."""
    bulk_part, shear = lame(E, nu)
    return sqrt((bulk_part + 2.0 * shear) / density)


def wave_modulus(C: Array) -> float:
    """Greatest ``rho c^2`` [Pa] of plane waves in any direction, for the moduli C (m, m, m, m) along m axes.

    This is the greatest value of ``a_i n_j C_ijkl a_k n_l`` over unit vectors n (direction) and a (motion).  The search
    alternates: with one vector fixed, the other is replaced by the principal axis with the greatest value.  It starts
    from the axes and the diagonals.

    Examples
    --------
    >>> from softway.kernels.linalg.tensors import isotropic
    >>> round(wave_modulus(isotropic(1.0, 2.0)), 12)
    5.0
    """
    found, m = 0.0, len(C)
    for start in product((-1.0, 0.0, 1.0), repeat=m):
        n = np.array(start)
        if n @ n == 0.0:
            continue
        n /= np.sqrt(n @ n)
        best = 0.0
        for _ in range(_TURNS):
            values, axes = np.linalg.eigh(np.einsum("ijkl,j,l->ik", C, n, n))
            n = axes[:, -1]  # C_ijkl = C_jilk: motion and direction exchange their roles
            if values[-1] <= best * (1.0 + 1e-15):
                break
            best = float(values[-1])
        found = max(found, best)
    return found
