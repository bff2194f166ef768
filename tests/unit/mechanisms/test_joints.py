"""Joints between rigid bodies: what they hold, what they let move, and what they never change."""

from collections.abc import Callable

import numpy as np
import pytest

from softway.mechanisms import (
    BallJoint,
    Cylindrical,
    Hinge,
    Mechanism,
    MechanismStep,
    PinSlot,
    Rigid,
    Rod,
    Slider,
    Torque,
    Universal,
    Weld,
    march,
)
from softway.mechanisms.members.joints import Joint

AT = (0.6, 0.1, -0.2)
AXIS = np.array([1.0, 2.0, 2.0]) / 3.0


def pair(joint: Joint) -> Mechanism:
    """Two free bodies in space that turn against each other."""
    bodies = {
        "a": Rigid(
            mass=2.0, centre=(0.0, 0.0, 0.0), inertia=(0.3, 0.5, 0.6), velocity=(0.1, 0.0, 0.2), spin=(1, -2, 3)
        ),
        "b": Rigid(
            mass=1.0, centre=(1.0, 0.3, 0.1), inertia=(0.2, 0.1, 0.15), velocity=(0.0, -0.4, 0.1), spin=(-2, 4, 1)
        ),
    }
    return Mechanism(bodies=bodies, joints={"joint": joint})


def ends(step: MechanismStep) -> tuple[np.ndarray, np.ndarray]:
    """Place of the joint on both bodies."""
    return step.bodies["a"].point(AT, (0.0, 0.0, 0.0)), step.bodies["b"].point(AT, (1.0, 0.3, 0.1))


def apart(step: MechanismStep) -> np.ndarray:
    """Way from the joint of a to that of b in the axes of a at the start."""
    one, other = ends(step)
    return step.bodies["a"].rotation.T @ (other - one)


def turned(step: MechanismStep) -> np.ndarray:
    """Rotation of b seen from a."""
    return step.bodies["a"].rotation.T @ step.bodies["b"].rotation


def axis_kept(step: MechanismStep) -> float:
    return float(np.abs(turned(step) @ AXIS - AXIS).max())


def on_axis(step: MechanismStep) -> float:
    return float(np.linalg.norm(np.cross(apart(step), AXIS)))


def pinned(step: MechanismStep) -> float:
    return float(np.linalg.norm(apart(step)))


UNIVERSAL = ((0.0, 0.6, 0.8), (0.0, 0.8, -0.6))
KINDS: list[tuple[Joint, int, list[Callable[[MechanismStep], float]]]] = [
    (BallJoint(between=("a", "b"), at=AT), 3, [pinned]),
    (Hinge(between=("a", "b"), at=AT, axis=tuple(AXIS)), 5, [pinned, axis_kept]),
    (Weld(between=("a", "b"), at=AT), 0, [pinned, lambda s: float(np.abs(turned(s) - np.eye(3)).max())]),
    (
        Slider(between=("a", "b"), at=AT, axis=tuple(AXIS)),
        5,
        [on_axis, lambda s: float(np.abs(turned(s) - np.eye(3)).max())],
    ),
    (Cylindrical(between=("a", "b"), at=AT, axis=tuple(AXIS)), 4, [on_axis, axis_kept]),
    (
        Universal(between=("a", "b"), at=AT, axes=UNIVERSAL),
        4,
        [pinned, lambda s: abs(float(np.dot(UNIVERSAL[0], turned(s) @ UNIVERSAL[1])))],
    ),
    (
        Rod(between=("a", "b"), ends=((0.1, 0.0, 0.3), (1.0, 0.5, 0.1))),
        1,
        [
            lambda s: float(
                np.linalg.norm(
                    s.bodies["b"].point((1.0, 0.5, 0.1), (1.0, 0.3, 0.1))
                    - s.bodies["a"].point((0.1, 0, 0.3), (0, 0, 0))
                )
                - np.sqrt(0.81 + 0.25 + 0.04)
            )
        ],
    ),
]


@pytest.mark.parametrize(("joint", "rows", "held"), KINDS, ids=lambda it: type(it).__name__)
def test_a_joint_in_space_holds_and_keeps_energy_momentum_and_spin(joint, rows, held) -> None:
    steps = list(march(pair(joint), until=2.0, step=0.01, every=10))
    start, last = steps[0], steps[-1]
    assert last.independent == rows
    for step in steps:
        assert all(abs(error(step)) < 1e-13 for error in held)
        assert step.joint_velocity < 1e-13
        assert abs(step.energy_error) < 1e-13 * start.energy_kinetic
        np.testing.assert_allclose(step.momentum, start.momentum, atol=1e-13)
        np.testing.assert_allclose(step.spin, start.spin, atol=2e-13)
    way = [np.linalg.norm(s.bodies["b"].centre - steps[0].bodies["b"].centre) for s in steps]
    assert max(way) > 0.1, "it moves"


def test_the_error_is_of_second_order() -> None:
    """Against a march of very short slabs."""
    mechanism = pair(Hinge(between=("a", "b"), at=AT, axis=tuple(AXIS)))
    places = [
        list(march(mechanism, until=1.0, step=h, every=10**6))[-1].bodies["b"].centre for h in (0.02, 0.01, 0.0005)
    ]
    coarse, fine = (np.linalg.norm(place - places[2]) for place in places[:2])
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.05)


