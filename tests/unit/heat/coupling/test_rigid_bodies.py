"""Rigid bodies with one temperature beside solids with heat: exchange with a block, friction, loads, records."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies import Affine, Fixed, RigidThermal, Thermal
from softway.heat import ContactHeat
from softway.laws.heat.contact_heat import STEFAN_BOLTZMANN
from softway.mechanisms import HeatLink, Mechanism, PlaneStop, PointForce, Rigid, Slider
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


def sliding(heat: ContactHeat, thermal: RigidThermal | None) -> sw.Scene:
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
    return replace(scene, bodies={"low": layer}, contacts=(contact,), mechanism=mechanism)


def slid(heat: ContactHeat, thermal: RigidThermal | None, until: float = 0.03, **given: object) -> list[sw.Step]:
    """Steps of the plate that slides."""
    return list(sw.march(sliding(heat, thermal), until=until, step=1e-3, **given))  # type: ignore[arg-type]


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


def test_friction_heat_of_a_tool_is_in_what_passes_and_that_of_a_rigid_body_is_not() -> None:
    """Of what friction dissipates a rigid body takes 0.7, without a temperature like a tool."""
    tool, rigid = (slid(ContactHeat(share=0.3), thermal, until=2e-3)[-1].ledger for thermal in (None, COOL))
    for ledger, own, passed in ((tool, 0.3, 0.7), (rigid, 1.0, 0.0)):
        rubbed = ledger.heat.friction / own
        assert rubbed == pytest.approx(ledger.dissipation, rel=1e-4)  # the rest: work against the thermal stress
        assert ledger.heat.through[0] == pytest.approx(passed * rubbed, rel=1e-10)
    taken = COOL.capacity * (rigid.heat.rigid["top"] - COOL.temperature)
    assert taken == pytest.approx(0.7 * rigid.heat.friction, rel=1e-10)


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


ONE, OTHER = RigidThermal(temperature=300.0, capacity=2.0), RigidThermal(temperature=400.0, capacity=5.0)
FLOOR = PlaneStop(between=("a", "b"), point=(5.0, 0.0), plane=(5.0, 0.0), normal=(0.0, 1.0), friction=0.3)
RATE = 1.5 * (1.0 / 2.0 + 1.0 / 5.0)
"""Rate at which the difference of their temperatures falls with 1.5 W/K."""


def pair(link: HeatLink | tuple[HeatLink, ...], stops: dict[str, PlaneStop] | None = None, **given: object) -> sw.Scene:
    """Two rigid bodies, one above the other and held by a guide along x, far from a solid with heat."""
    solid = sw.Solid(
        mesh=rectangle((SIDE, SIDE), (1, 1)), material=sw.LinearElastic(E=1e5, nu=0.0), density=1.0,
        supports=(Fixed(on="bottom"),), thermal=Thermal(law=LUMP, temperature=300.0),
    )  # fmt: skip
    gravity, along = given.pop("gravity", (0.0, -10.0)), float(given.pop("along", 0.0))  # type: ignore[arg-type]
    low = Rigid(mass=3.0, centre=(5.0, -1.0), inertia=1.0, velocity=(along, 0.0), thermal=ONE)
    above = {"mass": 2.0, "centre": (5.0, 0.0), "inertia": 1.0, "velocity": (along, 0.0), "thermal": OTHER, **given}
    mechanism = Mechanism(
        bodies={"a": low, "b": Rigid(**above)},  # type: ignore[arg-type]
        joints={"guide": Slider(between=("ground", "a"), at=(5.0, -1.0), axis=(1.0, 0.0))},
        stops=stops or {}, heat_links=link if isinstance(link, tuple) else (link,), gravity=gravity,
    )  # fmt: skip
    return sw.Scene(bodies={"solid": solid}, mechanism=mechanism)


def whole(step: sw.Step) -> float:
    """Energy with heat, less the work of loads [J]."""
    ledger = step.ledger
    return ledger.energy_kinetic + ledger.energy_strain + ledger.heat.content - ledger.work_external


def difference(step: sw.Step) -> float:
    return float(step.ledger.heat.rigid["b"] - step.ledger.heat.rigid["a"])


def test_two_bodies_exchange_heat_as_two_lumps() -> None:
    """``exp(-g (1/C + 1/C) t)``, of second order; through a stop while it is closed."""
    always, errors = HeatLink(between=("a", "b"), conductance=1.5), []
    for slabs in (10, 20, 40):
        *_, last = sw.march(pair(always, gravity=None), until=1.0, step=1.0 / slabs)
        errors.append(difference(last) / 100.0 - np.exp(-RATE))
        rigid = last.ledger.heat.rigid
        assert 2.0 * rigid["a"] + 5.0 * rigid["b"] == pytest.approx(2.0 * 300.0 + 5.0 * 400.0, rel=1e-14)
    assert abs(errors[-1]) < 6e-5 and abs(errors[0] / errors[1]) > 3.8 and abs(errors[1] / errors[2]) > 3.9
    stop = HeatLink(stop="floor", conductance=1.5, share=0.3)
    rests = replace(FLOOR, friction=0.0)
    *_, through = sw.march(pair(stop, {"floor": rests}, along=1.0), until=1.0, step=1.0 / 40)
    assert difference(through) == pytest.approx(difference(last), rel=1e-12)
    heat = through.ledger.heat
    assert heat.friction == pytest.approx(0.0, abs=1e-13) and heat.entropy > 0.0


def test_a_body_that_flies_exchanges_no_heat_through_its_stop() -> None:
    """It is thrown up, and lands after .4 s; what the inelastic impact dissipates heats both."""
    stop = HeatLink(stop="floor", conductance=1.5, share=0.3)
    floor = {"floor": replace(FLOOR, friction=0.0)}
    steps = list(sw.march(pair(stop, floor, velocity=(0.0, 2.0)), until=0.5, step=0.03))
    flies = [step for step in steps if step.after.time < 0.39]
    assert all(step.ledger.heat.rigid == {"a": 300.0, "b": 400.0} for step in flies) and len(flies) == 13
    heat = steps[-1].ledger.heat
    assert heat.friction == pytest.approx(0.5 * 2.0 * 2.0**2, rel=1e-12)
    a, b = (2.0 * (heat.rigid["a"] - 300.0), 5.0 * (heat.rigid["b"] - 400.0))
    assert a + b == pytest.approx(heat.friction, rel=1e-11)
    left = 100.0 * np.exp(-RATE * 0.1)
    assert difference(steps[-1]) == pytest.approx(left + 0.7 * 4.0 / 5.0 - 0.3 * 4.0 / 2.0, abs=0.1)


def test_a_body_that_slides_on_another_warms_up_both_by_their_shares() -> None:
    """Until both have the velocity of their centre of mass: ``m1 m2/(m1 + m2) v^2/2``."""
    steps = list(sw.march(pair(HeatLink(stop="f", share=0.3), {"f": FLOOR}, velocity=(1.0, 0.0)), until=0.5, step=0.02))
    ledger, lost = steps[-1].ledger, 0.5 * 2.0 * 3.0 / 5.0
    assert ledger.dissipation == pytest.approx(lost, rel=1e-13)
    assert ledger.heat.friction == ledger.heat.received == pytest.approx(ledger.dissipation, rel=1e-14)
    rise = {name: ledger.heat.rigid[name] - start for name, start in (("a", 300.0), ("b", 400.0))}
    assert rise["a"] == pytest.approx(0.3 * lost / 2.0, rel=1e-11)
    assert rise["b"] == pytest.approx(0.7 * lost / 5.0, rel=1e-11)
    assert np.ptp([whole(step) for step in steps]) < 1e-10 * lost
    assert min(step.ledger.heat.produced + step.ledger.heat.rounding for step in steps) >= 0.0


def test_effusivities_share_what_a_stop_dissipates() -> None:
    scene = pair(HeatLink(stop="f"), {"f": FLOOR}, velocity=(1.0, 0.0))
    with pytest.raises(sw.errors.InputError, match="nothing says"):
        sw.build(scene)
    with pytest.raises(sw.errors.InputError, match="9 W/.m K. without a density") as found:
        pair(HeatLink(stop="f"), {"f": FLOOR}, velocity=(1.0, 0.0), thermal=replace(OTHER, conductivity=9.0))
    assert found.value.where == "thermal.conductivity"
    low = Rigid(density=1.5, shape=Block(low=(4.0, -1.5), high=(6.0, -0.5)), thermal=replace(ONE, conductivity=4.0))
    shape, warm = Block(low=(4.5, -0.25), high=(5.5, 0.25)), replace(OTHER, conductivity=9.0)
    top = Rigid(density=4.0, shape=shape, velocity=(1.0, 0.0), thermal=warm)
    *_, last = sw.march(
        replace(scene, mechanism=replace(scene.mechanism, bodies={"a": low, "b": top})), until=0.5, step=0.02
    )
    one, other = np.sqrt(4.0 * 1.5 * 2.0 / 3.0), np.sqrt(9.0 * 4.0 * 5.0 / 2.0)
    assert last.ledger.heat.friction == pytest.approx(0.6, rel=1e-12)
    assert 2.0 * (last.ledger.heat.rigid["a"] - 300.0) == pytest.approx(one / (one + other) * 0.6, rel=1e-10)


def tumbling() -> sw.Scene:
    """A block that falls turning on a body below it, bounces and slides on its two corners, which conduct heat."""
    corners = {
        name: replace(FLOOR, point=(5.0 + x, 0.0), mu_s=0.5, restitution=0.4)
        for name, x in (("left", -0.3), ("right", 0.3))
    }
    links = tuple(HeatLink(stop=name, conductance=0.5, share=share) for name, share in (("left", 0.3), ("right", 0.6)))
    start = {"centre": (5.0, 0.2), "velocity": (0.6, 0.3), "spin": 0.5, "inertia": 0.1}
    return pair(links, corners, **start)


def test_a_block_that_tumbles_keeps_its_energy_with_heat_and_goes_on_with_the_same_bits() -> None:
    steps = list(sw.march(tumbling(), until=0.6, step=0.02))
    ledgers = [step.ledger for step in steps]
    assert np.ptp([whole(step) for step in steps]) < 1e-10 * ledgers[0].energy_kinetic
    for ledger in ledgers:
        assert ledger.heat.friction == pytest.approx(ledger.dissipation, rel=1e-12, abs=1e-15)
        assert ledger.heat.produced + ledger.heat.rounding >= 0.0
    assert ledgers[-1].dissipation > 0.3 and {e.contact for s in steps for e in s.events} == {"left", "right"}
    rest = list(sw.march(tumbling(), until=0.6, step=0.02, state=unpacked(*packed(steps[14].march_state))))
    assert rest[-1].ledger.heat == ledgers[-1].heat
    np.testing.assert_array_equal(rest[-1].after.rigid["b"].centre, steps[-1].after.rigid["b"].centre)


@pytest.mark.slow
def test_a_weight_on_a_plate_that_slides_on_a_layer_heats_by_both() -> None:
    """Contact with a solid and a stop with friction at once: all that is dissipated is heat."""
    heat = ContactHeat(conductance=100.0, share=0.3)
    scene = sliding(heat, COOL)
    plate, top = scene.mechanism, scene.mechanism.bodies["top"].shape
    at = (0.5 * SIDE, float(top.high[1]))
    weight = Rigid(mass=20.0, centre=at, inertia=1e3, thermal=replace(COOL, temperature=280.0))
    stop = PlaneStop(between=("top", "weight"), point=at, plane=at, normal=(0.0, 1.0), friction=0.2)
    mechanism = replace(
        plate, bodies={**plate.bodies, "weight": weight}, stops={"seat": stop}, gravity=(0.0, -10.0),
        heat_links=(HeatLink(stop="seat", share=0.5, conductance=10.0),),
    )  # fmt: skip
    ledgers = [s.ledger for s in sw.march(replace(scene, mechanism=mechanism), until=0.01, step=1e-3)]
    kinetic = ledgers[0].energy_kinetic
    energy = [k.energy_kinetic + k.energy_strain + k.heat.content - k.work_external for k in ledgers]
    assert np.ptp(energy) < 1e-10 * kinetic and ledgers[-1].dissipation > 0.1 * kinetic
    assert abs(ledgers[-1].heat.received - ledgers[-1].dissipation) < 1e-11 * kinetic
    assert min(k.heat.produced + k.heat.rounding for k in ledgers) >= 0.0


@pytest.mark.parametrize(
    ("link", "where"),
    [
        ({"between": ("a", "c"), "conductance": 1.0}, "heat_links[0].between"),
        ({"between": ("a", "ground"), "conductance": 1.0}, "heat_links[0].between"),
        ({"between": ("a", "a"), "conductance": 1.0}, "heat_links[0].between"),
        ({"stop": "wall"}, "heat_links[0].stop"),
        ({}, "between"),
        ({"between": ("a", "b"), "stop": "f"}, "between"),
        ({"between": ("a", "b")}, "conductance"),
        ({"stop": "f", "conductance": -1.0}, "conductance"),
        ({"stop": "f", "share": 2.0}, "share"),
        ({"stop": "f"}, "heat_links[0].share"),
    ],
)
def test_heat_that_cannot_pass_is_refused(link: dict[str, object], where: str) -> None:
    with pytest.raises(sw.errors.InputError) as found:
        sw.build(pair(HeatLink(**link), {"f": FLOOR}))  # type: ignore[arg-type]
    assert found.value.where == where and found.value.remedy
