"""Elastic moduli that depend on the temperature: closed forms, both laws of an impact, order in time, same bits."""

from functools import cache

import numpy as np
import pytest

import softway as sw
from softway.bodies import Driven, Fixed, Thermal
from softway.record.storage.serialisation import packed, unpacked
from softway.scenario.scenario import Scenario, Time

E, RHO, C, THETA = 1.0, 1.0, 0.1, 300.0
RUBBER = sw.heat.StiffnessTable(temperatures=(200.0, 400.0), values=(2.0 / 3.0, 4.0 / 3.0))
CURVED = sw.heat.StiffnessTable(temperatures=(280.0, 305.0, 320.0, 360.0), values=(1.3, 1.0, 0.75, 0.6))
STEEL = sw.heat.StiffnessTable(
    temperatures=(293.15, 373.15, 473.15, 573.15, 673.15, 773.15, 873.15, 973.15),
    values=(1.0, 1.0, 0.9, 0.8, 0.7, 0.6, 0.31, 0.13),
)  # EN 1993-1-2, table 3.1
LAWS = (sw.LinearElastic(E=E), sw.laws.Hencky(E=E), sw.NeoHookean(E=E), sw.laws.StVenantKirchhoff(E=E))


def test_a_table_is_smooth_and_passes_through_its_values() -> None:
    curve = STEEL.curve()
    np.testing.assert_allclose(curve.at(np.array(STEEL.temperatures)), STEEL.values, rtol=1e-14)
    at, step = np.linspace(200.0, 1500.0, 2601), 1e-3
    np.testing.assert_allclose(curve.slope(at), (curve.at(at + step) - curve.at(at - step)) / (2.0 * step), atol=1e-7)
    assert (np.diff(curve.at(at)) <= 0.0).all() and curve.at(at).min() > 0.0
    assert np.abs(np.diff(curve.slope(at))).max() < 1e-4
    assert RUBBER.curve().at(np.array([250.0])) == pytest.approx(250.0 / 300.0, rel=1e-14)
    one = sw.heat.StiffnessTable(temperatures=(300.0,), values=(0.5,)).curve()
    assert one.at(np.array([200.0, 400.0])).tolist() == [0.5, 0.5] and not one.slope(np.array([200.0, 400.0])).any()


@cache
def pulled(table: sw.heat.StiffnessTable, law: object, slabs: int, conducts: bool = False) -> tuple[sw.Step, ...]:
    """One cell without conduction that is stretched to one and a half, with inertia."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-12, capacity=C), temperature=THETA, stiffness=table
    )  # fmt: skip
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1), material=law, density=RHO, thermal=heat, velocity=lambda x: x,
        supports=(Fixed(on="left"), Driven(on="right", velocity=1.0)),
    )  # fmt: skip
    return tuple(sw.march(sw.Scene(bodies={"b": body}), until=0.5, step=0.5 / slabs))


@pytest.mark.parametrize("slabs", [1, 3])
def test_rubber_warms_up_when_it_is_stretched_as_its_entropy_says(slabs: int) -> None:
    """``m = theta/theta_0``: ``c ln theta - E e^2/(2 theta_0)`` is constant, whatever the slabs."""
    last = pulled(RUBBER, LAWS[0], slabs)[-1]
    wanted = THETA * np.exp(0.5 * E * 0.5**2 / (RHO * C * THETA))
    np.testing.assert_allclose(last.after.fields["temperature"]["b"], wanted, rtol=1e-14)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_an_adiabatic_stretch_keeps_the_entropy_of_a_curved_table(law: sw.laws.Hencky) -> None:
    """``c ln theta - m' W``, also across knots, with the energy W of the law."""
    curve, steps = CURVED.curve(), pulled(CURVED, law, 4)
    green = 0.5 * (1.5**2 - 1.0) if not law.linear else 0.5
    W = float(law.energy(np.diag([green, 0.0, 0.0])))
    theta = float(steps[-1].after.fields["temperature"]["b"].mean())
    assert abs(theta - THETA) > 3.0
    entropy = RHO * C * np.log(theta / THETA) - float(curve.slope(np.array(theta))) * W
    assert abs(entropy) < 1e-14
    whole = [
        s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content - s.ledger.work_external for s in steps
    ]
    assert np.ptp(whole) < 1e-13


