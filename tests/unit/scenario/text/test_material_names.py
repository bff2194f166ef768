"""Materials of the library in a scenario."""

import pytest

from softway.apps.cli import main
from softway.errors import InputError
from softway.laws.bulk import J2, LinearElastic
from softway.laws.materials import find
from softway.laws.plasticity.softening import Arrhenius
from softway.scenario.files import dumps, loads
from softway.scenario.hints.units_text import Units
from softway.scenario.text.templates import templates

UNITS = Units.standard()
BAR = templates()["bar"]
BARE = BAR.replace('density = "1 kg/m^3"\n', "")


def bar(text: str, *changes: str):
    return loads(text, changes=changes, units=UNITS).bodies["bar"]


def test_a_name_gives_law_and_density() -> None:
    solid = bar(BARE, "bodies.bar.material=steel S235")
    assert (solid.material, solid.density) == (find("steel S235").elastic(), 7850.0)


def test_a_density_of_the_body_stays() -> None:
    assert bar(BAR, "bodies.bar.material=glass").density == 1.0


def test_other_laws_and_parameters() -> None:
    solid = bar(BARE, "bodies.bar.material={library='copper', law='plastic'}")
    assert solid.material == find("copper").plastic() and isinstance(solid.material, J2)
    solid = bar(BARE, "bodies.bar.material={library='copper', law='linear', E='117 GPa'}")
    assert solid.material == LinearElastic(E=117e9, nu=0.343)


@pytest.mark.parametrize("name", ["glass", "steel S235", "Ti64"])
def test_one_parameter_may_change(name: str) -> None:
    text = BARE.replace('{ kind = "LinearElastic", E = "1 Pa" }', f'"{name}"')
    solid = bar(text, "bodies.bar.material.nu=0.25", "bodies.bar.material.law=linear")
    assert solid.material == LinearElastic(E=find(name).linear().youngs(), nu=0.25)
    assert solid.density == find(name).density


def test_the_text_of_a_run_holds_the_numbers() -> None:
    scenario = loads(BARE, changes=["bodies.bar.material=Douglas fir"], units=UNITS)
    text = dumps(scenario)
    assert "538.0 kg/m^3" in text and "LinearOrthotropic" in text
    assert loads(text, units=UNITS) == scenario


def test_a_solid_with_heat_softens() -> None:
    heat = "bodies.bar.thermal={temperature='20 degC', law={conductivity=1, capacity=1}}"
    copper = "bodies.bar.material={library='copper', law='plastic'}"
    assert bar(BARE, copper, heat).material == find("copper").plastic(softening=True)
    assert bar(BARE, copper.replace("copper", "S235"), heat).material == find("S235").plastic()
    other = copper.replace("}", ", softening={kind='Arrhenius', activation=1, reference=300}}")
    assert bar(BARE, other, heat).material.softening == Arrhenius(activation=1.0, reference=300.0)


def test_the_heat_of_a_solid_from_its_material() -> None:
    solid = bar(BARE, "bodies.bar.material=copper", "bodies.bar.thermal={temperature=300}")
    assert solid.thermal.law == find("copper").conduction() and solid.thermal.expansion == 1.65e-05  # as given
    solid = bar(BARE, "bodies.bar.material=copper", "bodies.bar.thermal={temperature=300, expansion=0}")
    assert solid.thermal.law.capacity == 383.0 and solid.thermal.expansion == 0.0
    with pytest.raises(InputError, match="no conductivity") as found:
        bar(BARE, "bodies.bar.material=nylon", "bodies.bar.thermal={temperature=300}")
    assert found.value.where == "bodies.bar.thermal.law"


@pytest.mark.parametrize(
    ("material", "where", "problem", "remedy"),
    [
        ("steal S235", "bodies.bar.material", "not a material", "'steel S235'.*kind"),
        ("{library='unobtainium'}", "bodies.bar.material", "not a material", "known: steel"),
        ("{library=3}", "bodies.bar.material.library", "3 is not a name", "steel"),
        ("{library='glass', law='plastc'}", "bodies.bar.material.law", "'plastc' is unknown", "'plastic'"),
        ("{library='glass', law='plastic'}", "bodies.bar.material.law", "no yield stress", "elastic or linear"),
        ("{library='glass', K=3}", "bodies.bar.material.K", "unknown key", "E, nu"),
    ],
)
def test_mistakes(material: str, where: str, problem: str, remedy: str) -> None:
    with pytest.raises(InputError, match=f"(?s){problem}.*try: .*{remedy}") as found:
        bar(BARE, f"bodies.bar.material={material}")
    assert found.value.where == where


def test_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["materials"]) == 0
    printed = capsys.readouterr().out
    assert "steel S235" in printed and "7850" in printed and "GPa" in printed
    assert main(["materials", "copper"]) == 0
    printed = capsys.readouterr().out
    assert "J/(kg K)" in printed and "Johnson, Cook (1983)" in printed and "2.92e+08" in printed
    assert main(["materials", "coper"]) == 2
    assert "copper OFHC" in capsys.readouterr().err