def test_welded_bodies_move_as_one() -> None:
    """The inertia of two welded bodies by Steiner's theorem, against one body with it."""
    bodies = {
        "a": Rigid(mass=2.0, centre=(0.0, 0.0, 0.0), inertia=(0.3, 0.5, 0.6)),
        "b": Rigid(mass=1.0, centre=(0.9, 0.0, 0.0), inertia=(0.2, 0.1, 0.15)),
    }
    spin = np.array([1.0, 0.2, 2.0])
    centre = np.array([0.3, 0.0, 0.0])
    for name, body in bodies.items():
        velocity = np.cross(spin, np.asarray(body.centre) - centre)
        bodies[name] = Rigid(
            mass=body.mass, centre=body.centre, inertia=body.inertia, velocity=tuple(velocity), spin=tuple(spin)
        )
    two = Mechanism(bodies=bodies, joints={"weld": Weld(between=("a", "b"), at=(0.5, 0.0, 0.0))})
    own = (0.5, 0.6 + 2.0 * 0.09 + 0.36, 0.75 + 2.0 * 0.09 + 0.36)
    one = Mechanism(bodies={"c": Rigid(mass=3.0, centre=tuple(centre), inertia=own, spin=tuple(spin))})
    turned_two, turned_one = (list(march(m, until=2.0, step=0.005, every=10**6))[-1].bodies for m in (two, one))
    np.testing.assert_allclose(turned_two["a"].rotation, turned_one["c"].rotation, atol=2e-5)


def test_a_slider_in_the_plane_does_not_turn_and_a_pin_in_a_slot_does() -> None:
    body = Rigid(mass=1.0, centre=(0.0, 0.2), inertia=0.1, velocity=(1.0, 0.0))
    for joint, rows in (
        (Slider(between=("ground", "b"), at=(0.0, 0.0), axis=(1.0, 0.0)), 2),
        (PinSlot(between=("ground", "b"), at=(0.0, 0.0), axis=(1.0, 0.0)), 1),
    ):
        mechanism = Mechanism(bodies={"b": body}, joints={"guide": joint}, gravity=(0.0, -9.81))
        steps = list(march(mechanism, until=0.5, step=0.01))
        pin = [s.bodies["b"].point((0.0, 0.0), (0.0, 0.2)) for s in steps]
        assert np.abs(np.array(pin)[:, 1]).max() < 1e-13 and steps[-1].independent == rows
        turning = max(abs(s.bodies["b"].rotation[1, 0]) for s in steps)
        assert turning < 1e-13 if rows == 2 else turning > -1.0
        if rows == 2:
            assert pin[-1][0] == pytest.approx(0.5, rel=1e-12)


def test_cardan_error_of_a_universal_joint() -> None:
    """Shafts at 30 degrees: tan of the first angle is tan of the second times cos 30."""
    bend = np.deg2rad(30.0)
    second = np.array([np.cos(bend), np.sin(bend), 0.0])
    bodies = {
        "in": Rigid(mass=1.0, centre=(-1.0, 0.0, 0.0), inertia=(100.0, 60.0, 60.0), spin=(2.0, 0.0, 0.0)),
        "out": Rigid(
            mass=1.0, centre=tuple(second), inertia=(1e-3, 1e-3, 1e-3), spin=tuple(2.0 / np.cos(bend) * second)
        ),
    }
    joints = {
        "first": Hinge(between=("ground", "in"), at=(-1.0, 0.0, 0.0), axis=(1.0, 0.0, 0.0)),
        "cross": Universal(between=("in", "out"), at=(0.0, 0.0, 0.0), axes=((0.0, 1.0, 0.0), (0.0, 0.0, 1.0))),
        "second": Hinge(between=("ground", "out"), at=tuple(second), axis=tuple(second)),
    }
    across = np.array([-np.sin(bend), np.cos(bend), 0.0])
    for step in march(Mechanism(bodies=bodies, joints=joints), until=2.0, step=0.01):
        one = step.bodies["in"].rotation @ [0.0, 1.0, 0.0]
        other = step.bodies["out"].rotation @ [0.0, 0.0, 1.0]
        first = np.arctan2(one[2], one[1])
        out = np.arctan2(-other @ across, other[2])
        assert np.sin(out) * np.cos(first) * np.cos(bend) == pytest.approx(np.cos(out) * np.sin(first), abs=1e-12)


def test_a_torque_turns_a_wheel_about_its_axis() -> None:
    """Constant acceleration, and the work of the torque is that of the angle."""
    wheel = Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(0.2, 0.2, 0.4))
    axle = Hinge(between=("ground", "wheel"), at=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    mechanism = Mechanism(
        bodies={"wheel": wheel}, joints={"axle": axle}, torques=(Torque(on="wheel", value=(0.0, 0.0, 0.8)),)
    )
    last = list(march(mechanism, until=3.0, step=0.001, every=10**6))[-1]
    assert last.bodies["wheel"].spin[2] == pytest.approx(6.0, rel=1e-5)
    assert last.work == pytest.approx(last.energy_kinetic, rel=1e-12)
