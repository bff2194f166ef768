"""Files, shorthand, defaults and changes are understood."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from softway.bodies.setup.initial_fields import Uniform
from softway.contact.impact_rule import Impulse
from softway.errors import InputError
from softway.meshes.generators.shapes import interval
from softway.scenario.files import dump, dumps, load, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.scenario import Scenario
from softway.scenario.text.writer import write

UNITS = Units.standard()
BAR = """
[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = "1 m", cells = 2 }
material = { kind = "LinearElastic", E = "1 Pa" }
density = 1
velocity = "36 km/h"
[time]
end = 4
"""


def test_every_default_is_written_out():
    bar = write(loads(BAR, units=UNITS), Scenario, "")["bodies"]["bar"]
    assert set(bar) == {
        "kind", "mesh", "material", "density", "mass", "velocity", "displacement", "supports", "force", "dilatation",
        "place", "group",
    }  # fmt: skip
    assert bar["material"] == {"kind": "LinearElastic", "E": "1.0 Pa", "nu": 0.0}
    assert bar["velocity"] == {"kind": "Uniform", "value": "10.0 m/s"}


def test_files_are_read_and_meshes_looked_for_beside_them(tmp_path: Path):
    file = tmp_path / "deep" / "a.toml"
    file.parent.mkdir()
    file.write_text(
        BAR.replace('{ kind = "Interval", length = "1 m", cells = 2 }', '{ kind = "MeshFile", path = "m/p.msh" }')
    )
    scenario = load(file, units=UNITS)
    assert Path(scenario.bodies["bar"].mesh.path) == file.parent / "m" / "p.msh"
    other = tmp_path / "b.toml"
    dump(scenario, other)
    assert load(other, units=UNITS) == scenario


def test_changes_are_made_before_reading():
    changes = ["bodies.bar.material.E=2 GPa", 'bodies.bar.velocity="1 mm/s"', "time.weight.kind=Momentum"]
    scenario = loads(BAR, changes=changes, units=UNITS)
    assert scenario.bodies["bar"].material.E == 2e9
    assert scenario.bodies["bar"].velocity == Uniform(value=1e-3)


def test_shorthand_names_a_kind_or_gives_its_only_field():
    text = BAR + '[[contacts]]\nbetween = ["bar.right", "wall"]\ntiming = "Impulse"\n'
    assert loads(text, units=UNITS).contacts[0].timing == Impulse()
    vector = loads(BAR.replace('"36 km/h"', '[1, "2 km/s", 0]'), units=UNITS).bodies["bar"].velocity
    assert vector == Uniform(value=(1.0, 2000.0, 0.0))


def test_units_follow_the_field_inside():
    scenario = loads(
        BAR, changes=['bodies.bar.displacement={kind="Affine", gradient="1 mm/m", value="2 mm"}'], units=UNITS
    )
    field = scenario.bodies["bar"].displacement
    assert (field.gradient, field.value) == (1e-3, 2e-3)
    change = 'bodies.bar.velocity={kind="Affine", gradient="2 1/ms", origin="1 cm"}'
    field = loads(BAR, changes=[change], units=UNITS).bodies["bar"].velocity
    assert (field.gradient, field.origin) == (2e3, 0.01)


@pytest.mark.parametrize(
    ("part", "value"),
    [("mesh", interval(1.0, cells=1)), ("velocity", np.zeros((2, 1))), ("displacement", lambda x: 0 * x)],
)
def test_what_only_python_can_say_is_not_written(part, value):
    scenario = loads(BAR, units=UNITS)
    bar = replace(scenario.bodies["bar"], **{part: value})
    with pytest.raises(InputError) as found:
        dumps(replace(scenario, bodies={"bar": bar}))
    assert found.value.where == f"bodies.bar.{part}"
    assert found.value.remedy


@pytest.mark.parametrize("text", ["[bodies", "time = {end = 4", "a = 1\na = 2"])
def test_broken_toml_names_the_file_and_the_line(tmp_path, text):
    file = tmp_path / "a.toml"
    file.write_text(text)
    with pytest.raises(InputError, match="is not valid TOML: .*(line|end of document)") as found:
        load(file)
    assert found.value.where == str(file)


def test_missing_scenario_file(tmp_path):
    with pytest.raises(InputError, match="no such scenario file"):
        load(tmp_path / "none.toml")
    with pytest.raises(InputError, match="cannot be read"):
        load(tmp_path)
