"""Amplification matrix of one slab of an oscillator with a velocity linear in time: case A01 in closed form.

With z = omega h and the moments m1, m2 of the virtual time function (its means of tau and tau^2), the slab maps (x, h
v) from its start to its end by a matrix with

    trace = 2 - z^2 (1/2 + m1) / D,   det = 1 + z^2 (1/2 - m1) / D,   D = 1 + z^2 m2 / 2.

A constant function has m1 = 1/2, m2 = 1/3; a peak at alpha has m1 = alpha, m2 = alpha^2.
"""

from cmath import phase, sqrt
from math import inf
from math import sqrt as root

CONSTANT = (1.0 / 2.0, 1.0 / 3.0)


def peak(alpha: float) -> tuple[float, float]:
    """Moments of a peak at tau = alpha."""
    return alpha, alpha**2


def eigenvalue(moments: tuple[float, float], z: float) -> complex:
    """Eigenvalue of the amplification matrix with the largest modulus; of a pair, the one above the real axis.

    >>> round(abs(eigenvalue(peak(1.0), 1.0)) ** 2, 12)
    0.666666666667
    """
    m1, m2 = moments
    d = 1.0 + 0.5 * z**2 * m2
    half, det = 1.0 - 0.5 * z**2 * (0.5 + m1) / d, 1.0 + z**2 * (0.5 - m1) / d
    gap = sqrt(half**2 - det)
    return half + gap if abs(half + gap) >= abs(half - gap) else half - gap


def radius(moments: tuple[float, float], z: float) -> float:
    """Spectral radius of the amplification matrix."""
    return abs(eigenvalue(moments, z))


def frequency(moments: tuple[float, float], z: float) -> float:
    """Ratio of the numerical to the exact frequency, if the motion oscillates.

    >>> round(frequency(CONSTANT, 2.0), 12)
    0.886077123793
    """
    return abs(phase(eigenvalue(moments, z))) / z


def limit(moments: tuple[float, float]) -> float:
    """Stability limit: the greatest z without growth.

    >>> round(limit(CONSTANT) ** 2, 12), limit(peak(1.0))
    (12.0, inf)
    """
    m1, m2 = moments
    return inf if m1 <= m2 else root(2.0 / (m1 - m2))
