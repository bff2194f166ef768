"""Heat across the contacts of solids: exchange of two lumps, gaps, tools, and the heat of friction, exactly."""

import numpy as np
import pytest

import softway as sw
from softway.bodies import Driven, Fixed, Off, Thermal, Uniform
from softway.contact import DualMortar, NodeToSurface
from softway.heat import ContactHeat
from softway.laws.heat.contact_heat import STEFAN_BOLTZMANN
from softway.meshes.generators.shapes import box, rectangle

RHO, C, SIDE = 1000.0, 500.0, 0.1
LUMP = sw.heat.Conduction(conductivity=1e5, capacity=C)
"""Conducts so well that a block has one temperature."""
CAPACITY = RHO * C * SIDE**2
ELASTIC = sw.LinearElastic(E=1e9, nu=0.0)


def block(low: float, temperature: float, cells: int = 2, dim: int = 2, **given: object) -> sw.Solid:
    """A square or cube, its lower side at the height ``low``."""
    origin = (0.0,) * (dim - 1) + (low,)
    if dim == 1:
        mesh = sw.meshes.Interval(length=SIDE, cells=cells, origin=low).build()
    else:
        mesh = (rectangle if dim == 2 else box)((SIDE,) * dim, (cells,) * dim, origin=origin)
    thermal = Thermal(law=LUMP, temperature=temperature)
    return sw.Solid(mesh=mesh, material=ELASTIC, density=RHO, thermal=thermal, **given)


def height(dim: int) -> str:
    return "xyz"[dim - 1]


def pressed(heat: ContactHeat, dim: int = 2, gap: float = 0.0, speed: float = -1e-7, **given: object) -> list[sw.Step]:
    """Two blocks, the upper one 100 K hotter, without inertia; the upper side moves with ``speed``."""
    ends = ("left", "right") if dim == 1 else ("bottom", "top")
    low = block(0.0, 300.0, 2, dim, supports=(Fixed(on=ends[0]),))
    drive = Driven(on=ends[1], components=height(dim), velocity=speed)
    aside = () if dim == 1 else (Fixed(on="left", components="x"),)
    aside += (Fixed(on="front", components="y"),) if dim == 3 else ()
    top = block(SIDE + gap, 400.0, 3 if dim == 2 else 2, dim, supports=(drive, *aside))
    contact = sw.Contact(between=(f"low.{ends[1]}", f"top.{ends[0]}"), heat=heat, **given)
    scene = sw.Scene(bodies={"low": low, "top": top}, contacts=(contact,), inertia=Off())
    return list(sw.march(scene, until=10.0, step=0.5))


def difference(step: sw.Step) -> float:
    found = [step.after.fields["temperature"][name].mean() for name in ("top", "low")]
    return float(found[0] - found[1])


