"""Library materials as laws of conduction in scenario files."""

import pytest

import softway as sw
from softway.apps.cli import main
from softway.errors import InputError
from softway.laws.materials import find
from softway.scenario.files import dumps, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.json_schema import schema
from softway.scenario.text.templates import templates

UNITS = Units.standard()
POND = """
[bodies.pond]
kind = "Conductor"
mesh = { kind = "Interval", length = "10 cm", cells = 4 }
law = "copper OFHC"
temperature = 300
[[loads]]
kind = "Temperature"
on = "pond.left"
value = 310
[time]
end = 60
step = 10
"""
MESH = (
    "bodies.pond.mesh={kind='Divided', mesh={kind='Interval', length=1, cells=4}, "
    "regions={near={kind='InBox', high=[0.5]}}, rest='far'}"
)


def pond(*changes: str) -> sw.heat.Conductor:
    """The conductor of the file after changes."""
    body = loads(POND, changes=changes, units=UNITS).bodies["pond"]
    assert isinstance(body, sw.heat.Conductor)
    return body


def rod(*changes: str) -> sw.Solid:
    """A solid with the law of a name."""
    heat = "bodies.bar.thermal={temperature=300, law='6061'}"
    body = loads(templates()["bar"], changes=(heat, *changes), units=UNITS).bodies["bar"]
    assert isinstance(body, sw.Solid)
    return body


def test_a_conductor_has_law_and_density_of_its_name() -> None:
    copper = find("copper")
    assert (pond().law, pond().density) == (copper.conduction(), copper.density)
    assert pond("bodies.pond.density=1").density == 1.0
    assert loads(dumps(loads(POND, units=UNITS)), units=UNITS) == loads(POND, units=UNITS)


def test_parameters_and_latent_heat_of_a_name() -> None:
    law = pond("bodies.pond.law.capacity=400").law
    assert (law.conductivity, law.capacity, law.latent) == (386.0, 400.0, None)
    assert pond("bodies.pond.law={library='copper', latent=true}").law == find("copper").conduction(latent=True)
    assert pond("bodies.pond.law.latent=true").law == find("copper").conduction(latent=True)
    assert pond("bodies.pond.law={library='copper', latent=false}").law == find("copper").conduction()
    law = pond("bodies.pond.law={library='6061', latent={melting='615 degC', half_range='40 K'}}").law
    assert law.latent == sw.heat.Latent(heat=404e3, melting=888.15, half_range=40.0)


def test_a_solid_has_law_and_expansion_of_its_name() -> None:
    thermal = rod().thermal
    assert thermal.law == find("6061").conduction() and thermal.expansion == 23.6e-6  # as given
    assert rod("bodies.bar.thermal.expansion=0").thermal.expansion == 0.0
    other = rod("bodies.bar.material=copper").thermal
    assert other == thermal
    thermal = rod(
        "bodies.bar.thermal.law={library='lead', latent=true}", "bodies.bar.thermal.melting_strain=0.01"
    ).thermal
    assert thermal.law.latent.melting == 600.6  # as given


def test_names_by_regions() -> None:
    body = pond(
        MESH, "bodies.pond.law={near='copper', far={conductivity=1, capacity=2}}", "bodies.pond.density={far=3}"
    )
    assert body.law["near"] == find("copper").conduction()
    assert body.density == {"near": 8960.0, "far": 3.0}
    assert pond(MESH, "bodies.pond.law={near='copper', far='lead'}").density == {"near": 8960.0, "far": 11340.0}
    assert pond(MESH, "bodies.pond.law={near='copper', far='lead'}", "bodies.pond.density=5").density == 5.0
    mesh = MESH.replace("pond", "bar")
    thermal = rod(mesh, "bodies.bar.thermal.law={near='copper', far={library='lead', capacity=3}}").thermal
    assert thermal.law == {
        "near": find("copper").conduction(),
        "far": sw.heat.Conduction(conductivity=35.3, capacity=3.0),
    }
    assert thermal.expansion == 0.0


def test_a_run_warms_up_as_one_with_the_numbers() -> None:
    numbers = "bodies.pond.law={conductivity=386, capacity=383}"
    mine = sw.run(loads(POND, units=UNITS))
    same = sw.run(loads(POND, changes=[numbers, "bodies.pond.density=8960"], units=UNITS))
    assert mine.history["heat_content"][-1] == same.history["heat_content"][-1] > 0.0


@pytest.mark.parametrize(
    ("change", "where", "problem", "remedy"),
    [
        ("law=cooper OFHC", "bodies.pond.law", "not a material", "'copper OFHC'.*conductivity and capacity"),
        ("law={library=3}", "bodies.pond.law.library", "3 is not a name", "steel"),
        ("law={library='copper', latent=3}", "bodies.pond.law.latent", "3 is no latent heat", "true"),
        ("law=nylon", "bodies.pond.law", "no conductivity", "conductivity = ..., capacity = ..."),
        ("law={library='glass', latent=true}", "bodies.pond.law", "no melting", "conductivity"),
        ("law={kind='Conducton', conductivity=1}", "bodies.pond.law.kind", "'Conducton' is unknown", "'Conduction'"),
        ("law.K=3", "bodies.pond.law.K", "unknown key", "conductivity"),
        ("law={near='cooper', far='lead'}", "bodies.pond.law.near", "not a material", "'copper OFHC'"),
    ],
)
def test_mistakes(change: str, where: str, problem: str, remedy: str) -> None:
    with pytest.raises(InputError, match=f"(?s){problem}.*try: .*{remedy}") as found:
        pond(f"bodies.pond.{change}", "bodies.pond.density=1")
    assert found.value.where == where


def test_a_wrong_name_ends_with_its_place(tmp_path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "pond.toml"
    file.write_text(POND.replace("copper OFHC", "coper"), encoding="utf-8")
    assert main(["check", str(file)]) == 2
    told = capsys.readouterr().err
    assert "bodies.pond.law" in told and "copper OFHC" in told


def test_the_schema_admits_names() -> None:
    made = schema()["$defs"]
    for name in ("Conductor", "Thermal"):
        of = next(it for key, it in made.items() if key.endswith(f"conductor.{name}"))
        assert any("library" in one.get("description", "") for one in of["properties"]["law"]["anyOf"])
        assert ("density" if name == "Conductor" else "law") not in of["required"]
