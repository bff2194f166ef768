"""Every law that stores energy carries an impact with contact, its energy in balance."""

import pytest

import softway as sw
from softway.laws.materials import find
from softway.laws.strain_measures import Green, Small

WOOD = {"E": (14.0, 1.0, 0.7), "nu": (0.3, 0.45, 0.4), "G": (0.9, 1.1, 0.1)}
LAWS = [
    sw.laws.Hencky(E=1.0, nu=0.3),
    sw.laws.MooneyRivlin(c10=0.1, c01=0.05, bulk=2.0),
    sw.laws.LinearOrthotropic(**WOOD, axes=((0.0, 1.0, 1.0), (1.0, 0.0, 0.0)), measure=Green()),
    sw.laws.LinearOrthotropic(**WOOD, measure=Small()),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: f"{type(law).__name__}-{type(law.measure).__name__}")
def test_impact_of_a_block(law, tmp_path):
    block = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 2)),
        material=law,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.05, 0.0, -0.2)),
        place=sw.bodies.Placement(bottom=0.05),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), name="floor")
    scenario = sw.Scenario(
        bodies={"block": block, "floor": floor}, contacts=(contact,), time=sw.Time(end=3.0, step=0.1)
    )
    summary = sw.run(scenario).summary
    assert summary["contacts"]["floor"]["impulse"] > 0.2
    assert summary["energy_error_relative"] < 1e-10
    assert summary["penetration_worst"] < 1e-12


@pytest.mark.few(2)
@pytest.mark.parametrize("name", ["lead", "natural rubber", "wood Douglas fir"])
def test_a_bar_of_the_library_carries_its_wave(name):
    """A bar that meets a wall touches it for 2 L/c, c of its material."""
    material = find(name)
    law = material.elastic()
    speed = (law.youngs() / material.density) ** 0.5
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=40),
        material=law,
        density=material.density,
        velocity=sw.bodies.Uniform(value=1e-4 * speed),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.00001, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), name="wall")
    time = sw.Time(end=2.6 / speed, step=1.0 / (40 * speed))
    run = sw.run(sw.Scenario(bodies={"bar": bar, "wall": wall}, contacts=(contact,), time=time))
    found = run.summary["contacts"]["wall"]
    assert found["last_release"] - found["first_touch"] == pytest.approx(2.0 / speed, rel=0.06)
