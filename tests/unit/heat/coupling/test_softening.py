"""Strength that depends on the temperature: exact adiabatic points, balances of an impact, march that goes on."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import softway as sw
from softway.bodies import Driven, Fixed, Thermal
from softway.laws.law import RateLaw
from softway.record.storage.serialisation import packed, unpacked

RHO, C, START, STRAIN = 2.0, 0.5, 300.0, 0.5
COOK = sw.laws.JohnsonCookSoftening(reference=250.0, melting=700.0, exponent=1.5)
METAL = sw.J2(E=1e7, nu=0.3, yield_stress=200.0, softening=COOK)
HOT = sw.laws.NortonHoff(K=60.0, m=0.2, softening=sw.laws.Arrhenius(activation=900.0, reference=300.0))
LAWS = {"plastic": METAL, "viscous": HOT}


@cache
def squeezed(name: str, slabs: int) -> sw.Step:
    """End of the compression of a cylinder of one cell at a true rate of 1/s, without conduction and inertia."""
    times = np.linspace(0.0, STRAIN, slabs + 1)
    speed = tuple((-np.exp(-times)).tolist())
    push = Driven(on="top", components="y", velocity=speed, times=tuple(times.tolist()))
    law = sw.heat.Conduction(conductivity=1e-12, capacity=C)
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)), material=LAWS[name], density=RHO,
        section=sw.bodies.Axisymmetric(), dilatation="mean", thermal=Thermal(law=law, temperature=START, heating=1.0),
        supports=(Fixed(on="left", components="x"), Fixed(on="bottom", components="y"), push),
    )  # fmt: skip
    scene = sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off())
    *_, last = sw.march(scene, until=STRAIN, step=STRAIN / slabs)
    return last


def exact(name: str) -> float:
    """Temperature at the end: rho c dT = J sigma d(plastic strain), whose stress depends on T."""
    if name == "viscous":
        size = HOT.K * np.sqrt(3.0) ** (HOT.m + 1.0) / (RHO * C)
        soft = HOT.softening
        assert soft is not None

        def strain(end: float) -> float:
            return quad(lambda T: 1.0 / (size * float(soft.at(np.array(T)))), START, end, epsrel=1e-12)[0]

        return float(brentq(lambda end: strain(end) - STRAIN, START, 600.0, xtol=1e-11))
    E, width = METAL.E, COOK.melting - COOK.reference

    def sigma(T: float) -> float:
        return METAL.yield_stress * float(COOK.at(np.array(T)))

    def rate(_: float, y: np.ndarray) -> list[float]:
        slope = -METAL.yield_stress * COOK.exponent * ((y[0] - COOK.reference) / width) ** (COOK.exponent - 1.0) / width
        power = np.exp(-(1.0 - 2.0 * METAL.nu) * sigma(y[0]) / E) * sigma(y[0]) / (RHO * C)
        return [power / (1.0 + power * slope / E)]  # the elastic strain falls with the stress

    end = solve_ivp(rate, (sigma(START) / E, STRAIN), [START], rtol=1e-11, atol=1e-9).y[0, -1]
    return float(end)


@pytest.mark.parametrize("name", LAWS)
def test_an_adiabatic_point_softens_as_its_equation_says_with_order_two(name: str) -> None:
    found, wanted = [], exact(name)
    for slabs in (10, 20, 40):
        last = squeezed(name, slabs)
        found.append(float(last.after.fields["temperature"]["b"].mean()))
        heat = last.ledger.heat
        assert heat.received == pytest.approx(last.ledger.dissipation, rel=1e-12) and heat.cold_work == 0.0
        assert abs(heat.error) < 1e-12 * heat.received
    errors = np.abs(np.array(found) - wanted) / (wanted - START)
    assert errors[-1] < 2e-4, errors
    ratios = errors[:-1] / errors[1:]
    assert (ratios > 3.8).all() and (ratios < 4.3).all(), errors


def thrown(law: RateLaw, speed: float = 0.08) -> sw.Scene:
    """A turning block that hits a wall and yields; it conducts heat and is hot where it touches."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-6, capacity=1e-5), temperature=lambda x: 320.0 - 20.0 * x[:, 1],
        expansion=1e-6,
    )  # fmt: skip
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.6), cells=(4, 3)), material=law, density=1.0, thermal=heat,
        velocity=sw.bodies.Affine(value=(0.0, -speed), gradient=((0.0, -0.02), (0.02, 0.0))),
        place=sw.bodies.Placement(bottom=0.0, rotations=(sw.bodies.Rotation(angle=0.1),)), dilatation="mean",
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"block": block, "wall": wall}, contacts=(sw.Contact(between=("block", "wall")),))


SOFT = sw.laws.JohnsonCookSoftening(reference=290.0, melting=400.0, exponent=1.1)
COLD = {"E": 1.0, "nu": 0.3, "yield_stress": 0.01, "kinematic": 0.02, "flow": sw.laws.JohnsonCook(C=0.05)}
MELTING = sw.J2(**COLD, softening=SOFT)


