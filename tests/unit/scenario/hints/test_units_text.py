"""Units: exact factors, and errors that say what was expected."""

import pytest

from softway.errors import InputError
from softway.scenario.hints.units_text import Units, example

UNITS = Units.standard()


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("210 GPa", "Pa", 210e9),
        ("5 mm", "m", 0.005),
        ("7850 kg/m^3", "kg/m^3", 7850.0),
        ("7.85 g/cm**3", "kg/m^3", 7850.0),
        ("205000 N/mm^2", "Pa", 205e9),
        ("-9.81 m/s²", "m/s^2", -9.81),
        ("36 km/h", "m/s", 10.0),
        ("180 deg", "rad", 3.141592653589793),
        ("2e-3 s", "s", 0.002),
        (".5 us", "s", 5e-7),
        ("12 in", "m", 0.3048),
        ("30 %", "", 0.3),
        ("0.3", "", 0.3),
        (3, "m", 3.0),
        (2.5, "Pa", 2.5),
    ],
)
def test_values(text, unit, value):
    assert UNITS.number(text, unit, "a") == pytest.approx(value, rel=1e-15)


def test_the_same_unit_keeps_every_bit():
    assert UNITS.number("0.1 m", "m", "a") == 0.1  # as given
    assert UNITS.number("1.7976931348623157e+308 Pa", "Pa", "a") == 1.7976931348623157e308


@pytest.mark.parametrize(
    ("value", "unit", "problem"),
    [
        ("5 mm", "Pa", "dimension"),
        ("5", "m", "no unit"),
        ("5 mn", "s", "dimension|unknown"),
        ("5 furlongs per", "m", "unknown unit"),
        ("mm", "m", "is not a length"),
        ("", "m", "is not a length"),
        ("30 deg", "", "dimension"),
        ("30 %", "rad", "dimension"),
        ("20 degC", "kelvin", "offset"),
        ("1e999 m", "m", "finite"),
        (float("nan"), "m", "finite"),
        (True, "m", "not a length"),
        ([1], "m", "not a length"),
        (None, "m", "not a length"),
        ("1 __import__('os')", "m", "unknown unit"),
        ("1 m; 2", "m", "unknown unit"),
    ],
)
def test_errors_name_the_place_the_value_and_a_remedy(value, unit, problem):
    with pytest.raises(InputError, match=problem) as found:
        UNITS.number(value, unit, "bodies.bar.x")
    assert found.value.where == "bodies.bar.x"
    assert str(value) in found.value.problem
    assert found.value.remedy == example(unit)


def test_every_unit_has_an_example_that_can_be_read():
    for unit in ("m", "m^2", "s", "Pa", "kg/m^3", "m/s", "m/s^2", "1/s", "rad", "N", "K", "W/(m K)", "J/(kg K)"):
        UNITS.number(example(unit).split('"')[1], unit, "a")
    assert example("K/m") == 'a quantity such as "1 K/m", or a bare number in K/m'


def test_temperatures_may_be_in_degrees_celsius():
    assert UNITS.number("20 degC", "K", "a") == pytest.approx(293.15, abs=1e-12)
    assert UNITS.number("-10 °C", "K", "a") == pytest.approx(263.15, abs=1e-12)
    assert UNITS.number("32 degF", "K", "a") == pytest.approx(273.15, abs=1e-9)
    assert UNITS.number("0.5 K", "kelvin", "a") == 0.5


@pytest.mark.parametrize(("value", "coldest"), [("-300 degC", "-273.15 degC"), ("-500 degF", "-459.67 degF")])
def test_temperatures_below_absolute_zero_are_refused_in_the_unit_they_have(value, coldest):
    with pytest.raises(InputError, match="not above absolute zero") as found:
        UNITS.number(value, "K", "loads[0].value")
    assert found.value.remedy == f"a temperature above {coldest}" and value in found.value.problem
