"""Notes on sliding bodies whose vibrations grow: only where the run is long enough, and no more with the remedy."""

import re
from dataclasses import replace

import softway as sw
from softway.scenario.scenario import Time

WEIGHT, MU = 1e-3, 0.4


def sliding(material: object, end: float, step: float = 1.0, calm: float = 0.0) -> sw.Scenario:
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.5, 1.0), cells=(6, 4)),
        material=material,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(10.0, 0.0)),
    )
    return sw.Scenario(
        time=Time(end=end, step=step),
        bodies={"block": block, "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))},
        contacts=(
            sw.Contact(
                between=("block.bottom", "floor"), friction=sw.Coulomb(mu=MU), timing=sw.contact.Energy(calm=calm)
            ),
        ),
        loads=(sw.Gravity(acceleration=(0.0, -WEIGHT)),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=(MU * WEIGHT, -WEIGHT)),)),
    )


def notes(scenario: sw.Scenario) -> list[sw.errors.Note]:
    return [n for n in sw.check(scenario).notes if "flutters" in n.problem]


def test_a_long_slide_flutters_and_the_remedy_is_taken() -> None:
    elastic = sw.LinearElastic(E=1.0, nu=0.25)
    (note,) = notes(sliding(elastic, 1000.0))
    assert note.where == "contacts[0].friction"
    assert re.search(r"of 0\.367 Hz grow by 0\.028 of its amplitude in a slab, and 1e12 times", note.problem)
    assert notes(sliding(elastic, 10.0)) == []
    found = re.search(r"above (\S+) s", note.remedy)
    assert found is not None
    time = 1.01 * float(found[1])
    damped = sw.laws.Kelvin(E=1.0, nu=0.25, shear_viscosity=time / 2.5, bulk_viscosity=time / 1.5)
    assert notes(sliding(damped, 1000.0)) == []


def test_the_filter_is_a_remedy_where_slabs_do_not_resolve_the_flutter() -> None:
    """The frequency is 2.3 / s: slabs of 3 s do not resolve it, those of .3 s do."""
    elastic = sw.LinearElastic(E=1.0, nu=0.25)
    (note,) = notes(sliding(elastic, 3000.0, step=3.0))
    assert "Kelvin" in note.remedy and "the timing Energy with calm = 0.2" in note.remedy
    assert notes(sliding(elastic, 3000.0, step=3.0, calm=0.2)) == []
    (note,) = notes(sliding(elastic, 300.0, step=0.3))
    assert "Kelvin" in note.remedy and "calm" not in note.remedy
    (note,) = notes(sliding(elastic, 300.0, step=0.3, calm=0.2))
    assert "calm = 0.2 does not stop it, as slabs of 0.3 s resolve it" in note.problem and "calm" not in note.remedy


def test_bodies_at_rest_have_no_note() -> None:
    moving = sliding(sw.LinearElastic(E=1.0, nu=0.25), 1000.0)
    block = moving.bodies["block"]
    assert isinstance(block, sw.Solid)
    resting = replace(block, velocity=sw.bodies.Uniform(value=(0.0, 0.0)))
    assert notes(replace(moving, bodies={**moving.bodies, "block": resting})) == []
