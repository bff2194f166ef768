"""Materials: constants, their sources, and the laws made from them."""

from dataclasses import dataclass
from typing import Annotated, Literal

from softway.errors import InputError
from softway.laws.bulk import J2, LinearElastic, LinearOrthotropic, MooneyRivlin, NeoHookean
from softway.laws.heat.conduction import Conduction, Latent
from softway.laws.law import Material as Law
from softway.laws.plasticity.hardening import LinearHardening, PowerHardening
from softway.laws.plasticity.rate_dependence import JohnsonCook, RateIndependent
from softway.laws.plasticity.softening import JohnsonCookSoftening
from softway.laws.strain_measures import Green
from softway.units import JoulePerKilogram, Kelvin, KilogramPerCubicMetre, Pascal, Pure

LawName = Literal["elastic", "linear", "plastic"]
ROOM = 298.0
"""Temperature at which the flow stress of the library is given [K]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Isotropic:
    """Young's modulus and Poisson's ratio."""

    E: Pascal
    nu: Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Rubber:
    """Mooney constants and bulk modulus."""

    c10: Pascal
    c01: Pascal
    bulk: Pascal


@dataclass(frozen=True, slots=True, kw_only=True)
class Orthotropic:
    """Constants of :class:`~softway.laws.bulk.LinearOrthotropic`; axes of wood: along the grain, radial, tangential."""

    E: tuple[Pascal, Pascal, Pascal]
    nu: tuple[Pure, Pure, Pure]
    G: tuple[Pascal, Pascal, Pascal]


@dataclass(frozen=True, slots=True, kw_only=True)
class Strength:
    """Flow stress ``(A + B p^n)(1 + C ln(rate/(1/s)))(1 - T*^m)`` of Johnson and Cook in tension.

    A is the yield stress; ``T* = (T - 298 K)/(melting - 298 K)``.  If only A is known, the others keep their defaults.
    """

    A: Pascal
    B: Pascal = 0.0
    n: Pure = 1.0
    C: Pure = 0.0
    m: Pure | None = None
    melting: Kelvin | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ThermalConstants:
    """Conductivity [W/(m K)], heat capacity [J/(kg K)] and linear expansion [1/K] near 20 degrees Celsius; temperature
    of melting, of alloys that at which it begins or that of the flow stress, and latent heat of melting.
    """

    conductivity: Annotated[float, "W/(m K)"] | None = None
    capacity: Annotated[float, "J/(kg K)"] | None = None
    expansion: Annotated[float, "1/K"] | None = None
    melting: Kelvin | None = None
    latent: JoulePerKilogram | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """Constants of a material at room temperature.

    Parameters
    ----------
    name, aliases
        Name and alternative names.
    density
        Density [kg/m^3].
    moduli
        Elastic constants.
    strength
        Flow stress, if the material yields and its yield stress is known.
    thermal
        Thermal constants, if known.
    source
        Source of the constants.
    note
        Conditions for which the constants are valid.

    Examples
    --------
    >>> from softway.laws.materials import find
    >>> find("steel S235").elastic()
    NeoHookean(E=210000000000.0, nu=0.3)
    """

    name: str
    density: KilogramPerCubicMetre
    moduli: Isotropic | Rubber | Orthotropic
    source: str
    aliases: tuple[str, ...] = ()
    strength: Strength | None = None
    thermal: ThermalConstants | None = None
    note: str = ""

    def elastic(self) -> NeoHookean | MooneyRivlin | LinearOrthotropic:
        """Elastic law for any rotation: neo-Hookean, Mooney-Rivlin, or orthotropic in Green's strain."""
        match self.moduli:
            case Isotropic(E=E, nu=nu):
                return NeoHookean(E=E, nu=nu)
            case Rubber(c10=c10, c01=c01, bulk=bulk):
                return MooneyRivlin(c10=c10, c01=c01, bulk=bulk)
            case Orthotropic(E=E3, nu=nu3, G=G):
                return LinearOrthotropic(E=E3, nu=nu3, G=G, measure=Green())

    def linear(self) -> LinearElastic | LinearOrthotropic:
        """Elastic law for small strains and rotations."""
        match self.moduli:
            case Isotropic(E=E, nu=nu):
                return LinearElastic(E=E, nu=nu)
            case Rubber(bulk=bulk):
                E = self.elastic().youngs()
                return LinearElastic(E=E, nu=0.5 - E / (6.0 * bulk))
            case Orthotropic(E=E3, nu=nu3, G=G):
                return LinearOrthotropic(E=E3, nu=nu3, G=G)

    def plastic(self, softening: bool = False) -> J2:
        """J2 plasticity with the hardening and the rate dependence of Johnson and Cook, at room temperature.

        With ``softening`` the flow stress falls with the temperature of the solid, if its melting and m are known.

        Raises
        ------
        InputError
            If the material does not yield, or its yield stress is not known.
        """
        if self.strength is None or not isinstance(self.moduli, Isotropic):
            raise InputError("law", f"{self.name!r} has no yield stress in the library", "elastic or linear")
        given = self.strength
        return J2(
            E=self.moduli.E,
            nu=self.moduli.nu,
            yield_stress=given.A,
            hardening=PowerHardening(modulus=given.B, exponent=given.n) if given.B else LinearHardening(),
            flow=JohnsonCook(C=given.C) if given.C else RateIndependent(),
            softening=self._softening() if softening else None,
        )

    def _softening(self) -> JohnsonCookSoftening | None:
        """Third factor of Johnson and Cook; None if its constants are not known."""
        given = self.strength
        if given is None or given.m is None or given.melting is None:
            return None
        return JohnsonCookSoftening(reference=ROOM, melting=given.melting, exponent=given.m)

    def conduction(self, latent: bool = False) -> Conduction:
        """Law of heat conduction; with the ``latent`` heat of melting for bodies that do not move.

        The coefficient of linear expansion is ``thermal.expansion``.

        Raises
        ------
        InputError
            If one of the constants is not known.

        Examples
        --------
        >>> from softway.laws.materials import find
        >>> find("copper OFHC").conduction().capacity
        383.0
        """
        known = self.thermal or ThermalConstants()
        needed = ("conductivity", "capacity", *(("melting", "latent") if latent else ()))
        values = [getattr(known, name) for name in needed]
        for name, value in zip(needed, values, strict=True):
            if value is None:
                problem = f"{self.name!r} has no {name} in the library"
                raise InputError("law", problem, "the law = { conductivity = ..., capacity = ... }")
        melts = Latent(melting=values[2], heat=values[3]) if latent else None
        return Conduction(conductivity=values[0], capacity=values[1], latent=melts)

    def law(self, name: LawName = "elastic", softening: bool = False) -> Law:
        """Law of the material with a given name; the plastic one with ``softening``, see :meth:`plastic`."""
        match name:
            case "elastic":
                return self.elastic()
            case "linear":
                return self.linear()
            case "plastic":
                return self.plastic(softening)
