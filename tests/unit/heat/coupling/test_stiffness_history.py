"""Moduli by the temperature of laws with a history: closed forms, both laws of an impact, same bits, refusals."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import softway as sw
from softway.bodies import Driven, Fixed, Thermal
from softway.laws.law import RateLaw
from softway.marching.start.initial_state import initial_state
from softway.record.storage.serialisation import packed, unpacked
from softway.scenario.scenario import Scenario, Time

START = 300.0
CURVED = sw.heat.StiffnessTable(temperatures=(280.0, 305.0, 320.0, 360.0), values=(1.3, 1.0, 0.75, 0.6))
MILD = sw.heat.StiffnessTable(temperatures=(280.0, 320.0, 360.0, 400.0), values=(1.1, 1.0, 0.85, 0.65))
LINE = sw.heat.StiffnessTable(temperatures=(200.0, 800.0), values=(1.2, 0.2))
WEAKER = sw.laws.SofteningTable(temperatures=(320.0, 720.0), values=(1.0, 0.1))
BAR = sw.J2(E=1.0, nu=0.3, yield_stress=0.005, softening=WEAKER, rate=sw.laws.Jaumann(increment="polar"))
METAL = {"E": 1.0, "nu": 0.3, "yield_stress": 0.2}
LAWS = {
    "hypoelastic": sw.laws.Hypoelastic(E=1.0, nu=0.3),
    "perfect": sw.J2(**METAL),
    "linear": sw.J2(**METAL, hardening=sw.laws.LinearHardening(modulus=0.1)),
    "kinematic": sw.J2(**METAL, kinematic=0.1, rate=sw.laws.Logarithmic()),
    "Voce": sw.J2(
        **METAL, hardening=sw.laws.Voce(saturation=0.3, exponent=5.0), flow=sw.laws.Perzyna(drag=0.05, reference=1.0)
    ),
    "Johnson-Cook": sw.J2(
        **METAL,
        hardening=sw.laws.PowerHardening(modulus=0.2, exponent=0.3),
        flow=sw.laws.JohnsonCook(C=0.02, reference=0.01),
        softening=sw.laws.JohnsonCookSoftening(reference=280.0, melting=360.0),
    ),
    "Maxwell": sw.laws.Maxwell(E=1.0, nu=0.3, shares=(0.5,), times=(1.0,)),
    "Kelvin": sw.laws.Kelvin(E=1.0, nu=0.3, shear_viscosity=0.2, bulk_viscosity=0.1),
}
DASHPOT = sw.laws.Kelvin(E=1.0, nu=0.0, shear_viscosity=0.5, bulk_viscosity=1.0 / 3.0)
"""Along a bar the stress is that of the spring plus the rate of the strain."""


def heated(law: RateLaw, table: sw.heat.StiffnessTable | None, **given: object) -> sw.Scene:
    """A solid without inertia that is heated by 100 K/s without conduction, from 320 K on."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-12, capacity=1e3), temperature=320.0, heating=0.0, stiffness=table,
        expansion=given.pop("expansion", 0.0),
    )  # fmt: skip
    body = sw.Solid(material=law, density=1.0, thermal=heat, **given)
    load = sw.heat.HeatSource(of="b", value=1e5)
    return sw.Scene(bodies={"b": body}, loads=(load,), inertia=sw.bodies.Off())


def held(law: RateLaw, strain: float, table: sw.heat.StiffnessTable = LINE) -> list[tuple[float, float, float]]:
    """Temperature, stress and plastic strain of a bar that is stretched, then heated between fixed ends."""
    ends = (Fixed(on="left"), Driven(on="right", velocity=0.0))
    scene = heated(
        law, table, mesh=sw.meshes.Interval(length=1.0, cells=1), supports=ends, displacement=lambda x: strain * x
    )
    found = []
    for step in sw.march(scene, until=4.0, step=0.2):
        state, theta = step.after.memory["b"], float(step.after.fields["temperature"]["b"].mean())
        factor = float(table.curve().at(np.array(theta)))
        found.append((theta, factor * float(state.stress[0, 0, 0]), float(state.law["plastic_strain"][0])))
    return found


