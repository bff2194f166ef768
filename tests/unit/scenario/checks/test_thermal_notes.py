"""Notes on thermal stresses that a law with a flow does not limit."""

import pytest

import softway as sw
from softway.bodies import PlaneStrain, PlaneStress, Thermal
from softway.meshes.generators.shapes import interval, rectangle
from softway.scenario.checks.notes.thermal_notes import thermal_notes

STEEL = sw.heat.Conduction(conductivity=50.0, capacity=500.0)
YIELDS, ELASTIC = sw.J2(E=2e11, nu=0.3, yield_stress=2e8), sw.LinearElastic(E=2e11, nu=0.3)


def solid(material: object, section: object = None, expansion: float = 1e-5) -> sw.Solid:
    mesh = interval(1.0, cells=2) if section is None else rectangle((1.0, 1.0), (1, 1))
    heat = Thermal(law=STEEL, temperature=300.0, expansion=expansion)
    return sw.Solid(mesh=mesh, material=material, density=7800.0, section=section, thermal=heat)


@pytest.mark.parametrize("section", [None, PlaneStress()])
def test_a_yield_stress_that_does_not_limit_a_thermal_stress_is_noted(section: object) -> None:
    (note,) = thermal_notes(solid(YIELDS, section))
    assert note.where == "thermal.expansion" and "J2" in note.problem
    regions = {"low": ELASTIC, "high": YIELDS}
    assert len(thermal_notes(solid(regions, section))) == 1


@pytest.mark.parametrize(
    ("material", "section", "expansion"), [(ELASTIC, None, 1e-5), (YIELDS, None, 0.0), (YIELDS, PlaneStrain(), 1e-5)]
)
def test_nothing_is_noted_where_the_law_sees_it_or_none_is(material: object, section: object, expansion: float) -> None:
    assert thermal_notes(solid(material, section, expansion)) == ()
