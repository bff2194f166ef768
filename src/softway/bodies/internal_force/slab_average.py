"""Rules for the average of the internal force over a time step (slab).

:meth:`~softway.bodies.internal_force.body_force.BodyForce.slab_average` computes the averages along the chord.
"""

from dataclasses import dataclass

from softway.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Weighted:
    """Weighted sum of the force at the peaks of the time weight of the slab: ``sum_p w_p f(x(tau_p))``.

    Examples
    --------
    >>> Weighted()
    Weighted()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class AverageField:
    """Average of the force along the chord: ``int_0^1 f(u0 + s (u1 - u0)) ds`` by Gauss points.

    The work ``f . (u1 - u0)`` equals the change of the stored energy up to the quadrature.  Two points are exact for
    an energy of fourth degree in the displacement (St. Venant-Kirchhoff).

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
            raise InputError("points", f"{self.points} Gauss points give no average", "1 or more")


@dataclass(frozen=True, slots=True, kw_only=True)
class DiscreteGradient:
    """Discrete gradient of Gonzalez at every quadrature point.

    The work equals the change of the stored energy up to rounding.

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
    """Force of the virtual time function, with a correction that keeps the balance of energy and angular momentum.

    The correction is a force ``M (b x (x - centre))`` that turns every body about its centre of mass.  The vector b,
    one for each group of touching bodies, is chosen so that the internal forces and the contact forces between the
    bodies have no resulting moment.  No quotient of small increments occurs (docs/theory/contact/energy.md).

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