CLAMPED = """
inertia = "Off"
loads = [{ kind = "HeatSource", of = "b", value = "1e5 W/m^3" }]
time = { end = 4, step = 0.2 }
[bodies.b]
mesh = { kind = "Interval", length = 1, cells = 2 }
material = { kind = "J2", E = 1, nu = 0.3, yield_stress = 1 }
density = 1
supports = [{ on = "left" }, { on = "right" }]
[bodies.b.thermal]
law = { conductivity = 1e-12, capacity = 1e3 }
temperature = 320
expansion = 1e-5
heating = 0
stiffness = { temperatures = [200, 800], values = [1.2, 0.2] }
"""


def test_a_clamped_bar_has_the_stress_of_its_modulus_at_the_temperature() -> None:
    """``-m E alpha (theta - theta_r)``: elastic strain counts, not the history of the modulus."""
    frames = list(sw.run(sw.loads(CLAMPED)).fields)[1:]
    theta = np.array([frame["temperature"].mean() for frame in frames])
    stress = np.array([frame.stress[:, 0].mean() for frame in frames])
    np.testing.assert_allclose(stress, -LINE.curve().at(theta) * 1e-5 * (theta - 320.0), rtol=1e-12)
    assert theta[-1] == pytest.approx(720.0) and stress.argmin() < len(stress) - 1


def test_a_bar_that_has_yielded_keeps_its_elastic_strain_where_it_gets_hot() -> None:
    """``m E e`` with the elastic strain e at which it yielded when cold."""
    e = 0.005 / float(LINE.curve().at(np.array(320.0)))
    for theta, stress, plastic in held(replace(BAR, softening=None), np.expm1(2.0 * e)):
        assert stress == pytest.approx(float(LINE.curve().at(np.array(theta))) * e, rel=1e-11)
        assert plastic == pytest.approx(e, rel=1e-11)


def test_a_hot_bar_is_limited_by_its_yield_stress() -> None:
    """The least of ``m E e`` and of the yield stress at the temperature in the middle of the slab."""
    e = 0.0045
    found = np.array(held(BAR, np.expm1(e)))
    elastic = LINE.curve().at(found[:, 0]) * e
    limit = 0.005 * WEAKER.at(found[:, 0] - 10.0)
    np.testing.assert_allclose(found[:, 1], np.minimum(elastic, limit), rtol=1e-10)
    assert (elastic < limit).any() and (limit < elastic).any() and found[-1, 2] > 0.002


def test_a_block_held_between_walls_yields_by_its_thermal_stress() -> None:
    """``-m E alpha (theta - theta_r)`` up to the yield stress, to the square of the strains."""
    walls = tuple(
        Fixed(on=on, components=c) for on, c in (("left", "x"), ("right", "x"), ("front", "y"), ("bottom", "z"))
    )
    law = sw.J2(E=1.0, nu=0.3, yield_stress=2e-5, softening=WEAKER)
    block = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 1))
    scene = heated(law, LINE, mesh=block, supports=walls, expansion=1e-7)
    scenario = Scenario(bodies=scene.bodies, loads=scene.loads, inertia=scene.inertia, time=Time(end=4.0, step=0.2))
    frames = list(sw.run(scenario).fields)[1:]
    theta = np.array([frame["temperature"].mean() for frame in frames])
    stress = np.array([frame.stress[:, 0].mean() for frame in frames])
    elastic = LINE.curve().at(theta) * 1e-7 * (theta - 320.0)
    limit = 2e-5 * WEAKER.at(theta - 10.0)
    np.testing.assert_allclose(stress, -np.minimum(elastic, limit), rtol=2e-4)
    assert (elastic < limit).sum() > 5 and (limit < elastic).sum() > 5


