"""Heat across a contact: conductance where surfaces touch, gas and radiation in the gap, heat of friction."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive, real
from softway.units import Kelvin, Metre, Pascal, Pure, WattPerMetreKelvin, WattPerSquareMetreKelvin

STEFAN_BOLTZMANN = 5.670374419e-8
"""Constant of Stefan and Boltzmann [W/(m^2 K^4)] (CODATA 2018)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactHeat:
    """Heat across a contact of solids with each other or with a tool.

    Surfaces exchange heat where they touch or, with a gas or radiation, are nearer to each other than a facet is long.
    The heat flux from one surface to the other is the difference of their temperatures times the conductance: of the
    spots that touch, ``conductance (pressure/hardness)^exponent``; of the gas between the surfaces,
    ``gas/(gap + roughness)``; of radiation between open grey surfaces, ``emissivity sigma (T1^2 + T2^2)(T1 + T2)``.
    Friction heats both surfaces.

    Parameters
    ----------
    conductance
        Conductance of a closed contact [W/(m^2 K)]; with a ``hardness`` that at a pressure of this hardness.
    hardness
        Hardness of the softer surface [Pa]; by default the conductance does not depend on the pressure.
    exponent
        Exponent of the pressure.
    gas
        Conductivity of the gas between the surfaces [W/(m K)].
    roughness
        Distance of two surfaces that touch, as far as the gas is concerned [m]; positive with a gas.
    emissivity
        Effective emissivity of two open surfaces, ``1/(1/e1 + 1/e2 - 1)``, from zero to one.
    tool_temperature
        Temperature of the tool [K]; by default a tool takes no heat.
    share
        Share of the heat of friction that goes into the first body; by default that of its effusivity, the root of
        conductivity, density and capacity, in the sum of both.  With a tool: the share that goes into the solid, by
        default the whole.  A rigid body with a temperature shares like a solid.

    Raises
    ------
    InputError
        If a number is negative, a gas has no roughness, or a share or an emissivity is not between zero and one.

    Examples
    --------
    >>> rough = ContactHeat(conductance=2e5, hardness=1e9)
    >>> rough.closed(np.array([0.0, 1e9])).tolist()
    [0.0, 200000.0]
    >>> ContactHeat(gas=0.025, roughness=1e-5).through_gas(np.array([0.0, 1e-5])).round(9).tolist()
    [2500.0, 1250.0]

    References
    ----------
    Cooper, Mikic, Yovanovich (1969), Thermal contact conductance, Int. J. Heat Mass Transfer 12, 279-300: the pressure;
    Carslaw, Jaeger (1959), Conduction of heat in solids, 2.15: effusivities.
    """

    conductance: WattPerSquareMetreKelvin = 0.0
    hardness: Pascal | None = None
    exponent: Pure = 0.95
    gas: WattPerMetreKelvin = 0.0
    roughness: Metre = 0.0
    emissivity: Pure = 0.0
    tool_temperature: Kelvin | None = None
    share: Pure | None = None

    def __post_init__(self) -> None:
        for name in ("conductance", "gas", "roughness", "exponent"):
            value = getattr(self, name)
            real(value, name)
            if not 0.0 <= value < np.inf:
                raise InputError(name, f"{value:g}", "zero or a positive number")
        for name in ("hardness", "tool_temperature"):
            if getattr(self, name) is not None:
                positive(**{name: getattr(self, name)})
        for name in ("emissivity", "share"):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value <= 1.0:
                raise InputError(name, f"{value:g}", "a number from 0 to 1")
        if self.gas > 0.0 and self.roughness == 0.0:
            problem = "a gas between surfaces without roughness, whose conductance is infinite where they touch"
            raise InputError("roughness", problem, "the depth of the roughness, such as 1e-6 m")

    @property
    def crosses_gaps(self) -> bool:
        """True if heat passes between surfaces that do not touch."""
        return self.gas > 0.0 or self.emissivity > 0.0

    def closed(self, pressure: Array) -> Array:
        """Conductance [W/(m^2 K)] of a closed contact at mean pressures [Pa], without the gas."""
        if self.hardness is None:
            return np.full_like(pressure, self.conductance)
        return np.asarray(self.conductance * (np.maximum(pressure, 0.0) / self.hardness) ** self.exponent)

    def through_gas(self, gap: Array) -> Array:
        """Conductance [W/(m^2 K)] of the gas in gaps [m]."""
        return self.gas / (np.maximum(gap, 0.0) + self.roughness) if self.gas else np.zeros_like(gap)

    def radiated(self, one: Array, other: Array) -> Array:
        """Conductance [W/(m^2 K)] of radiation between surfaces of these temperatures [K]."""
        return self.emissivity * STEFAN_BOLTZMANN * (one**2 + other**2) * (one + other)
