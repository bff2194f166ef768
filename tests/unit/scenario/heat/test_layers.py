"""Laws of conduction and densities by regions in scenario files."""

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.scenario.checks.check import check
from softway.scenario.files import dumps, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.json_schema import schema

UNITS = Units.standard()
WALL = """
[bodies.wall]
kind = "Conductor"
temperature = 300
density = { brick = "1800 kg/m^3", felt = 100 }
law.brick = { conductivity = "0.8 W/(m*K)", capacity = "0.9 kJ/(kg*K)" }
law.felt = { conductivity = "0.04 W/(m*K)", capacity = 1000 }
[bodies.wall.mesh]
kind = "Divided"
mesh = { kind = "Interval", length = "30 cm", cells = 6 }
regions = { brick = { kind = "InBox", high = ["20 cm"] } }
rest = "felt"
[[loads]]
kind = "Temperature"
on = "wall.right"
value = 340
[[loads]]
kind = "Convection"
on = "wall.left"
coefficient = 8
ambient = 290
[time]
end = "300 h"
step = "2 h"
"""


def test_a_wall_of_a_file_conducts_by_the_sum_of_its_resistances() -> None:
    run = sw.run(sw.loads(WALL))
    flux = 50.0 / (1.0 / 8.0 + 0.2 / 0.8 + 0.1 / 0.04)
    falls = 290.0 + flux * np.array([1.0 / 8.0, 1.0 / 8.0 + 0.25, 1.0 / 8.0 + 0.25 + 2.5])
    wanted = np.interp(np.linspace(0.0, 0.3, 7), [0.0, 0.2, 0.3], falls)
    np.testing.assert_allclose(run.fields[-1]["temperature"], wanted, rtol=1e-9)
    assert abs(run.history["heat_error_relative"][-1]) < 1e-12


def test_a_wall_is_written_as_it_was_read() -> None:
    wall = loads(WALL, units=UNITS)
    assert loads(dumps(wall), units=UNITS) == wall
    assert isinstance(wall.bodies["wall"], sw.heat.Conductor) and set(wall.bodies["wall"].law) == {"brick", "felt"}


def test_one_law_of_two_tables_is_one_law() -> None:
    table = "{ temperatures = [300, 400], values = [1, 2] }"
    law = f"law = {{ conductivity = {table}, capacity = {table} }}"
    lines = [line for line in WALL.splitlines() if not line.startswith("law.")]
    lines.insert(lines.index("temperature = 300"), law)
    wall = loads("\n".join(lines), units=UNITS).bodies["wall"]
    assert isinstance(wall, sw.heat.Conductor) and isinstance(wall.law, sw.heat.Conduction)


@pytest.mark.parametrize(
    ("change", "where"),
    [
        (("law.felt", "law.wool"), "bodies.wall.law.wool"),
        (("felt = 100", "wool = 100"), "bodies.wall.density.wool"),
        (("capacity = 1000", "capacity = 0"), "bodies.wall.law.felt.capacity"),
    ],
)
def test_errors_name_the_region(change: tuple[str, str], where: str) -> None:
    with pytest.raises(InputError) as error:
        check(loads(WALL.replace(*change), units=UNITS))
    assert error.value.where == where


def test_the_schema_admits_laws_by_regions() -> None:
    made = schema()["$defs"]
    body = next(it for name, it in made.items() if name.endswith("Conductor"))["properties"]
    for key in ("law", "density"):
        assert any(one.get("type") == "object" and "additionalProperties" in one for one in body[key]["anyOf"])
