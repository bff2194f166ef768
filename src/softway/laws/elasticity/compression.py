"""Stability of St. Venant-Kirchhoff matter under compression (docs/theory/bodies/softening.md)."""

from math import log, sqrt

BAR_STRETCH = 1.0 / sqrt(3.0)
"""Stretch of a bar, or of a volume along one axis, at its greatest compressive force."""
COLLAPSED = -0.35
"""Green's strain in one direction at which no material is stable: waves along it lose their speed at -1/3."""
SAFE = 1e-3
"""Pressure of a strain, relative to the shear modulus, that leaves every material stable."""


def stable_stretch(lame: float) -> float:
    """Stretch in one direction, with the others held, below which some wave has no real speed.

    Parameters
    ----------
    lame
        Lame's first constant, in plane stress ``2 lambda mu / (lambda + 2 mu)``, relative to the shear modulus mu;
        greater than -1.

    Examples
    --------
    Poisson's ratios of 0.3 and 0.45, where ``lame`` is ``2 nu / (1 - 2 nu)``, and rubber:

    >>> round(stable_stretch(1.5), 3), round(stable_stretch(9.0), 3), 1.0 - stable_stretch(1e6) < 1e-5
    (0.706, 0.906, True)
    """
    from scipy.optimize import brentq  # slow to load

    strain = brentq(lambda e: _least(e, lame), COLLAPSED, -SAFE / (lame + 2.0), xtol=1e-300)
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


def _least(e: float, lame: float) -> float:
    """Least of the numbers whose sign tells if all waves have real speeds, for Green's strain e in one direction.

    With the shear modulus as unit, the determinant of the acoustic tensor in the plane of the directions with the
    cosine sqrt(x) is a convex parabola in x; the eigenvalue across that plane is least along the strain.
    """
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