def decay(conductance: float, time: float = 10.0) -> float:
    """Difference of the temperatures of two lumps that were 100 K apart."""
    return 100.0 * float(np.exp(-2.0 * conductance * time / (RHO * C * SIDE)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("dim", "method"),
    [(1, None), (2, None), (2, NodeToSurface()), (2, NodeToSurface(nodes="both")), (3, DualMortar())],
    ids=["bars", "mortar", "nodes", "both", "space"],
)
def test_two_lumps_exchange_heat_by_the_conductance(dim: int, method: object) -> None:
    steps = pressed(ContactHeat(conductance=200.0), dim, method=method)
    assert difference(steps[-1]) == pytest.approx(decay(200.0), rel=2e-4)
    heat = [s.ledger.heat for s in steps]
    assert max(abs(h.error) for h in heat) < 1e-12 * heat[0].content
    assert min(h.produced for h in heat) >= 0.0 and heat[-1].received == 0.0
    volume = {1: SIDE, 2: SIDE**2, 3: SIDE**3}[dim]
    passed = 0.5 * (100.0 - difference(steps[-1])) * RHO * C * volume
    assert -heat[-1].through[0] == pytest.approx(passed, rel=5e-4)


def test_each_with_each_exchanges_as_much() -> None:
    steps = pressed(ContactHeat(conductance=200.0), method=NodeToSurface())
    drive = Driven(on="top", components="y", velocity=-1e-7)
    scene = sw.Scene(
        bodies={"low": block(0.0, 300.0, supports=(Fixed(on="bottom"),)), "top": block(
            SIDE, 400.0, 3, supports=(drive, Fixed(on="left", components="x"))
        )},
        contacts=(sw.Contact(between="all", heat=ContactHeat(conductance=200.0)),), inertia=Off(),
    )  # fmt: skip
    *_, last = sw.march(scene, until=10.0, step=0.5)
    assert difference(last) == pytest.approx(difference(steps[-1]), rel=1e-3)


def test_the_conductance_follows_the_pressure() -> None:
    heat = ContactHeat(conductance=2e5, hardness=1e8)
    steps = pressed(heat, speed=-1e-6)
    mean = np.array([s.ledger.contacts["low.top-top.bottom"].force_n / SIDE for s in steps])
    assert mean[-1] == pytest.approx(1e9 * 9.75e-6 / (2.0 * SIDE), rel=1e-9)
    conductance = float((2e5 * (mean / 1e8) ** 0.95).sum() * 0.5)
    assert difference(steps[-1]) == pytest.approx(100.0 * np.exp(-2.0 * conductance / (RHO * C * SIDE)), rel=2e-4)


@pytest.mark.parametrize("dim", [2, 3])
def test_gas_and_radiation_cross_a_gap(dim: int) -> None:
    gap, method = 1e-3, DualMortar()
    gas = pressed(ContactHeat(gas=0.5, roughness=1e-4), dim, gap, 0.0, method=method)
    assert difference(gas[-1]) == pytest.approx(decay(0.5 / 1.1e-3, 10.0), rel=2e-4)
    radiant = pressed(ContactHeat(emissivity=0.8), dim, gap, 0.0, method=method)
    # dT/dt is that of the difference of the fourth powers, nearly steady in ten seconds
    rate = 2.0 * 0.8 * STEFAN_BOLTZMANN * (400.0**4 - 300.0**4) / (RHO * C * SIDE)
    assert 100.0 - difference(radiant[-1]) == pytest.approx(10.0 * rate, rel=2e-3)
    assert min(s.ledger.heat.produced for s in radiant) > 0.0


def test_a_tool_takes_heat_at_its_temperature() -> None:
    body = block(
        0.0, 400.0, supports=(Driven(on="top", components="y", velocity=-1e-7), Fixed(on="left", components="x"))
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    heat = ContactHeat(conductance=200.0, tool_temperature=300.0)
    scene = sw.Scene(
        bodies={"b": body, "floor": floor}, contacts=(sw.Contact(between=("b.bottom", "floor"), heat=heat),),
        inertia=Off(),
    )  # fmt: skip
    steps = list(sw.march(scene, until=10.0, step=0.5))
    over = steps[-1].after.fields["temperature"]["b"].mean() - 300.0
    assert over == pytest.approx(100.0 * np.exp(-200.0 * 10.0 / (RHO * C * SIDE)), rel=2e-4)
    last = steps[-1].ledger.heat
    assert last.brought == pytest.approx(-(100.0 - over) * CAPACITY, rel=5e-4)
    assert last.through == pytest.approx((-last.brought,)) and abs(last.error) < 1e-12 * last.content
    assert min(s.ledger.heat.produced for s in steps) > 0.0


def braked(tool_temperature: float | None) -> sw.Step:
    """A block that slides on a floor until friction has stopped it; the floor takes .3 of the heat. The last step."""
    body = sw.Solid(
        mesh=rectangle((0.02, 0.01), (4, 2)), material=sw.LinearElastic(E=1e7, nu=0.3), density=2000.0,
        velocity=Uniform(value=(3.0, 0.0)),
        thermal=Thermal(law=sw.heat.Conduction(conductivity=0.3, capacity=1000.0), temperature=300.0),
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    heat = ContactHeat(share=0.7, tool_temperature=tool_temperature)
    contact = sw.Contact(between=("b.bottom", "floor"), friction=sw.Coulomb(mu=0.25), heat=heat)
    scene = sw.Scene(
        bodies={"b": body, "floor": floor}, contacts=(contact,), loads=(sw.Gravity(acceleration=(0.0, -1e3)),)
    )
    *_, last = sw.march(scene, until=5e-3, step=5e-5)
    return last


@pytest.mark.slow
def test_friction_heat_of_a_tool_has_the_entropy_of_its_temperature() -> None:
    """The solid, some hundredths of a kelvin warmer than 300 K, takes 0.7 of the heat; the tool 0.3, at 250 K."""
    with_one, without = braked(250.0), braked(None)
    given = with_one.ledger.dissipation
    assert given > 1.0 and with_one.ledger.heat.friction == pytest.approx(0.7 * given, rel=1e-9)
    assert without.ledger.heat.entropy == pytest.approx(0.7 * given / 300.0, rel=2e-4)
    assert with_one.ledger.heat.entropy - without.ledger.heat.entropy == pytest.approx(0.3 * given / 250.0, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("conductance", [None, 200.0])
def test_heat_passes_a_tie(conductance: float | None) -> None:
    """A wall of two layers between two temperatures: freely, or with the fall across the glue."""
    law = sw.heat.Conduction(conductivity=10.0, capacity=C)
    low, top = (
        sw.Solid(
            mesh=rectangle((SIDE, SIDE), (k, 4), origin=(0.0, y)), material=ELASTIC, density=RHO,
            thermal=Thermal(law=law, temperature=350.0, expansion=1e-5, reference=350.0),
            supports=(Fixed(on="bottom"),) if y == 0.0 else (),
        )
        for k, y in ((2, 0.0), (3, SIDE))
    )  # fmt: skip
    scene = sw.Scene(
        bodies={"low": low, "top": top},
        ties=(sw.Tie(between=("low.top", "top.bottom"), conductance=conductance),),
        loads=(sw.heat.Temperature(on="low.bottom", value=300.0), sw.heat.Temperature(on="top.top", value=400.0)),
        inertia=Off(),
    )
    *_, last = sw.march(scene, until=1.2e4, step=150.0)
    glue = 200.0 if conductance else 1e3 * 10.0 / (SIDE / 4.0)
    flux = 100.0 / (2.0 * SIDE / 10.0 + 1.0 / glue)
    temperature = last.after.fields["temperature"]
    for name, below in (("low", 300.0), ("top", 300.0 + flux * (SIDE / 10.0 + 1.0 / glue))):
        y = scene.bodies[name].mesh.points[:, 1] - (0.0 if name == "low" else SIDE)
        np.testing.assert_allclose(temperature[name][:, 0], below + flux * y / 10.0, rtol=5e-8)
    assert abs(last.ledger.heat.error) < 1e-11 * last.ledger.heat.content


def rubbing(heat: ContactHeat, conductivities: tuple[float, float] = (1e5, 1e5)) -> sw.Step:
    """A block that slides by a millimetre over another one, pressed by 1 MPa; the last step."""
    laws = [sw.heat.Conduction(conductivity=k, capacity=C) for k in conductivities]
    mesh = (
        rectangle((3.0 * SIDE, SIDE), (6, 2), origin=(-SIDE, 0.0)),
        rectangle((SIDE, SIDE), (2, 2), origin=(0.0, SIDE)),
    )
    supports = (Fixed(on="bottom"),), (
        Driven(on="top", components="x", velocity=1e-3), Driven(on="top", components="y", velocity=-1e-4)
    )  # fmt: skip
    bodies = {
        name: sw.Solid(mesh=m, material=ELASTIC, density=RHO, supports=s, thermal=Thermal(law=k, temperature=300.0))
        for name, m, s, k in zip(("low", "top"), mesh, supports, laws, strict=True)
    }
    contact = sw.Contact(between=("low.top", "top.bottom"), friction=sw.Coulomb(mu=0.2), heat=heat)
    *_, last = sw.march(sw.Scene(bodies=bodies, contacts=(contact,), inertia=Off()), until=1.0, step=0.1)
    return last


def gained(step: sw.Step, name: str, volume: float) -> float:
    return float((step.after.fields["temperature"][name] - 300.0).mean()) * RHO * C * volume


@pytest.mark.parametrize(
    ("share", "conductivities", "expected"),
    [(None, (1e5, 1e5), 0.5), (None, (4e5, 1e5), 2.0 / 3.0), (0.2, (1e5, 1e5), 0.2)],
)
def test_friction_heats_both_bodies(share: float | None, conductivities: tuple[float, float], expected: float) -> None:
    last = rubbing(ContactHeat(share=share), conductivities)
    heat = last.ledger.heat
    assert heat.friction == pytest.approx(last.ledger.dissipation, rel=1e-12) and heat.friction > 5.0
    assert gained(last, "low", 3.0 * SIDE**2) == pytest.approx(expected * heat.friction, rel=5e-2)
    assert heat.received == pytest.approx(heat.friction, rel=1e-12) and abs(heat.error) < 1e-12 * heat.content


def thrown(**given: object) -> list[sw.Step]:
    """A hot block is thrown obliquely at a cold one, with friction, heat and expansion."""
    law = sw.heat.Conduction(conductivity=50.0, capacity=500.0)

    def of(
        size: tuple[float, float], cells: tuple[int, int], origin: tuple[float, float], v: tuple[float, float], T: float
    ) -> sw.Solid:
        return sw.Solid(
            mesh=rectangle(size, cells, origin=origin), material=sw.NeoHookean(E=2e9, nu=0.3), density=7800.0,
            velocity=Uniform(value=v), thermal=Thermal(law=law, temperature=T, expansion=12e-6),
        )  # fmt: skip

    bodies = {
        "low": of((0.06, 0.02), (6, 2), (-0.01, 0.0), (0.0, 0.0), 300.0),
        "up": of((0.04, 0.02), (4, 2), (0.0, 0.02002), (4.0, -1.0), 400.0),
    }
    contact = sw.Contact(
        between=("low.top", "up.bottom"), friction=sw.Coulomb(mu=0.3), heat=ContactHeat(conductance=1e4)
    )
    return list(sw.march(sw.Scene(bodies=bodies, contacts=(contact,)), until=1.2e-4, step=5e-6, **given))


@pytest.mark.slow
def test_an_impact_with_heat_of_friction_keeps_energy_and_momentum() -> None:
    steps = thrown()
    ledgers = [s.ledger for s in steps]
    assert any(e.kind == "release" for s in steps for e in s.events)
    whole = [k.energy_kinetic + k.energy_strain + k.heat.content for k in ledgers]
    kinetic, last = ledgers[0].energy_kinetic, ledgers[-1]
    assert np.ptp(whole) < 1e-10 * kinetic and last.heat.friction > 0.1 * kinetic
    assert max(abs(k.energy_error) for k in ledgers) < 1e-12 * kinetic
    np.testing.assert_allclose(last.momentum, ledgers[0].momentum, atol=1e-10 * abs(ledgers[0].momentum[0]))
    assert min(k.heat.produced + k.heat.rounding for k in ledgers) >= 0.0 and last.heat.entropy > 0.0
    # the heat of friction is what friction dissipates, and the thermal stress takes the difference
    assert abs(last.heat.received - last.dissipation) < 1e-12 * last.dissipation
    again = thrown(state=steps[11].march_state)
    for name in ("low", "up"):
        np.testing.assert_array_equal(again[-1].after.displacement[name], steps[-1].after.displacement[name])
        mine, same = (s[-1].after.fields["temperature"][name] for s in (steps, again))
        np.testing.assert_array_equal(mine, same)
    assert again[-1].ledger.heat == last.heat