def waves(slabs: int, table: sw.heat.StiffnessTable) -> np.ndarray:
    """Displacement and temperature of a stretched bar that vibrates between walls, without conduction."""
    heat = Thermal(law=sw.heat.Conduction(conductivity=1e-12, capacity=4.0 * C), temperature=THETA, stiffness=table)
    hold = tuple(Driven(on=side, velocity=0.0) for side in ("left", "right"))
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4), material=LAWS[0], density=RHO, thermal=heat, supports=hold,
        displacement=lambda x: 0.5 * x, velocity=lambda x: 0.2 * np.sin(np.pi * x),
    )  # fmt: skip
    *_, last = sw.march(
        sw.Scene(bodies={"b": body}), until=0.8, step=0.8 / slabs, method=sw.FixedPoint(tolerance=1e-12)
    )
    return np.array([last.after.displacement["b"][1, 0], last.after.fields["temperature"]["b"][0, 0] / THETA])


@pytest.mark.slow
def test_a_coupled_vibration_is_of_second_order_in_time() -> None:
    fine = waves(160, CURVED)
    errors = np.array([np.abs(waves(slabs, CURVED) - fine) for slabs in (10, 20, 40)])
    ratios = errors[:-1] / errors[1:]
    assert (ratios > 3.5).all() and (ratios < 4.8).all(), errors


def test_small_vibrations_have_the_adiabatic_modulus() -> None:
    """``m E + (m' E e)^2 theta/c`` about the strain e of a dead load, in a cell whose strain is uniform.

    The table has a strong slope, so that the modulus is .25 above the isothermal one.
    """
    slope, strain = 0.01, 0.5
    steep = sw.heat.StiffnessTable(temperatures=(295.0, 305.0), values=(1.0 - 5.0 * slope, 1.0 + 5.0 * slope))
    adiabatic = E + (slope * E * strain) ** 2 * THETA / (RHO * 0.03)
    heat = Thermal(law=sw.heat.Conduction(conductivity=1e-12, capacity=0.03), temperature=THETA, stiffness=steep)
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1), material=LAWS[0], density=RHO, thermal=heat,
        mass=sw.bodies.Lumped(), supports=(Fixed(on="left"),), displacement=lambda x: strain * x,
        velocity=lambda x: 1e-6 * x,
    )  # fmt: skip
    pull = sw.bodies.Traction(on="b.right", value=E * strain)
    omega = np.sqrt(2.0 * adiabatic / RHO)
    step = 2.0 * np.pi / omega / 80
    steps = sw.march(sw.Scene(bodies={"b": body}, loads=(pull,)), until=80 * step, step=step)
    swing = np.array([s.after.displacement["b"][1, 0] for s in steps]) - strain
    time = step * np.arange(1, len(swing) + 1)
    np.testing.assert_allclose(swing, 1e-6 / omega * np.sin(omega * time), atol=5e-3 * 1e-6 / omega)


def hot(stiffness: sw.heat.StiffnessTable | None, factor: float) -> list[sw.Step]:
    """A plate of two laws at 900 K that swings from one edge, with so great a capacity that it stays there."""
    mesh = sw.meshes.Rectangle(size=(1.0, 0.5), cells=(4, 2)).build()
    mesh = mesh.with_region("near", lambda x: x[:, 0] < 0.5).with_region("far", lambda x: x[:, 0] > 0.5)
    laws = {"near": sw.NeoHookean(E=factor * E, nu=0.3), "far": sw.laws.Hencky(E=2.0 * factor * E, nu=0.3)}
    heat = Thermal(law=sw.heat.Conduction(conductivity=1.0, capacity=1e6), temperature=900.0, stiffness=stiffness)
    body = sw.Solid(
        mesh=mesh, material=laws, density=RHO, thermal=heat, dilatation="mean", supports=(Fixed(on="left"),),
        velocity=lambda x: np.stack([0.05 * x[:, 0], 0.03 * x[:, 0] ** 2], axis=1),
    )  # fmt: skip
    return list(sw.march(sw.Scene(bodies={"b": body}), until=1.0, step=0.1))


def test_a_hot_body_moves_and_converges_as_one_of_its_softer_laws() -> None:
    """The operator has the factor: a body with a quarter of its stiffness takes no more iterations."""
    factor = float(STEEL.curve().at(np.array(900.0)))
    assert factor < 0.3
    mine, same = hot(STEEL, 1.0), hot(None, factor)
    for a, b in zip(mine, same, strict=True):
        np.testing.assert_allclose(a.after.displacement["b"], b.after.displacement["b"], atol=1e-8)
    assert sum(s.report.iterations for s in mine) <= sum(s.report.iterations for s in same) + 2


