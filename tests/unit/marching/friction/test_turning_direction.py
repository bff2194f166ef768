"""Slip whose direction turns: the force at the end of a slab (time step) turns with it, and is of second order."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import softway as sw
from softway.bodies import Ramp
from softway.laws.friction_law import FrictionLaw

pytestmark = pytest.mark.slow

END, SPEED = 0.8, 3.0
LAWS = {
    "coulomb": sw.Coulomb(mu=0.3),
    "stribeck": sw.laws.Stribeck(mu_s=0.4, mu_k=0.2, v_s=1.0, viscous=0.05),
    "norton-hoff": sw.laws.NortonHoffFriction(alpha=1.0, p=0.5, K=2.0, v0=1.0),
}
EVEN, UNEVEN = (1.0,), (2.0, 1.0)


def pressing(t: np.ndarray | float) -> np.ndarray:
    return 10.0 + 4.0 * np.sin(3.0 * np.asarray(t))


def pulling(t: np.ndarray | float) -> np.ndarray:
    return 2.5 * np.sin(2.0 * np.asarray(t))


def puck(law: FrictionLaw) -> sw.Scene:
    """A stiff block of unit mass and unit area on a floor, pressed and pulled aside by forces that change."""
    t = np.linspace(0.0, END, 4001)
    ramps = [Ramp(times=tuple(t.tolist()), factors=tuple(f(t).tolist())) for f in (pressing, pulling)]
    first = float(law.resistance(np.array([SPEED]), np.array([10.0]))[0][0])
    block = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 0.5), cells=(2, 2, 3)),
        material=sw.LinearElastic(E=1e8, nu=0.0),
        density=2.0,
        velocity=sw.bodies.Uniform(value=(SPEED, 0.0, 0.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(
        bodies={"block": block, "floor": floor},
        contacts=(sw.Contact(between=("block.bottom", "floor"), name="floor", friction=law),),
        loads=(
            sw.Gravity(acceleration=(0.0, 0.0, -1.0), ramp=ramps[0]),
            sw.Gravity(acceleration=(0.0, 1.0, 0.0), ramp=ramps[1]),
        ),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=(first, 0.0, -10.0)),)),
    )


def point(law: FrictionLaw) -> np.ndarray:
    """Place at the end of a point with the same forces, by another integration."""

    def rate(t: float, y: np.ndarray) -> list[float]:
        speed = np.hypot(*y[2:])
        force = float(law.resistance(np.array([speed]), np.atleast_1d(pressing(t)))[0][0])
        return [y[2], y[3], -force * y[2] / speed, float(pulling(t)) - force * y[3] / speed]

    out: np.ndarray = solve_ivp(rate, (0.0, END), [0.0, 0.0, SPEED, 0.0], rtol=1e-11, atol=1e-12).y[:2, -1]
    return out


@cache
def missed(name: str, step: float, lengths: Sequence[float]) -> float:
    """Error of the place at the end, with slabs of these relative lengths in turn."""
    model, state, time = sw.build(puck(LAWS[name])), None, 0.0
    for k in range(10000):
        length = step * lengths[k % len(lengths)] / float(np.mean(lengths))
        state = list(sw.march(model, until=min(time + length, END), step=length, state=state))[-1].after
        time = state.time
        if time > END - 1e-9:
            break
    place = state.displacement["block"][:, :2].mean(axis=0)
    return float(np.linalg.norm(place - point(LAWS[name])))


@pytest.mark.few(3)
@pytest.mark.parametrize("lengths", [EVEN, UNEVEN], ids=["even", "two to one"])
@pytest.mark.parametrize("name", LAWS)
def test_a_puck_turns_with_second_order(name: str, lengths: Sequence[float]) -> None:
    """With the direction of the chord the errors are twenty times as great and fall by two."""
    errors = [missed(name, h, lengths) for h in (0.04, 0.02, 0.01)]
    assert errors[1] < (4e-4 if name == "stribeck" else 3e-4)
    assert errors[0] > 3.7 * errors[1] and errors[1] > 3.7 * errors[2]


def test_friction_that_turns_takes_energy_and_the_balance_closes() -> None:
    steps = list(sw.march(puck(LAWS["coulomb"]), until=END, step=0.04))
    lost = np.diff([0.0, *(s.ledger.dissipation for s in steps)])
    assert lost.min() > 0.0
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-8 * lost.sum()
    assert np.mean([s.report.iterations for s in steps]) < 2.5


def test_a_turning_puck_goes_on_from_a_state_bit_by_bit() -> None:
    step = 2.0**-6
    whole = list(sw.march(puck(LAWS["stribeck"]), until=10 * step, step=step))
    rest = list(sw.march(puck(LAWS["stribeck"]), until=10 * step, step=step, state=whole[4].after))
    assert np.array_equal(rest[-1].after.displacement["block"], whole[-1].after.displacement["block"])
    assert np.array_equal(rest[-1].after.slip["floor"], whole[-1].after.slip["floor"])


def dragged(step: float) -> float:
    """Error of the velocity of a block that slides on a floor that swings."""
    law, often, before = LAWS["stribeck"], 2.0, -3.0
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3)),
        material=sw.LinearElastic(E=1e8, nu=0.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(before, 0.0)),
    )
    swing = sw.bodies.Sine(amplitude=1.0, frequency=often / (2.0 * np.pi))
    floor = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)),
        motion=sw.bodies.Sliding(direction=(1.0, 0.0), travel=swing),
    )

    pressed = Ramp(times=(0.0, 0.48), factors=(0.0, 20.0))
    scene = sw.Scene(
        bodies={"block": block, "floor": floor},
        contacts=(sw.Contact(between=("block.bottom", "floor"), friction=law),),
        loads=(sw.Gravity(acceleration=(0.0, -1.0), ramp=pressed),),
    )
    steps = list(sw.march(scene, until=0.48, step=step))

    def rate(t: float, v: np.ndarray) -> np.ndarray:
        slip = v - often * np.cos(often * t)
        return -np.sign(slip) * law.resistance(np.abs(slip), np.array([pressed.at(t)]))[0]

    exact = solve_ivp(rate, (0.0, 0.48), [before], rtol=1e-11, atol=1e-12).y[0, -1]
    return abs(float(steps[-1].ledger.momentum[0]) - exact)


def test_the_speed_of_slip_on_a_floor_that_accelerates_is_of_second_order() -> None:
    """The slip of the slab before has the motion of the floor in that slab."""
    errors = [dragged(h) for h in (0.06, 0.03, 0.015)]
    assert errors[0] > 3.7 * errors[1] and errors[1] > 3.7 * errors[2]
