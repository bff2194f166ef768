"""Conduction of heat by Fourier's law, with a capacity and the latent heat of melting."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive, real
from softway.laws.heat.temperature_table import TemperatureTable, Value, slope_at, value_at
from softway.units import JoulePerKilogram, JoulePerKilogramKelvin, Kelvin, KelvinDifference, WattPerMetreKelvin


@dataclass(frozen=True, slots=True, kw_only=True)
class Latent:
    """Latent heat of melting, at one temperature or over a mushy range around it.

    Parameters
    ----------
    heat
        Heat of melting [J/kg], positive.
    melting
        Temperature of melting [K]; matter at this very temperature is solid at the start of a march.
    half_range
        Half of the mushy range, over which the liquid share grows linearly [K]; zero for a sharp front.
    liquid
        Conduction in the liquid; as in the solid by default.

    Raises
    ------
    InputError
        If the heat is not positive, the mushy range is negative or reaches down to 0 K, or the liquid melts again.

    Examples
    --------
    >>> Latent(heat=338e3, melting=273.15).half_range
    0.0
    """

    heat: JoulePerKilogram
    melting: Kelvin
    half_range: KelvinDifference = 0.0
    liquid: "Conduction | None" = None

    def __post_init__(self) -> None:
        positive(heat=self.heat, melting=self.melting)
        if not 0.0 <= self.half_range < self.melting:
            problem = f"{self.half_range:g} K around {self.melting:g} K"
            raise InputError("half_range", problem, "zero, or less than the temperature of melting")
        if self.liquid is not None and self.liquid.latent is not None:
            raise InputError("liquid.latent", "a liquid that melts", "omit it")


@dataclass(frozen=True, slots=True, kw_only=True)
class Conduction:
    """Fourier's law: the heat flux is the conductivity times the fall of the temperature.

    Parameters
    ----------
    conductivity
        A number, a number for each axis of space (orthotropic), or a table over the temperature [W/(m K)].
    capacity
        Specific heat, a number or a table over the temperature [J/(kg K)].
    latent
        Latent heat of melting; none by default.

    Raises
    ------
    InputError
        If a value is not positive.

    References
    ----------
    Carslaw and Jaeger (1959), Conduction of Heat in Solids, chapters I and XI.

    Examples
    --------
    >>> steel = Conduction(conductivity=50.0, capacity=500.0)
    >>> round(steel.conductivity / (7800.0 * steel.capacity), 8)
    1.282e-05
    """

    conductivity: Annotated[Value | tuple[WattPerMetreKelvin, ...], "W/(m K)"]
    capacity: Annotated[JoulePerKilogramKelvin | TemperatureTable, "J/(kg K)"]
    latent: Latent | None = None

    def __post_init__(self) -> None:
        values = self.conductivity if isinstance(self.conductivity, tuple) else (self.conductivity,)
        if not 1 <= len(values) <= 3:
            raise InputError("conductivity", f"{len(values)} numbers", "a number for each axis of space")
        for name, given in (*(("conductivity", value) for value in values), ("capacity", self.capacity)):
            if not isinstance(given, TemperatureTable):
                real(given, name)
                positive(**{name: given})

    @property
    def liquid(self) -> "Conduction":
        """Conduction in the liquid; the law itself where the liquid has no other."""
        return self if self.latent is None or self.latent.liquid is None else self.latent.liquid

    @property
    def constant(self) -> bool:
        """True if conductivity and capacity are numbers, and nothing melts."""
        return self.latent is None and not any(
            isinstance(value, TemperatureTable) for value in (self.conductivity, self.capacity)
        )

    @property
    def greatest_conductivity(self) -> float:
        """Greatest conductivity along an axis at any temperature [W/(m K)].

        Examples
        --------
        >>> Conduction(conductivity=(2.0, 1.0), capacity=1.0).greatest_conductivity
        2.0
        """
        values = self.conductivity if isinstance(self.conductivity, tuple) else (self.conductivity,)
        return max(max(v.values) if isinstance(v, TemperatureTable) else float(v) for v in values)

    def effusivity(self, density: float, temperature: float = 293.15) -> float:
        """Root of conductivity, density [kg/m^3] and capacity at a temperature [K], in W s^(1/2)/(m^2 K).

        It is the mean of the axes for an orthotropic conductivity.

        Examples
        --------
        >>> round(Conduction(conductivity=50.0, capacity=500.0).effusivity(8000.0), 6)
        14142.135624
        """
        at = np.array([temperature])
        k, _ = self.along_axes(at, len(self.conductivity) if isinstance(self.conductivity, tuple) else 1)
        return float(np.sqrt(k.mean() * density * value_at(self.capacity, at)[0]))

    def along_axes(self, temperature: Array, axes: int) -> tuple[Array, Array]:
        """Conductivities (..., axes) [W/(m K)] at temperatures (...) [K], and their derivatives [W/(m K^2)].

        Raises
        ------
        InputError
            If there are numbers for another number of axes.

        Examples
        --------
        >>> Conduction(conductivity=(2.0, 1.0), capacity=1.0).along_axes(np.array(300.0), 2)[0].tolist()
        [2.0, 1.0]
        """
        values = self.conductivity if isinstance(self.conductivity, tuple) else (self.conductivity,) * axes
        if len(values) != axes:
            problem = f"{len(values)} numbers in elements along {axes} axes"
            raise InputError("conductivity", problem, "one number, or one for each axis; one number in bars")
        k = [value_at(value, temperature) for value in values]
        slopes = [slope_at(value, temperature) for value in values]
        return np.stack(k, axis=-1), np.stack(slopes, axis=-1)
