"""Protocols of material laws: laws with a stored energy, and laws with a history."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from softway.arrays import Array
from softway.laws.objective_rates import Rate
from softway.laws.strain_measures import Measure


@runtime_checkable
class StoredEnergy(Protocol):
    """Material law with a stored energy per reference volume, ``W(E)``.

    ``measure`` names the strain of the law: :class:`~softway.laws.strain_measures.Green` for large deformations,
    :class:`~softway.laws.strain_measures.Small` for the linear theory.  A law in Green's strain is frame-indifferent by
    construction, and a small strain (unlike F) has full accuracy.  Methods work on trailing axes: E may have any shape
    (..., 3, 3), symmetric.  Where the material is inverted, the energy is infinite and the stress is ``nan``, without a
    warning: callers test for finite values.
    """

    @property
    def measure(self) -> Measure:
        """Strain measure of the law."""
        ...

    @property
    def linear(self) -> bool:
        """True if the force on a body is linear in its displacement."""
        ...

    def energy(self, E: Array) -> Array:
        """Stored energy per reference volume W, (...,) [J/m^3]."""
        ...

    def stress(self, E: Array) -> Array:
        """Stress ``S = dW/dE`` (second Piola-Kirchhoff for Green's strain), (..., 3, 3) [Pa]."""
        ...

    def tangent(self, E: Array) -> Array:
        """Moduli ``dS_ij/dE_kl``, (..., 3, 3, 3, 3) [Pa], with minor and major symmetry."""
        ...

    def wave_speed(self, density: float) -> float:
        """Speed of dilatational waves in the undeformed volume [m/s]; ``density`` [kg/m^3]."""
        ...

    def youngs(self) -> float:
        """Young's modulus of the undeformed material [Pa]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Increment:
    """Strain increment of one slab (time step) and the state at its start, in axes carried along with the material.

    The arrays may have any leading axes.

    Parameters
    ----------
    stress
        (..., 3, 3) Cauchy stress at the start [Pa].
    memory
        History variables at the start, by the names of :meth:`RateLaw.virgin`.
    strain
        (..., 3, 3) strain increment: rate of deformation times length of the slab.
    span
        Length of the slab [s].
    temperature
        (...,) temperature in the middle of the slab [K], for laws with a softening; None for other laws.
    stiffness
        (...,) factor of the moduli at the end of the slab, see :class:`Scalable`; None for one.
    """

    stress: Array
    memory: Mapping[str, Array]
    strain: Array
    span: float
    temperature: Array | None = None
    stiffness: Array | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Response:
    """Response of a law to an :class:`Increment`.

    Parameters
    ----------
    stress
        (..., 3, 3) Cauchy stress at the end [Pa].
    memory
        History variables at the end.
    stored, dissipated
        (...,) energies per current volume stored and dissipated in the slab [J/m^3]; ``dissipated`` is never negative.
    viscous
        (..., 3, 3) part of the stress due to the mean strain rate of the slab [Pa]; None if there is none.
    """

    stress: Array
    memory: Mapping[str, Array]
    stored: Array
    dissipated: Array
    viscous: Array | None = None


@runtime_checkable
class RateLaw(Protocol):
    """Path-dependent material law (with a history), which computes the stress from the strain increment of a slab.

    A law works with components in the axes of its ``rate`` and never sees a rotation.  Stresses and all (..., 3, 3)
    history variables are transformed to these axes before a call, and carried on with the material afterwards.
    Methods work on trailing axes.
    """

    @property
    def rate(self) -> Rate:
        """Objective rate of the stress."""
        ...

    def virgin(self, points: int) -> Mapping[str, Array]:
        """History variables of the undeformed material: arrays (points, ...) by name."""
        ...

    def respond(self, increment: Increment) -> Response:
        """Stress and history variables at the end of the slab, and energies."""
        ...

    def moduli(self, increment: Increment) -> Array:
        """Derivative of the stress at the end by the strain increment, (..., 3, 3, 3, 3) [Pa], with minor symmetry."""
        ...

    def elastic_moduli(self) -> Array:
        """Moduli (3, 3, 3, 3) that determine the fastest waves [Pa]."""
        ...


@runtime_checkable
class Viscous(Protocol):
    """:class:`RateLaw` with a stress that is a rate-dependent viscosity times the strain rate."""

    def secant(self, increment: Increment) -> Array:
        """Moduli (..., 3, 3, 3, 3) with the viscosity held fixed [Pa]."""
        ...


@runtime_checkable
class Damped(Protocol):
    """:class:`RateLaw` with a viscous part of the stress, ``Response.viscous``, due to the mean strain rate."""

    def viscous_moduli(self, increment: Increment) -> Array:
        """Derivative of the viscous part by the strain increment, (..., 3, 3, 3, 3) [Pa]."""
        ...


@runtime_checkable
class Scalable(Protocol):
    """:class:`RateLaw` whose moduli may have a factor m that depends on the temperature, ``Increment.stiffness``.

    Stress, history variables and stored energy remain those of m = 1: the solid multiplies them by m.  A stress that
    the law limits, such as a flow stress, is therefore divided by m.  ``Response.viscous`` has no factor, in the stress
    of :meth:`RateLaw.respond`, too; only moduli of it, :meth:`Damped.viscous_moduli` and their part of
    :meth:`RateLaw.moduli`, are divided by m.
    """

    def dissipation_factor(self, before: Array, after: Array) -> Array:
        """Factor (...) of the dissipated energy of :meth:`RateLaw.respond`, from those (...) of the moduli at the start
        of the slab and at its end, ``Increment.stiffness``; not negative.
        """
        ...


Material = StoredEnergy | RateLaw


def softens(material: Material) -> bool:
    """True for a law that needs the temperature of the solid: one with an attribute ``softening`` that is not None.

    Examples
    --------
    >>> from softway.laws.bulk import J2
    >>> softens(J2(E=1.0, nu=0.0, yield_stress=0.1))
    False
    """
    return isinstance(material, RateLaw) and getattr(material, "softening", None) is not None


def initial_moduli(material: Material) -> Array:
    """Moduli (3, 3, 3, 3) of the undeformed material [Pa].

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> float(initial_moduli(LinearElastic(E=1.0))[0, 0, 0, 0])
    1.0
    """
    return material.elastic_moduli() if isinstance(material, RateLaw) else material.tangent(np.zeros((3, 3)))
