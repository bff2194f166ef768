"""Screws and gears: exact accelerations, ratios over many turns, and what they keep."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.mechanisms import (
    Gear,
    Hinge,
    HingeTorque,
    Mechanism,
    MechanismStep,
    Motor,
    PinSlot,
    Rigid,
    Screw,
    Sine,
    Slider,
    Steady,
    TorsionSpring,
    Weld,
    march,
)

AXIS = tuple(np.array([1.0, 2.0, 2.0]) / 3.0)


def angles(steps: list[MechanismStep], body: str, to: str | None = None) -> np.ndarray:
    """Angles about z of a body, against another, with all turns."""
    found = []
    for step in steps:
        R = step.bodies[body].rotation
        R = R if to is None else step.bodies[to].rotation.T @ R
        found.append(np.arctan2(R[1, 0], R[0, 0]))
    return np.unwrap(found)


def test_a_nut_falls_along_a_screw() -> None:
    """The acceleration is g / (1 + J (2 pi / p)^2 / m), over many turns."""
    pitch, mass, inertia = 0.05, 2.0, 4e-4
    nut = Rigid(mass=mass, centre=(0, 0, 0), inertia=(3e-4, 3e-4, inertia))
    screw = Screw(between=("ground", "nut"), at=(0, 0, 0), axis=(0, 0, 1), pitch=pitch)
    mechanism = Mechanism(bodies={"nut": nut}, joints={"screw": screw}, gravity=(0, 0, -9.81))
    steps = list(march(mechanism, until=1.0, step=0.0005, every=2))
    fall = 9.81 / (1.0 + inertia * (2.0 * np.pi / pitch) ** 2 / mass)
    way = np.array([s.bodies["nut"].centre[2] for s in steps])
    assert way[-1] == pytest.approx(-0.5 * fall, rel=1e-3) and way[-1] < -10.0 * pitch
    np.testing.assert_allclose(angles(steps, "nut"), 2.0 * np.pi * way / pitch, atol=1e-11)
    assert max(abs(s.energy_error) for s in steps) < 1e-12 and steps[-1].independent == 5


def free_pair(**members: object) -> Mechanism:
    bodies = {
        "a": Rigid(mass=2.0, centre=(0, 0, 0), inertia=(0.3, 0.5, 0.6), velocity=(0.1, 0, 0.2), spin=(1, -2, 3)),
        "b": Rigid(mass=1.0, centre=(1, 0.3, 0.1), inertia=(0.2, 0.1, 0.15), velocity=(0, -0.4, 0.1), spin=(-2, 4, 1)),
    }
    screw = Screw(between=("a", "b"), at=(0.6, 0.1, -0.2), axis=AXIS, pitch=-0.3)
    return Mechanism(bodies=bodies, joints={"screw": screw}, **members)


@pytest.mark.parametrize("members", [{}, {"springs": (TorsionSpring(joint="screw", stiffness=0.2, rest=5.0),)}])
def test_a_screw_between_free_bodies_keeps_energy_momentum_and_spin(members) -> None:
    steps = list(march(free_pair(**members), until=30.0, step=0.005, every=100))
    total = steps[0].energy_kinetic + steps[0].energy_potential
    for step in steps:
        assert step.joints < 1e-12 and abs(step.energy_error) < 1e-12 * total
        np.testing.assert_allclose(step.momentum, steps[0].momentum, atol=1e-12)
        np.testing.assert_allclose(step.spin, steps[0].spin, atol=1e-11)


def test_a_motor_turns_a_screw() -> None:
    mechanism = free_pair(motors={"m": Motor(joint="screw", motion=Steady(rate=6.0))})
    steps = list(march(mechanism, until=5.0, step=0.005, every=10))
    for step in steps:
        apart = step.bodies["b"].point((0.6, 0.1, -0.2), (1, 0.3, 0.1)) - step.bodies["a"].point(
            (0.6, 0.1, -0.2), (0, 0, 0)
        )
        travel = apart @ (step.bodies["a"].rotation @ AXIS)
        assert travel == pytest.approx(-0.3 * 6.0 * step.time / (2.0 * np.pi), abs=1e-12)
        np.testing.assert_allclose(step.spin, steps[0].spin, atol=1e-11)


def wheels(ratio: float = -np.sqrt(2.0), **members: object) -> Mechanism:
    """Two wheels on the ground with a gear."""
    bodies = {
        "one": Rigid(mass=1.0, centre=(0.0, 0.0), inertia=0.5),
        "two": Rigid(mass=1.0, centre=(1.0, 0.0), inertia=0.2),
    }
    joints = {name: Hinge(between=("ground", name), at=body.centre) for name, body in bodies.items()}
    return Mechanism(bodies=bodies, joints=joints, gears={"gear": Gear(joints=("one", "two"), ratio=ratio)}, **members)


def test_two_wheels_turn_with_the_ratio_and_the_inertia_of_both() -> None:
    """Of an irrational ratio over many turns: alpha = tau / (J1 + r^2 J2)."""
    steps = list(march(wheels(torques=(HingeTorque(joint="one", value=1.8),)), until=20.0, step=0.002, every=5))
    first, second = angles(steps, "one"), angles(steps, "two")
    assert first[-1] == pytest.approx(0.5 * 2.0 * 400.0, rel=1e-3), "64 turns"
    np.testing.assert_allclose(second, -np.sqrt(2.0) * first, atol=1e-10)
    assert abs(steps[-1].energy_error) < 1e-12 * steps[-1].energy_kinetic


def test_a_planet_turns_around_a_sun() -> None:
    """A fixed sun of 30 teeth and a planet of 12: against the carrier the planet turns by 30/12 of its angle."""
    bodies = {
        "carrier": Rigid(mass=1.0, centre=(0.0, 0.0), inertia=0.3, spin=2.0),
        "planet": Rigid(mass=0.5, centre=(1.0, 0.0), inertia=0.1, velocity=(0.0, 2.0), spin=7.0),
    }
    joints = {
        "arm": Hinge(between=("ground", "carrier"), at=(0.0, 0.0)),
        "pin": Hinge(between=("carrier", "planet"), at=(1.0, 0.0)),
    }
    gear = {"gear": Gear(joints=("arm", "pin"), ratio=30.0 / 12.0)}
    steps = list(march(Mechanism(bodies=bodies, joints=joints, gears=gear), until=20.0, step=0.01))
    np.testing.assert_allclose(angles(steps, "planet", "carrier"), 2.5 * angles(steps, "carrier"), atol=1e-11)
    assert angles(steps, "carrier")[-1] == pytest.approx(40.0, rel=1e-3)
    assert max(abs(s.energy_error) for s in steps) < 1e-12


def test_a_gear_on_a_free_carrier_keeps_spin() -> None:
    """Two wheels with skew axes on a free body in space."""
    bodies = {
        "box": Rigid(mass=3.0, centre=(0, 0, 0), inertia=(0.8, 0.9, 1.0), spin=(0.3, 1.0, -0.5)),
        "one": Rigid(mass=1.0, centre=(1, 0, 0), inertia=(0.1, 0.1, 0.2), velocity=(0, 0.5, 0), spin=(0, 0, 5)),
        "two": Rigid(mass=1.0, centre=(0, 1, 0), inertia=(0.2, 0.1, 0.1), velocity=(0.1, 0, 0), spin=(-2, 0, 0)),
    }
    joints = {
        "z": Hinge(between=("box", "one"), at=(1, 0, 0), axis=(0, 0, 1)),
        "x": Hinge(between=("box", "two"), at=(0, 1, 0), axis=AXIS),
    }
    gear = {"gear": Gear(joints=("z", "x"), ratio=0.7)}
    steps = list(march(Mechanism(bodies=bodies, joints=joints, gears=gear), until=30.0, step=0.01, every=50))
    for step in steps:
        assert step.joints < 1e-12 and abs(step.energy_error) < 1e-12 * step.energy_kinetic
        np.testing.assert_allclose(step.momentum, steps[0].momentum, atol=1e-12)
        np.testing.assert_allclose(step.spin, steps[0].spin, atol=1e-11)


@pytest.mark.parametrize("guide", [Slider, PinSlot])
def test_a_pinion_falls_with_its_rack(guide) -> None:
    """The rack falls with g m / (m + J / r^2); the gear may be given from either side."""
    bodies = {
        "pinion": Rigid(mass=1.0, centre=(0.0, 0.0), inertia=0.02),
        "rack": Rigid(mass=2.0, centre=(0.1, 0.0), inertia=0.1),
    }
    joints = {
        "axle": Hinge(between=("ground", "pinion"), at=(0.0, 0.0)),
        "guide": guide(between=("ground", "rack"), at=(0.1, 0.0), axis=(0.0, 1.0)),
    }
    found = []
    for gear in (Gear(joints=("axle", "guide"), ratio=0.1), Gear(joints=("guide", "axle"), ratio=10.0)):
        mechanism = Mechanism(bodies=bodies, joints=joints, gears={"gear": gear}, gravity=(0.0, -9.81))
        steps = list(march(mechanism, until=1.0, step=0.001))
        found.append([s.bodies["rack"].centre[1] for s in steps])
        np.testing.assert_allclose(0.1 * angles(steps, "pinion"), found[-1], atol=1e-13)
        assert max(abs(s.energy_error) for s in steps) < 1e-12
    assert found[0][-1] == pytest.approx(-0.5 * 9.81 * 2.0 / (2.0 + 0.02 / 0.01), rel=1e-4)
    np.testing.assert_allclose(found[0], found[1], atol=1e-12)


def test_a_motor_drives_a_gear() -> None:
    mechanism = wheels(motors={"m": Motor(joint="two", motion=Sine(amplitude=3.0, frequency=0.5))})
    steps = list(march(mechanism, until=3.0, step=0.005))
    exact = -3.0 / np.sqrt(2.0) * np.sin(np.pi * np.array([s.time for s in steps]))
    np.testing.assert_allclose(angles(steps, "one"), exact, atol=1e-12)
    assert max(abs(s.energy_error) for s in steps) < 1e-12
    over = replace(mechanism, motors=mechanism.motors | {"n": Motor(joint="one", motion=Steady(rate=1.0))})
    with pytest.raises(sw.InputError, match="prescribes a motion"):
        next(march(over, until=1.0, step=0.1))


TWO = wheels()


def geared(*joints: str) -> dict[str, Gear]:
    return {"g": Gear(joints=joints, ratio=1.0)}


def sliding() -> Mechanism:
    guides = {name: Slider(between=("ground", name), at=(0.0, 0.0), axis=(1.0, 0.0)) for name in ("one", "two")}
    return replace(TWO, joints=guides)


def welded() -> MechanismStep:
    weld = {"weld": Weld(between=("ground", "one"), at=(0.0, 0.0))}
    return next(march(replace(TWO, joints=TWO.joints | weld), until=1.0, step=0.1))


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Gear(joints=("one", "two"), ratio=0.0), "ratio: 0 couples nothing"),
        (lambda: Gear(joints=("one", "one"), ratio=1.0), "joints: 'one' twice"),
        (lambda: replace(TWO, gears=geared("one", "three")), "gears.g.joints: 'three' is no joint"),
        (lambda: replace(TWO, gears={"one": TWO.gears["gear"]}), "gears: .'one'. are names of joints"),
        (sliding, "both slide"),
        (welded, "gears.gear.joints: 'one' joins parts of one body"),
    ],
)
def test_wrong_couplings_are_refused(make, told: str) -> None:
    with pytest.raises(sw.InputError, match=told):
        make()


def test_a_screw_without_pitch_is_refused() -> None:
    nut = {"nut": Rigid(mass=1.0, centre=(0, 0, 0), inertia=(1, 1, 1))}
    screw = {"s": Screw(between=("ground", "nut"), at=(0, 0, 0), axis=(0, 0, 1), pitch=0.0)}
    with pytest.raises(sw.InputError, match="joints.s.pitch: 0 m"):
        next(march(Mechanism(bodies=nut, joints=screw), until=1.0, step=0.1))
