"""Stability of St. Venant-Kirchhoff matter under compression (docs/theory/bodies/softening.md)."""

from math import log, sqrt

from scipy.optimize import brentq

BAR_STRETCH = 1.0 / sqrt(3.0)
"""Stretch of a bar, or of a volume along one axis, at its greatest compressive force."""
ROUNDING = 1e-9
"""Strain that leaves every material stable."""


def stable_stretch(nu: float) -> float:
    """Stretch in one direction, with the others held, below which some wave has no real speed.

    Parameters
    ----------
    nu
        Poisson's ratio, between -1 and 1/2.

    Examples
    --------
    >>> round(stable_stretch(0.3), 3), round(stable_stretch(0.45), 3)
    (0.706, 0.906)
    """
    strain = brentq(lambda e: _least(e, nu), -0.5 * (1.0 - BAR_STRETCH**2), -ROUNDING)
    return sqrt(1.0 + 2.0 * strain)


def plane_impact(stretch: float) -> float:
    """Speed of a plane impact on a rigid wall that compresses matter to a stretch, relative to the wave speed.

    Parameters
    ----------
    stretch
        Stretch of at least ``BAR_STRETCH``.

    Examples
    --------
    >>> round(plane_impact(0.99), 5), round(plane_impact(BAR_STRETCH), 3)
    (0.00992, 0.266)
    """
    return _primitive(1.0) - _primitive(stretch)


def _least(e: float, nu: float) -> float:
    """Least of the numbers whose sign tells if all waves have real speeds, for Green's strain e in one direction.

    With the shear modulus as unit, the determinant of the acoustic tensor in the plane of the directions with the
    cosine sqrt(x) is a convex parabola in x; the eigenvalue across that plane is least along the strain.
    """
    lame = 2.0 * nu / (1.0 - 2.0 * nu)
    a = lame + 1.0
    p, q = 1.0 + 2.0 * e + e * lame, a * (1.0 + 2.0 * e) + 2.0 * e
    r, t = a + 1.0 + e * lame, a - 2.0 * e
    second, first = 4.0 * e**2 * (a + 1.0), q * r - p * t - a**2 * (1.0 + 2.0 * e)
    lowest = min(max(-first / (2.0 * second), 0.0), 1.0)
    return min(1.0 + e * (lame + 2.0), *(p * r + first * x + second * x**2 for x in (0.0, lowest, 1.0)))


def _primitive(stretch: float) -> float:
    """Integral of the wave speed ``sqrt((3 s^2 - 1)/2)``, relative to that at rest, up to a stretch."""
    root = sqrt(max(3.0 * stretch**2 - 1.0, 0.0))
    return (0.5 * stretch * root - log(sqrt(3.0) * stretch + root) / (2.0 * sqrt(3.0))) / sqrt(2.0)
