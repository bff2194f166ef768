"""Rigid bodies with one temperature beside solids with heat: exchange with a block, friction, loads, records."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies import Affine, Fixed, RigidThermal, Thermal
from softway.heat import ContactHeat
from softway.laws.heat.contact_heat import STEFAN_BOLTZMANN
from softway.mechanisms import Mechanism, PointForce, Rigid
from softway.meshes.generators.shapes import box, rectangle
from softway.obstacles.primitives import Block
from softway.record.storage.serialisation import packed, unpacked

RHO, C, SIDE = 1000.0, 500.0, 0.1
CAPACITY, RIGID = RHO * C * SIDE**2, 2500.0
LUMP = sw.heat.Conduction(conductivity=1e5, capacity=C)
"""Conducts so well that a block has one temperature."""
WARM = RigidThermal(temperature=400.0, capacity=RIGID)


def resting(heat: ContactHeat, press: float = 1e-3, thermal: RigidThermal | None = WARM, **given: object) -> sw.Scene:
    """A rigid block of 400 K that rests on an elastic one of 300 K, pressed by a force that strains it by ``press``."""
    E, dim = 1e5, int(given.pop("dim", 2))
    mesh = (rectangle if dim == 2 else box)((SIDE,) * dim, (2,) * dim)
    squeezed = np.zeros((dim, dim))
    squeezed[-1, -1] = -press
    low = sw.Solid(
        mesh=mesh, material=sw.LinearElastic(E=E, nu=0.0), density=RHO, displacement=Affine(gradient=squeezed.tolist()),
        supports=(Fixed(on="bottom"),), thermal=Thermal(law=LUMP, temperature=300.0),
    )  # fmt: skip
    at, gap = (0.5 * SIDE,) * (dim - 1), float(given.pop("gap", 0.0))
    bottom = SIDE * (1.0 - press) + gap
    centre = (*at, bottom + 0.5 * SIDE)
    shape = Block(low=(*(-SIDE,) * (dim - 1), bottom), high=(*(2.0 * SIDE,) * (dim - 1), bottom + SIDE))
    inertia = 1e3 if dim == 2 else (1e3, 1e3, 1e3)
    body = Rigid(mass=1e7, centre=centre, inertia=inertia, shape=shape, thermal=thermal)
    down = PointForce(on="top", at=centre, value=(*(0.0,) * (dim - 1), -E * press * SIDE ** (dim - 1)))
    mechanism = Mechanism(bodies={"top": body}, forces=(down,) if press else ())
    contact = sw.Contact(between=("low.top", "top"), heat=heat)
    return sw.Scene(bodies={"low": low}, contacts=(contact,), mechanism=mechanism, **given)  # type: ignore[arg-type]


def temperatures(step: sw.Step) -> tuple[float, float]:
    field = step.after.fields["temperature"]
    return float(field["low"].mean()), float(field["top"][0, 0])


@pytest.mark.parametrize("dim", [2, 3])
def test_a_block_cools_as_a_lump_by_the_conductance(dim: int) -> None:
    steps = list(sw.march(resting(ContactHeat(conductance=200.0), dim=dim), until=20.0, step=2.0))
    area, capacity = SIDE ** (dim - 1), RHO * C * SIDE**dim
    rate = 200.0 * area * (1.0 / capacity + 1.0 / RIGID)
    for step in steps[1:]:
        low, top = temperatures(step)
        assert top - low == pytest.approx(100.0 * np.exp(-rate * step.after.time), rel=2e-4)
    heat, (low, top) = [s.ledger.heat for s in steps], temperatures(steps[-1])
    assert heat[-1].rigid == {"top": top}
    assert heat[-1].through[0] == pytest.approx(-(400.0 - top) * RIGID, rel=1e-9)
    assert max(abs(h.error) for h in heat) < 1e-12 * heat[0].content and heat[-1].received == 0.0
    assert min(h.produced for h in heat[1:]) > 0.0


@pytest.mark.slow
def test_both_reach_the_temperature_of_the_sum_of_their_capacities() -> None:
    *_, last = sw.march(resting(ContactHeat(conductance=1e6)), until=0.6, step=0.015)
    mixed = (300.0 * CAPACITY + 400.0 * RIGID) / (CAPACITY + RIGID)
    np.testing.assert_allclose(last.after.fields["temperature"]["low"], mixed, rtol=1e-10)
    assert temperatures(last)[1] == pytest.approx(mixed, rel=1e-10)


def test_a_solid_whose_law_is_a_table_exchanges_as_much() -> None:
    """By Newton's method, with the values of the constant law."""
    table = sw.heat.TemperatureTable(temperatures=(200.0, 500.0), values=(C, C))
    scene = resting(ContactHeat(conductance=200.0))
    solid = replace(scene.bodies["low"], thermal=Thermal(law=replace(LUMP, capacity=table), temperature=300.0))
    one, other = (list(sw.march(s, until=4.0, step=2.0)) for s in (scene, replace(scene, bodies={"low": solid})))
    assert temperatures(one[-1]) == pytest.approx(temperatures(other[-1]), rel=1e-11)
    assert one[-1].ledger.heat.content - one[0].ledger.heat.content == pytest.approx(0.0, abs=1e-7)


