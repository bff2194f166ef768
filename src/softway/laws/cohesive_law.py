"""Cohesive law of a surface that breaks: linear softening from a strength to an opening without force."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive
from softway.units import JoulePerSquareMetre, Pascal, PascalPerMetre, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class BilinearCohesive:
    """Bilinear cohesive law with mixed mode by Benzeggagh and Kenane.

    The traction is ``(1 - damage) stiffness jump``.  It grows up to the strength, then falls linearly with the opening,
    and the work up to the break is the fracture energy of the mode.  The damage never heals, and an opening below the
    greatest one so far unloads towards the origin.  Compression is elastic and does not damage.

    Parameters
    ----------
    strength
        Greatest traction of mode I, by opening.
    energy
        Fracture energy of mode I.
    stiffness
        Stiffness of the intact surface in every direction.  It is a property of the glue, such as its modulus over its
        thickness.
    shear_strength
        Greatest traction of mode II, by sliding; that of mode I by default.
    shear_energy
        Fracture energy of mode II; that of mode I by default.
    exponent
        Exponent of Benzeggagh and Kenane for the modes between.

    Raises
    ------
    InputError
        If a number is not positive, or a strength asks for more energy on the way up than the fracture energy.

    References
    ----------
    Benzeggagh, Kenane (1996), Compos. Sci. Technol. 56, 439-449; Camanho, Davila (2002), NASA/TM-2002-211737; Turon,
    Camanho, Costa, Davila (2006), Mech. Mater. 38, 1072-1089.

    Examples
    --------
    >>> law = BilinearCohesive(strength=2.0, energy=3.0, stiffness=10.0)
    >>> law.damage(np.array([0.1, 0.2, 3.1]), np.zeros(3)).round(12)
    array([0., 0., 1.])
    """

    strength: Pascal
    energy: JoulePerSquareMetre
    stiffness: PascalPerMetre
    shear_strength: Pascal | None = None
    shear_energy: JoulePerSquareMetre | None = None
    exponent: Pure = 2.0

    def __post_init__(self) -> None:
        positive(strength=self.strength, energy=self.energy, stiffness=self.stiffness, exponent=self.exponent)
        if self.shear_strength is not None:
            positive(shear_strength=self.shear_strength)
        if self.shear_energy is not None:
            positive(shear_energy=self.shear_energy)
        for strength, energy, name in ((*self.opening, "energy"), (*self.sliding, "shear_energy")):
            least = 0.5 * strength**2 / self.stiffness
            if energy <= least:
                problem = (
                    f"{energy:.3g} J/m^2 is not above the {least:.3g} J/m^2 stored at the strength {strength:.3g} Pa"
                )
                stiffer = f"{strength**2 / energy:.3g} Pa/m"
                raise InputError(name, problem, f"a lower strength, or a stiffness such as {stiffer}")

    @property
    def opening(self) -> tuple[float, float]:
        """Strength [Pa] and fracture energy [J/m^2] of mode I."""
        return self.strength, self.energy

    @property
    def sliding(self) -> tuple[float, float]:
        """Strength [Pa] and fracture energy [J/m^2] of mode II."""
        strength = self.strength if self.shear_strength is None else self.shear_strength
        return strength, self.energy if self.shear_energy is None else self.shear_energy

    def toughness(self, mode: Array) -> Array:
        """Fracture energy (m,) [J/m^2] at the share of sliding ``mode`` (m,) in the energy: 0 mode I, 1 mode II."""
        return np.asarray(self.energy + (self.sliding[1] - self.energy) * mode**self.exponent)

    def openings(self, mode: Array) -> tuple[Array, Array]:
        """Openings (m,) at which damage begins and ends [m], at the share of sliding ``mode`` (m,)."""
        ends = self.strength**2, self.sliding[0] ** 2
        first = np.sqrt(ends[0] + (ends[1] - ends[0]) * mode**self.exponent) / self.stiffness
        return first, 2.0 * self.toughness(mode) / (self.stiffness * first)

    def damage(self, opening: Array, mode: Array) -> Array:
        """Damage (m,) at the greatest ``opening`` (m,) [m]: zero intact, one broken."""
        first, last = self.openings(mode)
        grown = last * (opening - first) / (np.maximum(opening, first) * (last - first))
        return np.clip(grown, 0.0, 1.0)

    def slope(self, opening: Array, mode: Array) -> Array:
        """Derivative (m,) of :meth:`damage` by the opening [1/m]."""
        first, last = self.openings(mode)
        inside = (opening > first) & (opening < last)
        return np.where(inside, last * first / (np.where(inside, opening, 1.0) ** 2 * (last - first)), 0.0)

    def dissipated(self, damage: Array, mode: Array) -> Array:
        """Energy (m,) dissipated up to the ``damage`` (m,) [J/m^2]; the fracture energy at one.

        The dissipation grows linearly with the opening, from zero where damage begins.
        """
        first, last = self.openings(mode)
        return self.toughness(mode) * damage / (1.0 + (1.0 - damage) * (last / first - 1.0))