def crept(steps: int, temperature: float, load: float = 1e-6) -> tuple[np.ndarray, np.ndarray]:
    """Times, and strains of a bar of spring and dashpot that is pulled at a constant temperature up to a stress."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1.0, capacity=1e6), temperature=temperature, stiffness=LINE
    )  # fmt: skip
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=2), material=DASHPOT, density=1.0, thermal=heat,
        supports=(Fixed(on="left"),),
    )  # fmt: skip
    pull = sw.bodies.Traction(on="b.right", value=load, ramp=sw.bodies.Ramp(times=(0.0, 2.0), factors=(0.0, 1.0)))
    scene = sw.Scene(bodies={"b": body}, loads=(pull,), inertia=sw.bodies.Off())
    found = [(s.after.time, s.after.displacement["b"][-1, 0]) for s in sw.march(scene, until=2.0, step=2.0 / steps)]
    return np.array(found)[:, 0], np.array(found)[:, 1]


@pytest.mark.slow
@pytest.mark.parametrize(("temperature", "factor"), [(320.0, 1.0), (560.0, 0.6)])
def test_a_bar_of_spring_and_dashpot_creeps_by_the_modulus_of_its_temperature(
    temperature: float, factor: float
) -> None:
    """``load/(2 m) (t - (1 - exp(-m t))/m)``: the viscosity is one at every temperature.  Of first order."""
    errors = []
    for slabs in (10, 20, 40):
        times, strains = crept(slabs, temperature)
        exact = 0.5e-6 / factor * (times + np.expm1(-factor * times) / factor)
        errors.append(float(np.abs(strains - exact).max() / exact[-1]))
    assert errors[-1] < 0.02 and 1.8 < errors[0] / errors[1] < 2.2 and 1.9 < errors[1] / errors[2] < 2.1


def test_a_bar_of_spring_and_dashpot_that_gets_hot_has_the_stress_of_both() -> None:
    """``m E e`` plus the rate of the strain."""
    ends = (Fixed(on="left"), Driven(on="right", velocity=1e-4))
    law = replace(DASHPOT, rate=sw.laws.Jaumann(increment="polar"))
    scene = heated(law, LINE, mesh=sw.meshes.Interval(length=1.0, cells=1), supports=ends)
    scenario = Scenario(bodies=scene.bodies, loads=scene.loads, inertia=scene.inertia, time=Time(end=4.0, step=0.2))
    frames = list(sw.run(scenario).fields)
    strain = np.log1p([frame.displacement[-1, 0] for frame in frames])
    theta = np.array([frame["temperature"].mean() for frame in frames[1:]])
    stress = np.array([frame.stress[:, 0].mean() for frame in frames[1:]])
    np.testing.assert_allclose(stress, LINE.curve().at(theta) * strain[1:] + np.diff(strain) / 0.2, rtol=1e-10)
    assert theta[-1] == pytest.approx(720.0) and strain[-1] > 3.9e-4


def pulled(law: RateLaw, slabs: int) -> tuple[sw.Step, ...]:
    """One cell without conduction that is stretched to one and a half and back, with inertia."""
    heat = Thermal(law=sw.heat.Conduction(conductivity=1e-12, capacity=0.1), temperature=START, stiffness=CURVED)
    ends = (Fixed(on="left"), Driven(on="right", velocity=(1.0, 1.0, -1.0, -1.0), times=(0.0, 0.4, 0.6, 1.0)))
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1), material=law, density=1.0, thermal=heat, velocity=lambda x: x,
        supports=ends,
    )  # fmt: skip
    return tuple(sw.march(sw.Scene(bodies={"b": body}), until=1.0, step=1.0 / slabs))


@pytest.mark.parametrize("law", ["hypoelastic", "elastic J2"])
def test_an_adiabatic_cycle_keeps_energy_and_entropy(law: str) -> None:
    """``c ln theta - m' G`` is constant, with the energy G stored at m = 1; the temperature returns to that before."""
    steps = pulled(LAWS["hypoelastic"] if law == "hypoelastic" else sw.J2(E=1.0, nu=0.3, yield_stress=9.0), 10)
    curve = CURVED.curve()
    for step in steps:
        theta = float(step.after.fields["temperature"]["b"].mean())
        entropy = 0.1 * np.log(theta / START) - float(curve.slope(np.array(theta)) * step.after.memory["b"].stored[0])
        assert abs(entropy) < 1e-15
    books = [s.ledger for s in steps]
    whole = [b.energy_kinetic + b.energy_strain + b.heat.content - b.work_external for b in books]
    coldest = min(float(s.after.fields["temperature"]["b"].mean()) for s in steps)
    assert np.ptp(whole) < 1e-12 and coldest < START - 2.5
    np.testing.assert_allclose(steps[-1].after.fields["temperature"]["b"], START, rtol=1e-12)