def test_gas_and_radiation_cross_a_gap() -> None:
    gas = resting(ContactHeat(gas=0.5, roughness=1e-4), press=0.0, gap=1e-3)
    *_, last = sw.march(gas, until=10.0, step=0.5)
    rate = 0.5 / 1.1e-3 * SIDE * (1.0 / CAPACITY + 1.0 / RIGID)
    assert np.diff(temperatures(last))[0] == pytest.approx(100.0 * np.exp(-rate * 10.0), rel=2e-4)
    *_, last = sw.march(resting(ContactHeat(emissivity=0.8), press=0.0, gap=1e-3), until=10.0, step=0.5)
    flow = 0.8 * STEFAN_BOLTZMANN * SIDE
    lost = 10.0 * flow * (400.0**4 - 300.0**4)
    for _ in range(5):  # at the mean temperatures of the ten seconds
        lost = 10.0 * flow * ((400.0 - 0.5 * lost / RIGID) ** 4 - (300.0 + 0.5 * lost / CAPACITY) ** 4)
    assert 400.0 - temperatures(last)[1] == pytest.approx(lost / RIGID, rel=1e-5)
    assert last.ledger.heat.entropy > 0.0


def test_loads_heat_a_rigid_body() -> None:
    """A source against convection: the exact temperature of a lump; and a temperature that is held."""
    scene = resting(ContactHeat(), thermal=replace(WARM, area=0.2))
    body = scene.mechanism.bodies["top"]
    dense = replace(body, density=body.mass / (3.0 * SIDE * SIDE), mass=0.0, centre=(), inertia=0.0)
    mechanism = replace(scene.mechanism, bodies={"top": dense})
    loads = (
        sw.heat.HeatSource(of="top", value=1e5),
        sw.heat.Convection(on="top", coefficient=100.0, ambient=300.0),
    )
    scene = replace(scene, mechanism=mechanism, loads=loads)
    *_, last = sw.march(scene, until=50.0, step=2.0)
    power, rate = 1e5 * 0.03, 100.0 * 0.2 / RIGID
    end = 300.0 + power / 20.0
    assert temperatures(last)[1] == pytest.approx(end + (400.0 - end) * np.exp(-rate * 50.0), rel=2e-5)
    heat = last.ledger.heat
    assert heat.brought == pytest.approx((temperatures(last)[1] - 400.0) * RIGID, rel=1e-10)
    assert abs(heat.error) < 1e-12 * heat.content
    held = replace(scene, loads=(sw.heat.Temperature(on="top", value=350.0),))
    *_, last = sw.march(held, until=1.0, step=0.5)
    assert temperatures(last)[1] == 350.0 and last.ledger.heat.brought == pytest.approx(-50.0 * RIGID, rel=1e-12)


COOL = RigidThermal(temperature=275.0, capacity=2.5)


