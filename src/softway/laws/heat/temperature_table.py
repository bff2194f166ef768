"""Values that depend on temperature: piecewise linear tables."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.units import Kelvin


@dataclass(frozen=True, slots=True, kw_only=True)
class TemperatureTable:
    """Positive value that is piecewise linear in the temperature, constant below the first and above the last one.

    Parameters
    ----------
    temperatures
        Increasing temperatures [K].
    values
        Positive values at them, in the unit of what they describe.

    Raises
    ------
    InputError
        If there is not one value for each temperature, temperatures do not increase, or a value is not positive.

    Examples
    --------
    >>> table = TemperatureTable(temperatures=(300.0, 400.0), values=(50.0, 40.0))
    >>> table.at(np.array([200.0, 350.0, 500.0])).tolist()
    [50.0, 45.0, 40.0]
    """

    temperatures: tuple[Kelvin, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.temperatures) != len(self.values) or not self.values:
            problem = f"{len(self.values)} values at {len(self.temperatures)} temperatures"
            raise InputError("values", problem, "one value for each temperature")
        above_zero = np.isfinite(self.temperatures).all() and min(self.temperatures) > 0.0
        if not above_zero or not (np.diff(self.temperatures) > 0.0).all():
            problem = f"{list(self.temperatures)} K are not positive and increasing"
            raise InputError("temperatures", problem, "increasing temperatures in kelvin")
        if not (np.isfinite(self.values).all() and min(self.values) > 0.0):
            raise InputError("values", f"{list(self.values)} are not all positive", "positive values")

    def at(self, temperature: Array) -> Array:
        """Value at temperatures (...) [K]."""
        return np.asarray(np.interp(temperature, self.temperatures, self.values))

    def slope(self, temperature: Array) -> Array:
        """Derivative of the value along the temperature [1/K], zero outside of the table; that of the right at a knot.

        Examples
        --------
        >>> TemperatureTable(temperatures=(300.0, 400.0), values=(50.0, 40.0)).slope(np.array([200.0, 350.0])).round(3)
        array([ 0. , -0.1])
        """
        slopes = np.diff(self.values) / np.diff(self.temperatures)
        return np.concatenate([[0.0], slopes, [0.0]])[np.searchsorted(self.temperatures, temperature, side="right")]


Value = float | TemperatureTable
"""A number, or a table over the temperature."""


def value_at(value: Value, temperature: Array) -> Array:
    """Value at temperatures (...) [K].

    Examples
    --------
    >>> value_at(2.0, np.array([300.0, 400.0])).tolist()
    [2.0, 2.0]
    """
    if isinstance(value, TemperatureTable):
        return value.at(temperature)
    return np.full(np.shape(temperature), float(value))


def slope_at(value: Value, temperature: Array) -> Array:
    """Derivative of the value along the temperature, at temperatures (...) [K].

    Examples
    --------
    >>> slope_at(2.0, np.array([300.0])).tolist()
    [0.0]
    """
    return value.slope(temperature) if isinstance(value, TemperatureTable) else np.zeros(np.shape(temperature))
