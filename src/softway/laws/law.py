"""What a law must say about itself: one that stores energy, and one with a history."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from softway.laws.measure import Measure
from softway.laws.rates import Rate
from softway.typing import Array


@runtime_checkable
class StoredEnergy(Protocol):
    """A material that stores energy per reference volume, ``W(E)``.

    The law names the strain it is written in by ``measure``: :class:`~softway.laws.measure.Green` for large
    deformations, :class:`~softway.laws.measure.Small` for the linear theory.  A law written in Green's strain is
    frame-indifferent by construction, and a strain (unlike F) keeps all its digits when it is small.  Methods work on
    trailing axes: E may have any shape (..., 3, 3), symmetric.  Where matter is inverted the energy is infinite and the
    stress ``nan``, quietly: callers test for finiteness.
    """

    @property
    def measure(self) -> Measure:
        """The strain E of this law."""
        ...

    @property
    def linear(self) -> bool:
        """Whether the force on a body is linear in its displacement."""
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
    """What happens to matter in one slab, in axes that are carried along with it; any leading axes.

    Parameters
    ----------
    stress
        (..., 3, 3) Cauchy stress at the start [Pa].
    memory
        What the law remembers from the start, by the names of :meth:`RateLaw.virgin`.
    strain
        (..., 3, 3) increment of the strain: the rate of deformation times the length of the slab.
    span
        Length of the slab [s].
    """

    stress: Array
    memory: Mapping[str, Array]
    strain: Array
    span: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Response:
    """What matter answers to an :class:`Increment`.

    Parameters
    ----------
    stress
        (..., 3, 3) Cauchy stress at the end [Pa].
    memory
        What the law remembers from then on.
    stored, dissipated
        (...,) energies per present volume taken up in the slab [J/m^3]; what is dissipated is never negative.
    viscous
        (..., 3, 3) part of the stress that is made by the mean rate of the slab [Pa]; None where there is none.
    """

    stress: Array
    memory: Mapping[str, Array]
    stored: Array
    dissipated: Array
    viscous: Array | None = None


@runtime_checkable
class RateLaw(Protocol):
    """A material with a history, written in axes that are carried along: the strain of a slab in, the stress out.

    A law sees components in the axes of its ``rate``, never a rotation: stresses and every (..., 3, 3) array of its
    memory are brought into these axes before it is asked, and carried on afterwards.  Methods work on trailing axes.
    """

    @property
    def rate(self) -> Rate:
        """The objective rate."""
        ...

    def virgin(self, points: int) -> Mapping[str, Array]:
        """What matter remembers before anything happened: arrays (points, ...) by name."""
        ...

    def respond(self, increment: Increment) -> Response:
        """Stress at the end of the slab, memory, and energies."""
        ...

    def moduli(self, increment: Increment) -> Array:
        """Derivative of the stress at the end to the strain of the slab, (..., 3, 3, 3, 3) [Pa], minor symmetry."""
        ...

    def elastic_moduli(self) -> Array:
        """Moduli (3, 3, 3, 3) that the fastest waves meet [Pa]."""
        ...


@runtime_checkable
class Viscous(Protocol):
    """A :class:`RateLaw` whose stress is a viscosity, itself a function of the rate, times the rate."""

    def secant(self, increment: Increment) -> Array:
        """Moduli (..., 3, 3, 3, 3) with the viscosity held fixed [Pa]."""
        ...


@runtime_checkable
class Damped(Protocol):
    """A :class:`RateLaw` a part of whose stress is made by the mean rate of the slab: ``Response.viscous``."""

    def viscous_moduli(self, increment: Increment) -> Array:
        """Derivative of that part to the strain of the slab, (..., 3, 3, 3, 3) [Pa]."""
        ...


Material = StoredEnergy | RateLaw


def initial_moduli(material: Material) -> Array:
    """Moduli (3, 3, 3, 3) of the first small strain [Pa].

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> float(initial_moduli(LinearElastic(E=1.0))[0, 0, 0, 0])
    1.0
    """
    return material.elastic_moduli() if isinstance(material, RateLaw) else material.tangent(np.zeros((3, 3)))