def swinging(law: RateLaw, table: sw.heat.StiffnessTable | None) -> sw.Scene:
    """A bar that swings from one end without conduction, and yields."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-12, capacity=0.1), temperature=START, heating=1.0, stiffness=table
    )  # fmt: skip
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4), material=law, density=1.0, thermal=heat,
        velocity=lambda x: 0.6 * np.sin(0.5 * np.pi * x), supports=(Fixed(on="left"),),
    )  # fmt: skip
    return sw.Scene(bodies={"b": body})


def flown(law: RateLaw, table: sw.heat.StiffnessTable | None, until: float = 0.6, **given: object) -> list[sw.Step]:
    """Steps of the bar that swings."""
    scene, method = swinging(law, table), sw.FixedPoint(tolerance=1e-13)
    return list(sw.march(scene, until=until, step=0.05, method=method, **given))  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.few(3)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_an_adiabatic_bar_keeps_its_energy_and_entropy_never_falls(law: RateLaw) -> None:
    steps, kinetic = flown(law, CURVED), 0.06
    books = [s.ledger for s in steps]
    whole = [b.energy_kinetic + b.energy_strain + b.heat.content for b in books]
    assert np.ptp(whole) < 1e-11 * kinetic
    assert max(abs(b.energy_error) for b in books) < 1e-14
    assert min(b.heat.produced for b in books) > -1e-16
    spent = np.array([s.after.memory["b"].dissipated for s in steps])
    assert (np.diff(spent, axis=0) >= 0.0).all()
    assert spent[-1].max() > 0.01 or isinstance(law, sw.laws.Hypoelastic)
    cold = flown(law, None)
    assert sum(s.report.iterations for s in steps) <= 1.2 * sum(s.report.iterations for s in cold)


def test_a_table_of_one_changes_no_bit() -> None:
    one = sw.heat.StiffnessTable(temperatures=(250.0, 300.0, 400.0), values=(1.0, 1.0, 1.0))
    for name in ("kinematic", "Maxwell", "Kelvin"):
        mine, same = flown(LAWS[name], one, 0.3)[-1], flown(LAWS[name], None, 0.3)[-1]
        for field in ("displacement", "velocity"):
            np.testing.assert_array_equal(getattr(mine.after, field)["b"], getattr(same.after, field)["b"])
        np.testing.assert_array_equal(mine.after.memory["b"].stress, same.after.memory["b"].stress)
        assert mine.ledger.energy_strain == same.ledger.energy_strain


def test_a_bar_with_a_dashpot_goes_on_with_the_same_bits() -> None:
    whole = flown(LAWS["Kelvin"], CURVED, 0.3)
    *_, same = flown(LAWS["Kelvin"], CURVED, 0.3, state=unpacked(*packed(whole[2].march_state)))
    for name in ("stress", "viscous", "stiffness", "stored", "dissipated"):
        mine = getattr(whole[-1].after.memory["b"], name)
        np.testing.assert_array_equal(getattr(same.after.memory["b"], name), mine)
    np.testing.assert_array_equal(same.after.displacement["b"], whole[-1].after.displacement["b"])
    assert same.ledger.heat == whole[-1].ledger.heat


def plate(factor: float, table: sw.heat.StiffnessTable | None, name: str) -> list[sw.Step]:
    """A plate of two laws that swings from one edge and yields; its capacity keeps it at its temperature."""
    mesh = sw.meshes.Rectangle(size=(1.0, 0.5), cells=(4, 2)).build()
    mesh = mesh.with_region("near", lambda x: x[:, 0] < 0.5).with_region("far", lambda x: x[:, 0] > 0.5)
    law = LAWS[name]
    law = replace(law, E=factor * law.E, **({"kinematic": factor * law.kinematic} if isinstance(law, sw.J2) else {}))
    laws = {"near": law, "far": sw.laws.Hencky(E=2.0 * factor, nu=0.3)}
    heat = Thermal(law=sw.heat.Conduction(conductivity=1.0, capacity=1e6), temperature=START, stiffness=table)
    body = sw.Solid(
        mesh=mesh, material=laws, density=1.0, thermal=heat, dilatation="mean", supports=(Fixed(on="left"),),
        velocity=lambda x: np.stack([0.5 * x[:, 0], 0.4 * x[:, 0] ** 2], axis=1),
    )  # fmt: skip
    return list(sw.march(sw.Scene(bodies={"b": body}), until=1.0, step=0.1, method=sw.FixedPoint(tolerance=1e-12)))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["perfect", "kinematic", "Maxwell", "Kelvin"])
def test_half_the_moduli_move_as_a_law_with_half_the_moduli(name: str) -> None:
    half = sw.heat.StiffnessTable(temperatures=(300.0,), values=(0.5,))
    mine, same = plate(1.0, half, name), plate(0.5, None, name)
    for a, b in zip(mine, same, strict=True):
        np.testing.assert_allclose(a.after.displacement["b"], b.after.displacement["b"], atol=1e-10)
        assert a.ledger.dissipation == pytest.approx(b.ledger.dissipation, abs=1e-10)
        assert a.ledger.energy_strain == pytest.approx(b.ledger.energy_strain, abs=1e-10)
    near = mine[-1].after.memory["b"].regions["near"]
    assert name in ("Maxwell", "Kelvin") or near.law["plastic_strain"].max() > 0.02
    assert sum(s.report.iterations for s in mine) <= 1.05 * sum(s.report.iterations for s in same)


HOT = sw.J2(
    E=2e4, nu=0.3, yield_stress=200.0,
    softening=sw.laws.JohnsonCookSoftening(reference=250.0, melting=700.0, exponent=1.5),
)  # fmt: skip
FALLING = sw.heat.StiffnessTable(temperatures=(300.0, 340.0, 380.0, 460.0), values=(1.0, 0.9, 0.7, 0.4))


def squeezed(slabs: int, law: sw.J2) -> sw.Step:
    """End of the compression of a cylinder of one cell at a true rate of 1/s, without conduction and inertia."""
    times = np.linspace(0.0, 0.5, slabs + 1)
    push = Driven(on="top", components="y", velocity=tuple((-np.exp(-times)).tolist()), times=tuple(times.tolist()))
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-12, capacity=0.5), temperature=START, heating=1.0, stiffness=FALLING
    )  # fmt: skip
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)), material=law, density=2.0, thermal=heat,
        section=sw.bodies.Axisymmetric(), dilatation="mean",
        supports=(Fixed(on="left", components="x"), Fixed(on="bottom", components="y"), push),
    )  # fmt: skip
    *_, last = sw.march(sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off()), until=0.5, step=0.5 / slabs)
    return last


def exact(law: sw.J2) -> float:
    """Temperature at the end: ``(c - theta m'' G) theta' = theta m' G' + D`` with the stress ``m E e``, e elastic."""
    curve, d, squeeze = FALLING.curve(), 1e-3, 1.0 - 2.0 * law.nu
    assert law.softening is not None
    soft = law.softening

    def m(T: float) -> np.ndarray:
        return np.array([float(curve.at(np.array(T))), float(curve.slope(np.array(T)))])

    def flow(T: float) -> float:
        return law.yield_stress * float(soft.at(np.array(T)))

    def strain(T: float) -> float:
        return flow(T) / (m(T)[0] * law.E)

    def capacity(T: float, G: float) -> float:
        return float(1.0 - T * (m(T + d)[1] - m(T - d)[1]) / (2.0 * d) * G)

    def elastic(e: float, y: np.ndarray) -> list[float]:
        gain = np.exp(-squeeze * e) * law.E * e
        return [y[0] * m(y[0])[1] * gain / capacity(*y), gain]

    def plastic(_: float, y: np.ndarray) -> list[float]:
        e, slope = strain(y[0]), (strain(y[0] + d) - strain(y[0] - d)) / (2.0 * d)
        J, stress = np.exp(-squeeze * e), flow(y[0])
        gain = J * law.E * e * slope
        rate = J * stress / (capacity(*y) - y[0] * m(y[0])[1] * gain + J * stress * slope)
        return [rate, gain * rate]

    def yields(e: float, y: np.ndarray) -> float:
        return e - strain(y[0])

    yields.terminal = True  # type: ignore[attr-defined]
    first = solve_ivp(elastic, (0.0, 0.5), [START, 0.0], rtol=1e-11, atol=1e-11, events=yields)
    return float(solve_ivp(plastic, (first.t[-1], 0.5), first.y[:, -1], rtol=1e-10, atol=1e-10).y[0, -1])


