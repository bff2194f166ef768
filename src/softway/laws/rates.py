"""Objective rates: the axes in which a law with a history is read, as plain data.

A law relates a rate of the stress to the rate of deformation D.  Which rate, is a choice:

=============  ==========================================  =================================
rate           definition                                  axes carried along
=============  ==========================================  =================================
Jaumann        ``s' - W s + s W``                          turn with the spin W
GreenNaghdi    ``s' - O s + s O``, ``O = R' R^T``          turn with R of ``F = R U``
Logarithmic    ``s' - O s + s O``, ``(ln V)° = D``         turn so that D is the rate of ln V
Truesdell      ``s' - L s - s L^T + tr(D) s``              deform with the matter
=============  ==========================================  =================================

References
----------
Truesdell, Noll (1965), The non-linear field theories of mechanics; Xiao, Bruhns, Meyers (1997), Acta Mech. 124, 89-105.
"""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True, kw_only=True)
class Jaumann:
    """Axes that turn with the spin of the matter.

    Parameters
    ----------
    increment
        ``midpoint``: strain and spin of the increment on the configuration in its middle (Hughes and Winget);
        ``polar``: stretch first, then rotation, by the polar decomposition of the increment (Rashid).  Both leave no
        stress behind a rigid rotation; ``midpoint`` is singular for a half turn in one slab.

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
    """Axes that turn with the rotation of the polar decomposition.

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
    """Axes in which the rate of the logarithmic strain is the rate of deformation: no path matters.

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
    """Axes that deform with the matter; in closed cycles the law may create energy.

    References
    ----------
    Truesdell (1955), The simplest rate theory of pure elasticity, Commun. Pure Appl. Math. 8, 123-132.

    Examples
    --------
    >>> Truesdell()
    Truesdell()
    """


Rate = Jaumann | GreenNaghdi | Logarithmic | Truesdell