def slid(heat: ContactHeat, thermal: RigidThermal | None, until: float = 0.03, **given: object) -> list[sw.Step]:
    """A rigid plate that slides on an elastic layer of 274 K, pressed by 300 N, until friction stops it."""
    scene = resting(heat, press=1e-4)
    law = sw.heat.Conduction(conductivity=0.05, capacity=0.5)
    layer = replace(
        scene.bodies["low"], material=sw.LinearElastic(E=3e7, nu=0.0),
        thermal=Thermal(law=law, temperature=274.0, expansion=1e-6),
    )  # fmt: skip
    rest = scene.mechanism.bodies["top"]
    plate = Rigid(density=1000.0, shape=rest.shape, velocity=(0.1, 0.0), thermal=thermal)
    force = replace(scene.mechanism.forces[0], value=(0.0, -300.0))
    contact = replace(scene.contacts[0], friction=sw.Coulomb(mu=0.4))
    mechanism = Mechanism(bodies={"top": plate}, forces=(force,))
    scene = replace(scene, bodies={"low": layer}, contacts=(contact,), mechanism=mechanism)
    return list(sw.march(scene, until=until, step=1e-3, **given))


@pytest.mark.slow
def test_a_plate_that_friction_stops_turns_its_motion_into_heat() -> None:
    heat = ContactHeat(conductance=100.0, share=0.3)
    steps = slid(heat, COOL)
    ledgers = [s.ledger for s in steps]
    kinetic, last = ledgers[0].energy_kinetic, ledgers[-1]
    whole = [k.energy_kinetic + k.energy_strain + k.heat.content - k.work_external for k in ledgers]
    assert np.ptp(whole) < 1e-10 * kinetic
    assert abs(last.heat.received - last.dissipation) < 1e-12 * kinetic and last.heat.friction > 0.9 * kinetic
    assert min(k.heat.produced + k.heat.rounding for k in ledgers) >= 0.0 and last.heat.entropy > 0.0
    # the plate has its share of the friction, and what passed the contact
    gained = COOL.capacity * (last.heat.rigid["top"] - COOL.temperature)
    assert gained == pytest.approx(0.7 * last.heat.friction + last.heat.through[0], rel=1e-11)
    again = slid(heat, COOL, state=unpacked(*packed(steps[18].march_state)))
    assert again[-1].ledger.heat == last.heat
    for name in ("low", "top"):
        mine, same = (s[-1].after.fields["temperature"][name] for s in (steps, again))
        np.testing.assert_array_equal(mine, same)
    np.testing.assert_array_equal(again[-1].after.rigid["top"].centre, steps[-1].after.rigid["top"].centre)


def test_effusivities_share_the_heat_of_friction() -> None:
    conducts = replace(COOL, conductivity=0.2)
    *_, last = slid(ContactHeat(), conducts, until=2e-3)
    theirs = np.sqrt(0.2 * 1000.0 * COOL.capacity / 30.0)
    share = theirs / (theirs + np.sqrt(0.05 * RHO * 0.5))
    heat = last.ledger.heat
    assert COOL.capacity * (heat.rigid["top"] - COOL.temperature) == pytest.approx(share * heat.friction, rel=1e-10)
    assert heat.friction > 1e-3 and heat.through == (0.0,)


def test_a_state_carries_the_temperature() -> None:
    scene = resting(ContactHeat(conductance=200.0))
    whole = list(sw.march(scene, until=8.0, step=2.0))
    rest = list(sw.march(scene, until=8.0, step=2.0, state=whole[2].after))
    assert temperatures(rest[-1]) == pytest.approx(temperatures(whole[-1]), rel=1e-5)


def test_a_body_without_exchange_moves_as_one_without_a_temperature() -> None:
    given = {"heat": ContactHeat(share=1.0), "until": 3e-3}
    warm, cold = (slid(thermal=thermal, **given) for thermal in (COOL, None))
    for one, other in zip(warm, cold, strict=True):
        mine, theirs = (step.after.displacement["low"] for step in (one, other))
        np.testing.assert_allclose(mine, theirs, rtol=0.0, atol=1e-10 * np.abs(theirs).max())
        assert one.ledger.heat.rigid == {"top": COOL.temperature} and other.ledger.heat.rigid == {}
