"""Thermal softening: factor of the flow stress or of the viscosity by the temperature."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive
from softway.laws.heat.temperature_table import TemperatureTable
from softway.units import Kelvin, KelvinDifference, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class JohnsonCookSoftening:
    """Factor ``1 - T*^m`` with ``T* = (T - reference)/(melting - reference)``, from one at the reference to zero.

    Parameters
    ----------
    reference
        Temperature at which the flow stress was measured [K]; below it the factor is one.
    melting
        Temperature of melting [K], above the reference; from it on there is no strength.
    exponent
        Exponent m, positive.

    Raises
    ------
    InputError
        If the reference or the exponent is not positive, or melting is not above the reference.

    References
    ----------
    Johnson, Cook (1983), Proc. 7th Int. Symp. Ballistics, 541-547.

    Examples
    --------
    >>> JohnsonCookSoftening(reference=300.0, melting=1300.0).at(np.array([200.0, 300.0, 800.0, 2000.0])).tolist()
    [1.0, 1.0, 0.5, 0.0]
    """

    reference: Kelvin
    melting: Kelvin
    exponent: Pure = 1.0

    def __post_init__(self) -> None:
        positive(reference=self.reference, exponent=self.exponent)
        if not self.reference < self.melting < np.inf:
            problem = f"{self.melting:g} K is not above the reference of {self.reference:g} K"
            raise InputError("melting", problem, "the temperature of melting, such as 1356 K")

    def at(self, temperature: Array) -> Array:
        """Factor at temperatures (...) [K]."""
        share = (temperature - self.reference) / (self.melting - self.reference)
        return np.asarray(1.0 - np.clip(share, 0.0, 1.0) ** self.exponent)


@dataclass(frozen=True, slots=True, kw_only=True)
class Arrhenius:
    """Factor ``exp(A (1/T - 1/reference))``: thermally activated flow, one at the reference.

    Parameters
    ----------
    activation
        Temperature A = m Q/R [K], not negative, with the activation energy Q [J/mol] of the strain rate, the rate
        sensitivity m of the stress and the gas constant R.
    reference
        Temperature for which consistency or flow stress are given [K], positive.

    Raises
    ------
    InputError
        If the activation is negative, or the reference is not positive.

    References
    ----------
    Zener, Hollomon (1944), Effect of strain rate upon plastic flow of steel, J. Appl. Phys. 15, 22-32.

    Examples
    --------
    >>> Arrhenius(activation=6000.0, reference=1200.0).at(np.array([1200.0, 1500.0])).round(6).tolist()
    [1.0, 0.367879]
    """

    activation: KelvinDifference
    reference: Kelvin

    def __post_init__(self) -> None:
        positive(reference=self.reference)
        if not 0.0 <= self.activation < np.inf:
            raise InputError("activation", f"{self.activation:g} K", "m Q/R, such as 6000 K for hot steel")

    def at(self, temperature: Array) -> Array:
        """Factor at temperatures (...) [K]."""
        return np.asarray(np.exp(self.activation * (1.0 / temperature - 1.0 / self.reference)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SofteningTable:
    """Factor that is piecewise linear in the temperature, constant below the first and above the last one.

    Parameters
    ----------
    temperatures
        Increasing temperatures [K].
    values
        Positive factors at them.

    Raises
    ------
    InputError
        If there is not one value for each temperature, temperatures do not increase, or a value is not positive.

    Examples
    --------
    >>> SofteningTable(temperatures=(300.0, 900.0), values=(1.0, 0.5)).at(np.array([200.0, 600.0])).tolist()
    [1.0, 0.75]
    """

    temperatures: tuple[Kelvin, ...]
    values: tuple[Pure, ...]

    def __post_init__(self) -> None:
        TemperatureTable(temperatures=self.temperatures, values=self.values)

    def at(self, temperature: Array) -> Array:
        """Factor at temperatures (...) [K]."""
        return TemperatureTable(temperatures=self.temperatures, values=self.values).at(temperature)


Softening = JohnsonCookSoftening | Arrhenius | SofteningTable
"""Factor by the temperature."""


def factor(softening: Softening | None, temperature: Array | None) -> Array | None:
    """Factor (...) at temperatures (...) [K]; None without softening, or without temperature: that of the reference.

    Examples
    --------
    >>> factor(SofteningTable(temperatures=(300.0, 400.0), values=(1.0, 0.5)), np.array([350.0])).tolist()
    [0.75]
    """
    return None if softening is None or temperature is None else softening.at(temperature)


def greatest_factor(softening: Softening | None) -> float:
    """Greatest factor at any temperature.

    Examples
    --------
    >>> greatest_factor(SofteningTable(temperatures=(300.0, 400.0), values=(1.2, 0.8)))
    1.2
    """
    match softening:
        case SofteningTable():
            return max(softening.values)
        case Arrhenius():
            return float("inf")
    return 1.0
