"""Heat through ties that break: as through permanent ones while intact, heat of the fracture, nothing afterwards."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies import Affine, Driven, Fixed, Off, RigidThermal, Thermal
from softway.mechanisms import Mechanism, Rigid
from softway.meshes.generators.shapes import rectangle
from softway.record.storage.serialisation import packed, unpacked

C, SIDE = 500.0, 0.1
STRONG = sw.BilinearCohesive(strength=1e8, energy=1e6, stiffness=1e12)


def wall(breaks: sw.BilinearCohesive | None, **given: object) -> sw.Scene:
    """A wall of two layers with meshes that do not match between two temperatures, glued."""
    law = sw.heat.Conduction(conductivity=10.0, capacity=C)
    low, top = (
        sw.Solid(
            mesh=rectangle((SIDE, SIDE), (k, 4), origin=(0.0, y)), material=sw.LinearElastic(E=1e9, nu=0.0),
            density=1000.0, thermal=Thermal(law=law, temperature=350.0), supports=(Fixed(on=side),),
        )
        for k, y, side in ((2, 0.0, "bottom"), (3, SIDE, "top"))
    )  # fmt: skip
    loads = (sw.heat.Temperature(on="low.bottom", value=300.0), sw.heat.Temperature(on="top.top", value=400.0))
    tie = sw.Tie(between=("low.top", "top.bottom"), conductance=200.0, breaks=breaks)
    return sw.Scene(bodies={"low": low, "top": top}, ties=(tie,), loads=loads, **given)  # type: ignore[arg-type]


def test_an_intact_tie_conducts_as_a_permanent_one() -> None:
    """Steady against the exact profile, and on the way there against the permanent tie."""
    ways = [list(sw.march(wall(breaks, inertia=Off()), until=1.2e4, step=150.0)) for breaks in (None, STRONG)]
    for one, other in zip(*ways, strict=True):
        for name in ("low", "top"):
            mine, same = (step.after.fields["temperature"][name] for step in (one, other))
            np.testing.assert_allclose(mine, same, rtol=1e-10)
    last = ways[1][-1]
    flux = 100.0 / (2.0 * SIDE / 10.0 + 1.0 / 200.0)
    bottom = last.after.fields["temperature"]["top"].min()
    assert bottom == pytest.approx(300.0 + flux * (SIDE / 10.0 + 1.0 / 200.0), rel=5e-8)
    assert abs(last.ledger.heat.error) < 1e-11 * last.ledger.heat.content and last.ledger.heat.received == 0.0


def bars(conductance: float | None, conductivity: float = 0.001, energy: float = 2e-3) -> sw.Scene:
    """Two bars of one kelvin difference, glued end to end, that are pulled apart."""
    law, made = sw.heat.Conduction(conductivity=conductivity, capacity=0.001), {}
    supports = {"a": Fixed(on="left"), "b": Driven(on="right", components="x", velocity=0.02)}
    for name, at, temperature in (("a", 0.0, 275.0), ("b", 1.0, 274.0)):
        made[name] = sw.Solid(
            mesh=sw.meshes.Interval(length=1.0, cells=5, origin=at), material=sw.LinearElastic(E=10.0, nu=0.0),
            density=1.0, supports=(supports[name],), thermal=Thermal(law=law, temperature=temperature, expansion=1e-5),
        )  # fmt: skip
    glue = sw.BilinearCohesive(strength=0.1, energy=energy, stiffness=1e3)
    tie = sw.Tie(between=("a.right", "b.left"), breaks=glue, conductance=conductance)
    return sw.Scene(bodies=made, ties=(tie,))


def pulled(scene: sw.Scene, **given: object) -> list[sw.Step]:
    return list(sw.march(scene, until=3.0, step=0.03, **given))  # type: ignore[arg-type]


@pytest.mark.slow
def test_bars_pulled_apart_turn_the_fracture_energy_into_heat() -> None:
    steps = pulled(bars(0.002))
    ledgers = [s.ledger for s in steps]
    last = ledgers[-1]
    assert last.ties["a.right-b.left"].dissipated == pytest.approx(2e-3, rel=1e-10)
    whole = [k.energy_kinetic + k.energy_strain + k.heat.content - k.work_external for k in ledgers]
    assert np.ptp(whole) < 1e-11 * 2e-3
    # all of it heats, less the work of the thermal stress
    assert abs(last.heat.received - last.dissipation) < 1e-11 * last.dissipation and last.heat.cold_work == 0.0
    assert min(k.heat.produced + k.heat.rounding for k in ledgers) >= 0.0
    damage = [float(s.after.fields["damage"]["a"].max()) for s in steps]
    broken = next(k for k, d in enumerate(damage) if d >= 1.0)
    assert 10 < broken < len(steps) - 20
    means = np.array([[s.after.fields["temperature"][n].mean() for n in "ab"] for s in steps])
    assert means[broken][1] > 274.01
    again = pulled(bars(0.002), state=unpacked(*packed(steps[40].march_state)))
    assert again[-1].ledger.heat == last.heat
    for name in "ab":
        mine, same = (s[-1].after.fields["temperature"][name] for s in (steps, again))
        np.testing.assert_array_equal(mine, same)


def heats(step: sw.Step, weights: np.ndarray) -> list[float]:
    """Heat of each bar above 273.15 K [J]."""
    return [0.001 * float(weights @ (step.after.fields["temperature"][name][:, 0] - 273.15)) for name in "ab"]


@pytest.mark.slow
def test_no_heat_passes_after_the_break_and_each_side_has_half() -> None:
    weights = np.array([0.1, 0.2, 0.2, 0.2, 0.2, 0.1])
    for conductance in (0.0, 0.002):
        scene = bars(conductance)
        cold = {n: replace(b, thermal=replace(b.thermal, expansion=0.0)) for n, b in scene.bodies.items()}
        steps = pulled(replace(scene, bodies=cold))
        damage = np.array([float(s.after.fields["damage"]["a"].max()) for s in steps])
        broken = int(np.argmax(damage >= 1.0))
        first, then, last = (np.array(heats(steps[k], weights)) for k in (0, broken, -1))
        np.testing.assert_allclose(last, then, rtol=1e-12)
        if conductance == 0.0:
            np.testing.assert_allclose(then - first, 1e-3, rtol=1e-9)
        else:
            assert then[1] - first[1] > 1e-3 + 1e-5


@pytest.mark.slow
@pytest.mark.parametrize("contact", [False, True], ids=["alone", "contact"])
def test_a_block_that_spins_breaks_apart_and_warms(contact: bool) -> None:
    """In both modes, on meshes that do not match, with a contact of the pieces that conducts beside the glue."""
    glue = sw.BilinearCohesive(strength=0.4, energy=0.02, stiffness=40.0, shear_strength=0.6, shear_energy=0.05)
    law, thrown = sw.heat.Conduction(conductivity=0.05, capacity=0.02), Affine(gradient=((0.1, -1.6), (1.6, 0.7)))
    bodies = {}
    for name, base, height, cells, temperature in (("a", 0.0, 0.5, (2, 2), 275.0), ("b", 0.5, 0.25, (3, 1), 274.0)):
        bodies[name] = sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, height), cells=cells, origin=(0.0, base)), density=1.0, velocity=thrown,
            material=sw.NeoHookean(E=10.0, nu=0.3), thermal=Thermal(law=law, temperature=temperature, expansion=1e-5),
        )  # fmt: skip
    tie = sw.Tie(between=("a.top", "b.bottom"), breaks=glue, conductance=0.05)
    heat = sw.heat.ContactHeat(conductance=0.05)
    contacts = (sw.Contact(between=("a.top", "b.bottom"), heat=heat),) if contact else ()
    ledgers = [
        s.ledger for s in sw.march(sw.Scene(bodies=bodies, ties=(tie,), contacts=contacts), until=1.2, step=0.02)
    ]
    last, kinetic = ledgers[-1], ledgers[0].energy_kinetic
    assert last.ties[tie.label].broken == pytest.approx(1.0)
    whole = [k.energy_kinetic + k.energy_strain + k.heat.content for k in ledgers]
    assert np.ptp(whole) < 1e-11 * kinetic
    assert abs(last.heat.received - last.dissipation) < 1e-12 * kinetic
    assert last.heat.received > 0.9 * last.ties[tie.label].dissipated > 0.01
    assert min(k.heat.produced + k.heat.rounding for k in ledgers) >= 0.0


def test_ties_conduct_beside_a_rigid_body_with_a_temperature() -> None:
    """Which adds an unknown, and exchanges nothing."""
    ball = Rigid(mass=1.0, centre=(1.0, 1.0), inertia=1.0, thermal=RigidThermal(temperature=500.0, capacity=10.0))
    for breaks in (None, STRONG):
        alone = wall(breaks)
        beside = replace(alone, mechanism=Mechanism(bodies={"ball": ball}))
        ends = [list(sw.march(scene, until=1.0, step=0.5))[-1] for scene in (alone, beside)]
        for name in ("low", "top"):
            one, other = (end.after.fields["temperature"][name] for end in ends)
            np.testing.assert_allclose(one, other, rtol=1e-11)
        assert ends[1].ledger.heat.rigid["ball"] == pytest.approx(500.0, rel=1e-14)
