"""What a hyperelastic law must say about itself."""

from typing import Protocol

from softway.laws.measure import Measure
from softway.typing import Array


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
