"""How the internal force is averaged over a slab, as plain data.

The names refer to the functions of :class:`~softway.bodies.internal.InternalForce` that compute the average.
"""

from dataclasses import dataclass

from softway.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Weighted:
    """The force at the peaks of the slab's time weight: ``sum_p w_p f(x(tau_p))``.

    Examples
    --------
    >>> Weighted()
    Weighted()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class AverageField:
    """The force averaged along the chord: ``int_0^1 f(u0 + s (u1 - u0)) ds`` by Gauss points.

    The work ``f . (u1 - u0)`` equals the stored energy up to the quadrature; two points are exact for an energy of
    fourth degree in the displacement (St. Venant-Kirchhoff).

    Parameters
    ----------
    points
        Gauss points along the chord, at least 1.

    References
    ----------
    Quispel, McLaren (2008), A new class of energy-preserving numerical integration methods, J. Phys. A 41, 045206.

    Examples
    --------
    >>> AverageField().points
    3
    """

    points: int = 3

    def __post_init__(self) -> None:
        if self.points < 1:
            raise InputError("points", f"{self.points} points average nothing", "1 or more")


@dataclass(frozen=True, slots=True, kw_only=True)
class DiscreteGradient:
    """Gonzalez' discrete gradient at every quadrature point: the work equals the stored energy to rounding.

    References
    ----------
    Gonzalez (2000), Exact energy and momentum conserving algorithms for general models in nonlinear elasticity,
    Comput. Methods Appl. Mech. Engrg. 190, 1763-1783.

    Examples
    --------
    >>> DiscreteGradient()
    DiscreteGradient()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class EnergyMomentum:
    """The force of the virtual time function, completed so that energy and angular momentum keep their balance.

    A force ``M (b x (x - centre))`` turns every body about its centre of mass; the vector b, one for each group of
    touching bodies, makes the internal forces and the contact between the bodies free of moment.  No quotient of small
    increments occurs (docs/theory/energy.md).

    References
    ----------
    LaBudde, Greenspan (1976), Energy and momentum conserving methods of arbitrary order for the numerical integration
    of equations of motion, Numer. Math. 25, 323-346 and 26, 1-16.

    Examples
    --------
    >>> EnergyMomentum()
    EnergyMomentum()
    """


SlabForce = Weighted | AverageField | DiscreteGradient | EnergyMomentum