@cache
def steps() -> tuple[sw.Step, ...]:
    return tuple(sw.march(thrown(MELTING), until=1.5, step=0.05, method=sw.FixedPoint(tolerance=1e-13)))


@pytest.mark.slow
def test_an_impact_keeps_energy_and_entropy_never_falls() -> None:
    found = steps()
    first, last = found[0].ledger, found[-1].ledger
    energy = first.energy_kinetic + first.energy_strain
    whole = [
        s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content + s.ledger.heat.cold_work
        for s in found
    ]
    assert np.ptp(whole) < 1e-11 * energy
    internal = sw.build(thrown(MELTING)).parts[0].internal
    spent = [internal.dissipated_energy(s.after.memory["block"]) for s in found]
    assert spent[-1] > 0.2 * energy and (np.diff(spent) >= 0.0).all()
    assert last.heat.cold_work == pytest.approx(0.1 * spent[-1], rel=1e-12)
    assert min(s.ledger.heat.produced for s in found) > 0.0


@pytest.mark.slow
def test_a_warm_block_dissipates_more_than_a_cold_one() -> None:
    *_, cold = sw.march(thrown(sw.J2(**COLD)), until=1.5, step=0.05)
    hot = steps()[-1]
    assert (
        hot.after.memory["block"].law["plastic_strain"].max()
        > 1.05 * cold.after.memory["block"].law["plastic_strain"].max()
    )


@pytest.mark.slow
def test_a_march_goes_on_with_the_same_bits() -> None:
    mine, middle = steps()[-1], steps()[14]
    kept = unpacked(*packed(middle.march_state))
    method = sw.FixedPoint(tolerance=1e-13)
    *_, same = sw.march(thrown(MELTING), until=1.5, step=0.05, state=kept, method=method)
    for name in ("displacement", "velocity"):
        np.testing.assert_array_equal(getattr(same.after, name)["block"], getattr(mine.after, name)["block"])
    np.testing.assert_array_equal(same.after.fields["temperature"]["block"], mine.after.fields["temperature"]["block"])
    for name in ("temperature", "warming", "dissipated"):
        np.testing.assert_array_equal(
            getattr(same.after.memory["block"], name), getattr(mine.after.memory["block"], name)
        )
    assert same.ledger.heat == mine.ledger.heat


def held(**given: object) -> sw.Scene:
    """A block of a soft lower and a cold upper half, squeezed without inertia, with loads of heat."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 2)).build()
    mesh = mesh.with_region("low", lambda x: x[:, 1] < 0.5).with_region("high", lambda x: x[:, 1] > 0.5)
    soft = sw.J2(E=1e3, nu=0.3, yield_stress=1.0, softening=COOK)
    heat = Thermal(law=sw.heat.Conduction(conductivity=1e-9, capacity=1e6), temperature=START)
    push = Driven(on="top", components="y", velocity=-0.01)
    body = sw.Solid(
        mesh=mesh.with_tag("all", lambda x: x[:, 1] >= 0.0), density=RHO, thermal=heat,
        material={"high": sw.J2(E=1e3, nu=0.3, yield_stress=1.0), "low": soft},
        supports=(Fixed(on="left", components="x"), Fixed(on="bottom", components="y"), push),
    )  # fmt: skip
    return sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off(), **given)


def test_a_prescribed_jump_is_known_to_the_law_at_once() -> None:
    """The temperature jumps at the start and, by a knot, at a half; it is not extrapolated beyond either."""
    ramp = sw.bodies.Ramp(times=(0.0, 0.5, 0.5 + 1e-9, 1.0), factors=(1.0, 1.0, 1.2, 1.2))
    hot = sw.heat.Temperature(on="b.all", value=400.0, ramp=ramp)
    found = [s.after.memory["b"] for s in sw.march(held(loads=(hot,)), until=1.0, step=0.25)]
    for state in found:
        assert state.regions["high"].temperature is None and state.temperature is None
    low = [state.regions["low"] for state in found]
    np.testing.assert_allclose([s.temperature.mean() for s in low][:2], 400.0, rtol=1e-12)
    np.testing.assert_allclose(low[-1].temperature, 480.0, rtol=1e-9)
    np.testing.assert_allclose(low[0].warming, 0.0, atol=1e-9)
    for state, warm in ((low[1], 400.0), (low[-1], 480.0)):
        s = state.stress - np.trace(state.stress, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3.0
        size = np.sqrt(1.5 * np.einsum("pij,pij->p", s, s))
        np.testing.assert_allclose(size, float(COOK.at(np.array(warm))), rtol=1e-6)


def test_a_law_that_softens_needs_a_temperature() -> None:
    body = sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)), material=METAL, density=RHO)
    with pytest.raises(sw.errors.InputError, match="softens") as found:
        sw.build(sw.Scene(bodies={"b": body}))
    assert found.value.where == "bodies.b.thermal"
