"""Conversion of quantities: text such as ``"210 GPa"`` becomes an SI float; errors name the place."""

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from softway.errors import InputError

if TYPE_CHECKING:
    import pint

_NUMBER = re.compile(r"^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")
_EXAMPLES = {
    "m": ("a length", "5 mm"),
    "m^2": ("an area", "314 mm^2"),
    "s": ("a time", "2 ms"),
    "Pa": ("a stress", "210 GPa"),
    "kg/m^3": ("a density", "7850 kg/m^3"),
    "Pa s": ("a viscosity", "0.1 Pa s"),
    "m/s": ("a velocity", "4.4 m/s"),
    "m/s^2": ("an acceleration", "-9.81 m/s^2"),
    "1/s": ("a velocity gradient", "2 1/s"),
    "rad": ("an angle", "30 deg"),
    "rad/s": ("an angular velocity", "60 rpm"),
    "N": ("a force", "2 kN"),
    "K": ("a temperature", "20 degC"),
    "1/K": ("a coefficient of expansion", "12e-6 1/K"),
    "kelvin": ("a difference of temperatures", "0.5 K"),
    "W/(m K)": ("a conductivity", "50 W/(m*K)"),
    "W/m^2": ("a heat flux", "10 kW/m^2"),
    "W/(m^2 K)": ("a coefficient of heat transfer", "20 W/(m^2*K)"),
    "W/m^3": ("a power per volume", "1 MW/m^3"),
    "J/kg": ("a heat per mass", "338 kJ/kg"),
    "J/(kg K)": ("a specific heat", "4.2 kJ/(kg*K)"),
    "": ("a pure number", "0.3"),
}


@dataclass(frozen=True, slots=True)
class Units:
    """Converter of quantities, based on the unit registry of pint.

    Examples
    --------
    >>> units = Units.standard()
    >>> units.number("210 GPa", "Pa", "bodies.bar.material.E")
    210000000000.0
    >>> units.number(7850, "kg/m^3", "bodies.bar.density")
    7850.0
    """

    registry: "pint.UnitRegistry[Any]"

    @classmethod
    def standard(cls) -> Self:
        """Converter with the standard units of pint."""
        import pint  # slow to load

        return cls(pint.UnitRegistry())

    def number(self, value: object, unit: str, where: str) -> float:
        """SI value of a number or of a text with a unit.

        Parameters
        ----------
        value
            A bare number (SI), or text such as ``"5 mm"``.
        unit
            SI unit to which the value must be convertible; empty for pure numbers.
        where
            Path in the scenario for error messages.
        """
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            raise InputError(where, f"{value!r} is not {expected(unit)}", example(unit))
        if not isinstance(value, str):
            return _finite(_real(value), value, where, unit)
        found = _NUMBER.match(value)
        if found is None:
            raise InputError(where, f"{value!r} is not {expected(unit)}", example(unit))
        factor, zero = self._scale(found[2], unit, value, where)
        number = float(found[1]) * factor
        if zero and not number + zero > 0.0:
            coldest = f"{-zero / factor:g} {found[2]}"
            raise InputError(where, f"{value!r} is not above absolute zero", f"a temperature above {coldest}")
        return _finite(number + zero if zero else number, value, where, unit)

    def _scale(self, given: str, unit: str, value: str, where: str) -> tuple[float, float]:
        """Factor from the given unit to the SI unit, and value of its zero: that of a temperature in degC is 273.15."""
        if given == unit:
            return 1.0, 0.0
        if not given:
            raise InputError(where, f"{value!r} has no unit; expected {expected(unit)}", example(unit))
        try:
            source, target = self.registry.Unit(given), self.registry.Unit(unit)
        except Exception as error:  # the parser of pint raises a dozen unrelated types
            comma = "a decimal point instead of the comma: " if given.startswith(",") else ""
            raise InputError(where, f"{value!r}: unknown unit {given!r}", comma + example(unit)) from error
        if source.dimensionality != target.dimensionality or _angle(self.registry, source) != _angle(
            self.registry, target
        ):
            raise InputError(
                where, f"{value!r} has the dimension {source.dimensionality}; expected {expected(unit)}", example(unit)
            )
        zero, one = (self.registry.Quantity(x, source).to(target).magnitude for x in (0.0, 1.0))
        if zero != 0.0 and unit != "K":
            raise InputError(where, f"{value!r} has a unit with an offset: it is no difference", example(unit))
        return float(one - zero), float(zero)


def is_quantity(text: str) -> bool:
    """True if a text begins with a number, as that of a quantity does.

    Examples
    --------
    >>> is_quantity("-5 degC"), is_quantity("my_fields:ramp")
    (True, False)
    """
    return _NUMBER.match(text) is not None


def expected(unit: str) -> str:
    """Name of a quantity with the given unit, for error messages.

    Examples
    --------
    >>> expected("Pa")
    'a stress [Pa]'
    """
    name = _EXAMPLES.get(unit, ("a quantity", ""))[0]
    return f"{name} [{unit}]" if unit else name


def example(unit: str) -> str:
    """Example of a quantity with the given unit, for remedies.

    Examples
    --------
    >>> example("m")
    'a length such as "5 mm", or a bare number in m'
    """
    name, sample = _EXAMPLES.get(unit, ("a quantity", f"1 {unit}"))
    return f'{name} such as "{sample}", or a bare number in {unit}' if unit else f"{name} such as {sample}"


def _angle(registry: "pint.UnitRegistry[Any]", unit: Any) -> bool:
    """True if a dimensionless unit measures an angle; angles and pure numbers are not interchangeable."""
    root = registry.get_root_units(unit)[1]
    return any(str(part) == "radian" for part in root._units)


def _real(value: float) -> float:
    """Number as a float; infinite for an integer that is too large for a float."""
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _finite(number: float, value: object, where: str, unit: str) -> float:
    if not math.isfinite(number):
        raise InputError(where, f"{value!r} is not finite", example(unit))
    return number