def heated(supports: tuple[Fixed, ...], law: object, inertia: object = sw.bodies.Off()) -> sw.Run:
    """A bar of steel that is heated by 600 K within one second."""
    alpha = 1e-5
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=0.1, capacity=C), temperature=293.15, expansion=alpha, stiffness=STEEL
    )  # fmt: skip
    body = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=2), material=law, density=RHO, thermal=heat, supports=supports
    )  # fmt: skip
    load = sw.heat.HeatSource(of="b", value=RHO * C * 600.0)
    times = Time(end=1.0, step=0.1)
    return sw.run(Scenario(bodies={"b": body}, loads=(load,), inertia=inertia, time=times))


@pytest.mark.parametrize("law", LAWS[:2], ids=lambda law: type(law).__name__)
def test_a_clamped_bar_has_the_stress_of_its_modulus_at_the_temperature(law: object) -> None:
    """``-m(theta) E alpha (theta - theta_r)``: it grows to a maximum and falls again."""
    run, curve = heated((Fixed(on="left"), Fixed(on="right")), law), STEEL.curve()
    frames = list(run.fields)[1:]
    stress = np.array([frame.stress[:, 0].mean() for frame in frames])
    theta = np.array([frame["temperature"].mean() for frame in frames])
    np.testing.assert_allclose(stress, -curve.at(theta) * E * 1e-5 * (theta - 293.15), rtol=1e-11)
    assert theta[-1] == pytest.approx(893.15) and stress.argmin() < len(stress) - 1


def test_a_free_bar_expands_by_the_coefficient_whatever_its_modulus() -> None:
    run = heated((Fixed(on="left"),), LAWS[0])
    last = run.fields[-1]
    rise = last["temperature"].mean() - 293.15
    np.testing.assert_allclose(last["displacement"][-1, 0], 1e-5 * rise, rtol=1e-9)
    np.testing.assert_allclose(last.stress, 0.0, atol=1e-12)


def thrown(law: object = LAWS[1]) -> sw.Scene:
    """A bar that is hot at one end, where it hits a wall and is soft; it conducts heat and expands."""
    conduction = sw.heat.Conduction(conductivity=0.1 / THETA, capacity=10.0 / THETA)
    heat = Thermal(
        law=conduction, temperature=lambda x: THETA + 50.0 * x[:, 0], expansion=7e-4, stiffness=CURVED
    )  # fmt: skip
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=8), material=law, density=RHO, thermal=heat,
        velocity=sw.bodies.Uniform(value=0.1),
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.01, normal=-1.0))
    return sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))


@cache
def flight() -> tuple[sw.Step, ...]:
    return tuple(sw.march(thrown(), until=2.8, step=0.1, method=sw.FixedPoint(tolerance=1e-13)))


@pytest.mark.slow
def test_an_impact_keeps_energy_and_entropy_never_falls() -> None:
    steps = flight()
    assert any(e.kind == "release" for s in steps for e in s.events) and steps[-1].ledger.momentum[0] < 0.0
    kinetic = steps[0].ledger.energy_kinetic
    whole = [s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content for s in steps]
    assert np.ptp(whole) < 1e-10 * kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-9 * kinetic
    assert min(s.ledger.heat.produced for s in steps) > -1e-12 / THETA
    received = np.array([s.ledger.heat.received for s in steps])
    assert np.ptp(received) > 1e-3 * kinetic


@pytest.mark.slow
def test_a_march_goes_on_with_the_same_bits() -> None:
    steps, method = flight(), sw.FixedPoint(tolerance=1e-13)
    kept = unpacked(*packed(steps[12].march_state))
    *_, same = sw.march(thrown(), until=2.8, step=0.1, state=kept, method=method)
    for name in ("displacement", "velocity"):
        np.testing.assert_array_equal(getattr(same.after, name)["bar"], getattr(steps[-1].after, name)["bar"])
    np.testing.assert_array_equal(same.after.fields["temperature"]["bar"], steps[-1].after.fields["temperature"]["bar"])
    assert same.ledger.heat == steps[-1].ledger.heat