@pytest.mark.slow
@pytest.mark.parametrize(("E", "order", "most"), [(1e7, 2.0, 3e-4), (2e4, 1.0, 3e-4)])
def test_a_plastic_point_warms_up_as_its_equation_says(E: float, order: float, most: float) -> None:
    """Of second order but for the elastic strain of half a slab of softening, which is 1 percent with the small E."""
    law = replace(HOT, E=E)
    wanted, found = exact(law), []
    for slabs in (10, 20):
        last = squeezed(slabs, law)
        found.append(float(last.after.fields["temperature"]["b"].mean()))
        heat = last.ledger.heat
        assert (
            heat.received == pytest.approx(last.ledger.dissipation, rel=1e-12)
            and abs(heat.error) < 1e-12 * heat.received
        )
    errors = np.abs(np.array(found) - wanted) / (wanted - START)
    assert errors[1] < most and 0.9 * 2.0**order < errors[0] / errors[1], errors


def thrown() -> sw.Scene:
    """A turning block that hits a wall and yields; it conducts heat, expands and is hot and soft where it touches."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-6, capacity=1e-5), temperature=lambda x: 320.0 - 20.0 * x[:, 1],
        expansion=1e-6, stiffness=MILD,
    )  # fmt: skip
    law = sw.J2(
        E=1.0, nu=0.3, yield_stress=0.01, kinematic=0.02, flow=sw.laws.JohnsonCook(C=0.05),
        softening=sw.laws.JohnsonCookSoftening(reference=290.0, melting=400.0, exponent=1.1),
    )  # fmt: skip
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.6), cells=(3, 2)), material=law, density=1.0, thermal=heat,
        velocity=sw.bodies.Affine(value=(0.0, -0.08), gradient=((0.0, -0.02), (0.02, 0.0))),
        place=sw.bodies.Placement(bottom=0.0, rotations=(sw.bodies.Rotation(angle=0.1),)), dilatation="mean",
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"block": block, "wall": wall}, contacts=(sw.Contact(between=("block", "wall")),))


@cache
def impact() -> tuple[sw.Step, ...]:
    return tuple(sw.march(thrown(), until=1.5, step=0.075, method=sw.FixedPoint(tolerance=1e-13)))


@pytest.mark.slow
def test_an_impact_keeps_energy_and_entropy_never_falls() -> None:
    steps = impact()
    first, last = steps[0].ledger, steps[-1].ledger
    energy = first.energy_kinetic + first.energy_strain
    books = [s.ledger for s in steps]
    whole = [b.energy_kinetic + b.energy_strain + b.heat.content + b.heat.cold_work for b in books]
    assert np.ptp(whole) < 1e-10 * energy
    assert max(abs(b.energy_error) for b in books) < 1e-10 * energy
    assert min(b.heat.produced for b in books) > 0.0
    internal = sw.build(thrown()).parts[0].internal
    spent = [internal.dissipated_energy(s.after.memory["block"]) for s in steps]
    assert spent[-1] > 0.1 * energy and (np.diff(spent) >= 0.0).all()
    assert last.heat.cold_work == pytest.approx(0.1 * spent[-1], rel=1e-12)
    assert any(e.kind == "contact" for s in steps for e in s.events) or steps[-1].after.pressure["block-wall"].any()


@pytest.mark.slow
def test_a_march_goes_on_with_the_same_bits() -> None:
    mine, middle = impact()[-1], impact()[9]
    kept = unpacked(*packed(middle.march_state))
    *_, same = sw.march(thrown(), until=1.5, step=0.075, state=kept, method=sw.FixedPoint(tolerance=1e-13))
    for name in ("displacement", "velocity"):
        np.testing.assert_array_equal(getattr(same.after, name)["block"], getattr(mine.after, name)["block"])
    np.testing.assert_array_equal(same.after.fields["temperature"]["block"], mine.after.fields["temperature"]["block"])
    for name in ("stress", "stiffness", "stiffening", "dissipated"):
        np.testing.assert_array_equal(
            getattr(same.after.memory["block"], name), getattr(mine.after.memory["block"], name)
        )
    assert same.ledger.heat == mine.ledger.heat


def test_a_static_start_has_the_moduli_of_its_temperature() -> None:
    """A bar that hangs by its weight, hot at one end, is as long as one whose law has a stored energy."""
    found = []
    for law in (sw.J2(E=1.0, nu=0.3, yield_stress=1.0), sw.laws.Hencky(E=1.0, nu=0.3)):
        heat = Thermal(
            law=sw.heat.Conduction(conductivity=1e-12, capacity=1e3), stiffness=LINE,
            temperature=lambda x: 320.0 + 200.0 * x[:, 0],
        )  # fmt: skip
        body = sw.Solid(
            mesh=sw.meshes.Interval(length=1.0, cells=4), material=law, density=1.0, thermal=heat,
            supports=(Fixed(on="left"),),
        )  # fmt: skip
        weight = sw.bodies.Gravity(acceleration=1e-5)
        scene = sw.Scene(bodies={"b": body}, loads=(weight,), start=sw.model.StaticStart())
        found.append(initial_state(sw.build(scene)).start.displacement[1:, 0])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-5)
    assert found[0][-1] > 5.5e-6


def test_laws_whose_moduli_cannot_have_a_factor_are_refused() -> None:
    bar = {"mesh": sw.meshes.Interval(length=1.0, cells=1), "supports": (Fixed(on="left"), Fixed(on="right"))}
    with pytest.raises(sw.errors.InputError, match="no factor of its moduli") as found:
        sw.build(heated(sw.laws.NortonHoff(K=1.0, m=0.2), LINE, **bar))
    assert found.value.where == "bodies.b.thermal.stiffness" and "softening of its consistency" in found.value.remedy
    soft = sw.laws.NortonHoff(K=1.0, m=0.2, softening=WEAKER)
    sw.build(heated(soft, None, **bar))
    falls = sw.J2(E=1.0, nu=0.3, yield_stress=0.1, hardening=sw.laws.LinearHardening(modulus=-0.4))
    with pytest.raises(sw.errors.InputError, match="snap back") as found:
        sw.build(heated(falls, LINE, **bar))
    assert found.value.where == "bodies.b.material.hardening"
    sw.build(heated(falls, None, **bar))
