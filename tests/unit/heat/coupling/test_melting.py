"""Solids that move while they melt and freeze: Neumann's front, expansion on freezing, energies of impacts."""

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.cases.heat import g01_freezing_water as g01

MELTING, CELL = 273.15, sw.meshes.Rectangle(size=(0.004, 0.004), cells=(4, 4))
WATER = sw.heat.Conduction(conductivity=0.556, capacity=4220.0)
ICE = sw.heat.Conduction(
    conductivity=2.22, capacity=1762.0, latent=sw.heat.Latent(heat=338e3, melting=MELTING, liquid=WATER)
)
STRAIN, EXPANSION = -0.03, 5e-5
"""Strain of water relative to ice, and an expansion [1/K]."""


def frozen(mesh: sw.meshes.Rectangle | sw.meshes.Interval, supports: tuple[sw.bodies.Fixed, ...]) -> list[sw.Step]:
    """March of water of 5 degrees Celsius that freezes from the left and cools to -20 degrees, without inertia."""
    heat = sw.bodies.Thermal(law=ICE, temperature=278.15, expansion=EXPANSION, melting_strain=STRAIN)
    solid = sw.Solid(
        mesh=mesh, material=sw.LinearElastic(E=1e9, nu=0.0), density=1000.0, supports=supports, thermal=heat
    )
    cold = sw.heat.Temperature(on="water.left", value=253.15)
    scene = sw.Scene(bodies={"water": solid}, loads=(cold,), inertia=sw.bodies.Off())
    return list(sw.march(scene, until=600.0, step=6.0))


def test_a_solid_freezes_as_a_conductor_does() -> None:
    """The first ten minutes of case G01, whose front is that of Neumann's solution."""
    mesh = sw.meshes.Interval(length=0.1, cells=100)
    cold = sw.heat.Temperature(on="water.left", value=g01.ZERO + g01.GIVEN["Tw"])
    water = sw.heat.Conduction(conductivity=g01.GIVEN["kl"], capacity=g01.GIVEN["cl"])
    melts = sw.heat.Latent(heat=g01.GIVEN["L"], melting=g01.ZERO + g01.GIVEN["Tm"], liquid=water)
    law = sw.heat.Conduction(conductivity=g01.GIVEN["ks"], capacity=g01.GIVEN["cs"], latent=melts)
    heat = sw.bodies.Thermal(law=law, temperature=g01.ZERO + g01.GIVEN["Ti"])
    solid = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1e9), density=g01.GIVEN["rho"], thermal=heat)
    moving = list(sw.march(sw.Scene(bodies={"water": solid}, loads=(cold,)), until=600.0, step=10.0))
    conductor = sw.heat.Conductor(mesh=mesh, law=law, density=g01.GIVEN["rho"], temperature=heat.temperature)
    still = list(
        sw.heat.march_heat(sw.heat.HeatScene(bodies={"water": conductor}, loads=(cold,)), until=600.0, step=10.0)
    )
    for one, other in zip(moving, still, strict=True):
        np.testing.assert_allclose(
            one.after.fields["temperature"]["water"][:, 0], other.temperature["water"], atol=1e-10, rtol=0.0
        )
        assert one.ledger.heat.liquid["water"] == pytest.approx(other.liquid_volume["water"], abs=1e-13)
    depth = 0.1 - moving[-1].ledger.heat.liquid["water"]
    assert depth == pytest.approx(float(g01.front(600.0)), rel=9e-3)  # cells of 1 mm: phase.md
    assert abs(moving[-1].ledger.heat.error) < 1e-11 * abs(moving[-1].ledger.heat.brought)


