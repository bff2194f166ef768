"""Objective stress rates, which define the axes of a law with a history, as plain data.

A law relates a rate of the stress to the rate of deformation D.  The rate is one of:

=============  ==========================================  =================================
rate           definition                                  axes carried along
=============  ==========================================  =================================
Jaumann        ``s' - W s + s W``                          rotate with the spin W
GreenNaghdi    ``s' - O s + s O``, ``O = R' R^T``          rotate with R of ``F = R U``
Logarithmic    ``s' - O s + s O``, ``(ln V)° = D``         rotate so that D is the rate of ln V
Truesdell      ``s' - L s - s L^T + tr(D) s``              deform with the material
=============  ==========================================  =================================

References
----------
Truesdell, Noll (1965), The non-linear field theories of mechanics; Xiao, Bruhns, Meyers (1997), Acta Mech. 124, 89-105.
"""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True, kw_only=True)
class Jaumann:
    """Axes that rotate with the spin of the material.

    Parameters
    ----------
    increment
        ``midpoint``: strain and spin of the increment in the configuration at the middle of the time step (Hughes and
        Winget); ``polar``: stretch, then rotation, from the polar decomposition of the increment (Rashid).  A rigid
        rotation causes no stress with either of them; ``midpoint`` is singular for a rotation by 180 degrees in one
        time step.

    References
    ----------
    Hughes, Winget (1980), Finite rotation effects in numerical integration of rate constitutive equations, Int. J.
    Numer. Methods Eng. 15, 1862-1867; Rashid (1993), Incremental kinematics for finite element applications, Int. J.
    Numer. Methods Eng. 36, 3937-3956.

    Examples
    --------
    >>> Jaumann().increment
    'midpoint'
    """

    increment: Literal["midpoint", "polar"] = "midpoint"


@dataclass(frozen=True, slots=True, kw_only=True)
class GreenNaghdi:
    """Axes that rotate with R of the polar decomposition ``F = R U``.

    References
    ----------
    Green, Naghdi (1965), A general theory of an elastic-plastic continuum, Arch. Ration. Mech. Anal. 18, 251-281.

    Examples
    --------
    >>> GreenNaghdi()
    GreenNaghdi()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class Logarithmic:
    """Axes in which the rate of the logarithmic strain is the rate of deformation: elastic stress is path-independent.

    References
    ----------
    Xiao, Bruhns, Meyers (1997), Logarithmic strain, logarithmic spin and logarithmic rate, Acta Mech. 124, 89-105.

    Examples
    --------
    >>> Logarithmic()
    Logarithmic()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class Truesdell:
    """Axes that deform with the material; a law may create energy in closed cycles.

    References
    ----------
    Truesdell (1955), The simplest rate theory of pure elasticity, Commun. Pure Appl. Math. 8, 123-132.

    Examples
    --------
    >>> Truesdell()
    Truesdell()
    """


Rate = Jaumann | GreenNaghdi | Logarithmic | Truesdell
