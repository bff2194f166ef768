"""Elastic moduli over the temperature: a smooth factor through the values of a table."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.laws.heat.temperature_table import TemperatureTable
from softway.units import Kelvin, Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class StiffnessTable:
    """Factor of the elastic moduli by the temperature, relative to those of the law.

    The factor has a continuous slope, since the entropy of an elastic strain is the slope times its energy.  It is the
    monotone piecewise cubic through the values, straight for two of them; beyond the table its logarithm goes on with
    the slope there.

    Parameters
    ----------
    temperatures
        Increasing temperatures [K].
    values
        Positive factors at them; one at the temperature at which the moduli of the law were measured.

    Raises
    ------
    InputError
        If there is not one value for each temperature, temperatures do not increase, or a value is not positive.

    References
    ----------
    Fritsch, Carlson (1980), Monotone piecewise cubic interpolation, SIAM J. Numer. Anal. 17, 238-246.

    Examples
    --------
    >>> table = StiffnessTable(temperatures=(300.0, 500.0), values=(1.0, 0.8))
    >>> table.curve().at(np.array([300.0, 400.0, 500.0])).round(12).tolist()
    [1.0, 0.9, 0.8]
    """

    temperatures: tuple[Kelvin, ...]
    values: tuple[Pure, ...]

    def __post_init__(self) -> None:
        TemperatureTable(temperatures=self.temperatures, values=self.values)

    def curve(self) -> "StiffnessCurve":
        """The factor as a function."""
        knots, values = np.array(self.temperatures), np.array(self.values)
        if len(knots) == 1:
            return StiffnessCurve(knots=knots, cubics=np.zeros((4, 0)), ends=np.array([[values[0], 0.0]] * 2))
        from scipy.interpolate import PchipInterpolator  # slow to load

        made = PchipInterpolator(knots, values)
        slopes = made.derivative()(knots[[0, -1]])
        return StiffnessCurve(knots=knots, cubics=made.c, ends=np.stack([values[[0, -1]], slopes], axis=1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StiffnessCurve:
    """Positive function of the temperature with a continuous slope.

    Parameters
    ----------
    knots
        (s,) temperatures [K].
    cubics
        (4, s - 1) coefficients of the pieces between them, from the third power of the distance to the lower knot on.
    ends
        (2, 2) value and slope at both ends [1, 1/K].

    Examples
    --------
    >>> curve = StiffnessTable(temperatures=(300.0, 500.0), values=(1.0, 0.8)).curve()
    >>> curve.at(np.array([600.0])).round(6).tolist(), curve.slope(np.array([400.0])).round(6).tolist()
    ([0.705998], [-0.001])
    """

    knots: Array
    cubics: Array
    ends: Array

    def at(self, temperature: Array) -> Array:
        """Factor (...) at temperatures (...) [K]."""
        return self._both(temperature)[0]

    def slope(self, temperature: Array) -> Array:
        """Derivative of the factor along the temperature (...) [1/K]."""
        return self._both(temperature)[1]

    def _both(self, temperature: Array) -> tuple[Array, Array]:
        """Factor and slope (...)."""
        inside = np.clip(temperature, self.knots[0], self.knots[-1])
        if len(self.knots) == 1:
            value, slope = np.full_like(inside, self.ends[0, 0]), np.zeros_like(inside)
        else:
            piece = np.minimum(np.searchsorted(self.knots, inside, side="right"), len(self.knots) - 1) - 1
            a, b, c, d = self.cubics[:, piece]
            x = inside - self.knots[piece]
            value, slope = ((a * x + b) * x + c) * x + d, (3.0 * a * x + 2.0 * b) * x + c
        with np.errstate(invalid="ignore", over="ignore"):
            grown = np.exp((temperature - inside) * slope / value)
        return np.asarray(value * grown), np.asarray(slope * grown)