@pytest.mark.slow
def test_ice_that_is_free_expands_without_stress() -> None:
    left = sw.bodies.Fixed(on="left", components="x"), sw.bodies.Fixed(on="bottom", components="y")
    for mesh, supports in ((sw.meshes.Interval(length=0.004, cells=4), left[:1]), (CELL, left)):
        last = frozen(mesh, supports)[-1]
        temperature = last.after.fields["temperature"]["water"]
        assert last.ledger.heat.liquid["water"] == 0.0 and temperature.max() < 253.16
        strain = -STRAIN + EXPANSION * (253.15 - 278.15)
        u = last.after.displacement["water"]
        np.testing.assert_allclose(u.max(axis=0), 0.004 * strain, rtol=1e-6)


def test_ice_that_is_held_takes_the_stress_of_its_expansion() -> None:
    ends = sw.bodies.Fixed(on="left"), sw.bodies.Fixed(on="right")
    steps = frozen(sw.meshes.Interval(length=0.004, cells=4), ends)
    heat = steps[-1].ledger.heat
    force = steps[-1].march_state.state.start.force[-1, 0]
    strain = -STRAIN + EXPANSION * (253.15 - 278.15)
    assert force == pytest.approx(-1e9 * strain, rel=1e-6)  # the bar pushes the support
    assert abs(heat.error) < 1e-12 * abs(heat.brought)
    later = [s.ledger.energy_error for s in steps]
    assert np.ptp(later) < 1e-9 * abs(heat.received)  # the jump of the temperature is in the first slab alone
    assert min(s.ledger.heat.produced for s in steps) >= 0.0


def bar(cells: int) -> sw.Scene:
    """A bar whose front moves while it hits a wall at a tenth of its wave speed; E = rho = 1."""
    hot = sw.heat.Conduction(conductivity=0.01 / 300.0, capacity=1.0 / 300.0)
    melts = sw.heat.Latent(heat=0.05, melting=300.0, liquid=hot)
    law = sw.heat.Conduction(conductivity=0.02 / 300.0, capacity=0.8 / 300.0, latent=melts)
    profile = sw.bodies.Profile(at=(0.0, 1.0), values=(303.0, 296.0))
    heat = sw.bodies.Thermal(law=law, temperature=profile, expansion=3e-4, melting_strain=0.01, reference=299.0)
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells), material=sw.laws.Hencky(E=1.0, nu=0.0), density=1.0,
        velocity=sw.bodies.Uniform(value=0.1), thermal=heat,
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.01, normal=-1.0))
    return sw.Scene(bodies={"bar": solid, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))


@pytest.mark.slow
def test_an_impact_keeps_energy_with_latent_heat_and_produces_entropy() -> None:
    steps = list(sw.march(bar(20), until=3.0, step=0.04, method=sw.FixedPoint(tolerance=1e-13)))
    assert any(e.kind == "release" for s in steps for e in s.events)
    assert np.ptp([s.ledger.heat.liquid["bar"] for s in steps]) > 0.05  # the front moves
    whole = [s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content for s in steps]
    kinetic = steps[0].ledger.energy_kinetic
    assert np.ptp(whole) < 1e-11 * kinetic
    assert abs(steps[-1].ledger.heat.error) < 1e-11 * kinetic
    assert min(s.ledger.heat.produced for s in steps) > -1e-12 / 300.0
    assert np.mean([s.report.iterations for s in steps]) < 12.0


def test_a_march_goes_on_with_the_same_bits() -> None:
    steps = list(sw.march(bar(6), until=0.6, step=0.04))
    again = list(sw.march(bar(6), until=0.6, step=0.04, state=steps[5].march_state))
    assert len(again) == len(steps) - 6
    for name in ("displacement", "velocity"):
        mine, same = (getattr(found[-1].after, name)["bar"] for found in (steps, again))
        np.testing.assert_array_equal(same, mine)
    mine, same = (found[-1].after.fields["temperature"]["bar"] for found in (steps, again))
    np.testing.assert_array_equal(same, mine)


def test_what_melts_is_told_where_nothing_does() -> None:
    with pytest.raises(sw.InputError, match="matter that does not melt"):
        sw.bodies.Thermal(law=WATER, temperature=300.0, melting_strain=0.02)
