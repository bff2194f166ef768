"""March of a mechanism: springs, dampers, starts, singular positions, and input that is refused."""

import numpy as np
import pytest

import softway as sw
from softway.mechanisms import BallJoint, Hinge, Mechanism, Rigid, Rod, Slider, Spring, Torque, march


def test_a_mass_on_a_spring_swings_with_its_frequency() -> None:
    """The linear spring is the trapezoidal rule: its frequency is known for every slab length."""
    h, k = 0.05, 4.0
    spring = Spring(between=("ground", "m"), ends=((0.0, 0.0), (3.0, 0.0)), stiffness=k, rest=2.5)
    guide = Slider(between=("ground", "m"), at=(3.0, 0.0), axis=(1.0, 0.0))
    mass = Rigid(mass=1.0, centre=(3.0, 0.0), inertia=0.1)
    steps = list(march(Mechanism(bodies={"m": mass}, joints={"g": guide}, springs=(spring,)), until=10.0, step=h))
    angle = 2.0 * np.arctan(0.5 * h * np.sqrt(k))
    exact = 2.5 + 0.5 * np.cos(angle * np.arange(len(steps)))
    np.testing.assert_allclose([s.bodies["m"].centre[0] for s in steps], exact, atol=1e-12)
    assert max(abs(s.energy_error) for s in steps) < 1e-14


def test_a_damper_dissipates_what_the_mass_loses() -> None:
    damper = Spring(between=("ground", "m"), ends=((0.0, 0.0), (1.0, 0.0)), damping=0.5)
    mass = Rigid(mass=1.0, centre=(1.0, 0.0), velocity=(1.0, 0.0))
    steps = list(march(Mechanism(bodies={"m": mass}, springs=(damper,)), until=4.0, step=0.001, every=100))
    assert steps[-1].bodies["m"].velocity[0] == pytest.approx(np.exp(-2.0), rel=1e-6)
    assert steps[-1].dissipation == pytest.approx(0.5 * (1.0 - np.exp(-4.0)), rel=1e-6)
    assert all(b.dissipation >= a.dissipation for a, b in zip(steps, steps[1:], strict=False))
    assert max(abs(s.energy_error) for s in steps) < 1e-13


def test_a_heavy_top_keeps_energy_and_its_two_angular_momenta() -> None:
    """A symmetric top on a ball joint precesses; the momenta about the vertical and about its axis stay."""
    tilt = np.deg2rad(30.0)
    axis = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    own = 0.02 * np.eye(3) + (0.03 - 0.02) * np.outer(axis, axis)
    spin = 40.0 * axis
    top = Rigid(mass=1.0, centre=tuple(0.1 * axis), inertia=tuple(map(tuple, own.tolist())), spin=tuple(spin))
    joint = BallJoint(between=("ground", "top"), at=(0.0, 0.0, 0.0))
    mechanism = Mechanism(bodies={"top": top}, joints={"tip": joint}, gravity=(0.0, 0.0, -9.81))
    steps = list(march(mechanism, until=2.0, step=1e-3))
    changes = []
    for found in (list(march(mechanism, until=2.0, step=2e-3)), steps):
        about_own = [float((s.bodies["top"].rotation @ axis) @ s.bodies["top"].spin) for s in found]
        changes.append([float(np.ptp([s.spin[2] for s in found])), 0.03 * float(np.ptp(about_own))])
        assert max(abs(s.energy_error) for s in found) < 1e-12
    assert max(changes[1]) < 1e-7
    assert np.log2(changes[0][0] / changes[1][0]) > 2.9, (
        "the scalar, which keeps the energy, is 1 + O(h^4) in each slab"
    )
    tips = np.unwrap([np.arctan2(*s.bodies["top"].centre[1::-1]) for s in steps])
    steady = 9.81 * 0.1 / (0.03 * 40.0)
    assert (tips[-1] - tips[0]) / 2.0 == pytest.approx(steady, rel=0.05)


def test_velocities_that_joints_do_not_allow_are_replaced_by_the_nearest() -> None:
    """A rod about its end with the velocity of its centre only: momentum about the hinge stays."""
    rod = Rigid(mass=3.0, centre=(1.0, 0.0), inertia=1.0, velocity=(5.0, 2.0))
    hinge = Hinge(between=("ground", "rod"), at=(0.0, 0.0))
    first = next(march(Mechanism(bodies={"rod": rod}, joints={"hinge": hinge}), until=1.0, step=0.1))
    assert first.bodies["rod"].spin[0] == pytest.approx(3.0 * 2.0 / 4.0, rel=1e-13)
    assert first.bodies["rod"].velocity == pytest.approx([0.0, 1.5], abs=1e-13)
    assert first.energy_error == 0.0


def test_free_bodies_beside_a_held_one_keep_what_they_have() -> None:
    """Groups do not exchange energy through the scalar."""
    bodies = {
        "free": Rigid(mass=1.0, centre=(5.0, 0.0), velocity=(0.0, 1.0)),
        "held": Rigid(mass=1.0, centre=(1.0, 0.0)),
    }
    joints = {"rod": Rod(between=("ground", "held"), ends=((0.0, 0.0), (1.0, 0.0)))}
    last = list(march(Mechanism(bodies=bodies, joints=joints, gravity=(0.0, -1.0)), until=1.0, step=0.01))[-1]
    assert last.bodies["free"].velocity == pytest.approx([0.0, 0.0], abs=1e-14)
    assert last.bodies["free"].centre == pytest.approx([5.0, 0.5], abs=1e-13)


def test_the_same_march_gives_the_same_bits() -> None:
    def ends() -> list[np.ndarray]:
        bodies = {"a": Rigid(mass=1.0, centre=(1.0, 0.0)), "b": Rigid(mass=2.0, centre=(2.0, 0.0))}
        joints = {
            "p": Rod(between=("ground", "a"), ends=((0.0, 0.0), (1.0, 0.0))),
            "q": Rod(between=("a", "b"), ends=((1.0, 0.0), (2.0, 0.0))),
        }
        last = list(march(Mechanism(bodies=bodies, joints=joints, gravity=(0.0, -9.81)), until=3.0, step=0.01))[-1]
        return [last.bodies[name].centre for name in bodies]

    assert np.array_equal(ends(), ends())


ROD = {"m": Rigid(mass=1.0, centre=(1.0, 0.0))}


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Rigid(mass=0.0, centre=(0.0, 0.0)), "mass: 0 kg is not positive"),
        (lambda: Rigid(mass=1.0, centre=(0.0,)), "centre"),
        (lambda: Rigid(mass=1.0, centre=(0.0, 0.0), velocity=(1.0,)), "velocity"),
        (lambda: Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), spin=2.0), "spin: 2.0 for a body in 3D"),
        (lambda: Rigid(mass=1.0, centre=(0.0, 0.0), inertia=-1.0), "negative"),
        (lambda: Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 3.0)), "more than the sum"),
        (lambda: Rigid(mass=1.0, centre=(0.0, 0.0), inertia=(1.0, 1.0, 1.0)), "inertia: .* in the plane"),
        (lambda: Spring(between=("a", "b"), ends=((0.0,), (1.0,)), stiffness=-1.0), "stiffness"),
        (lambda: Mechanism(bodies={}), "bodies: is empty"),
        (lambda: Mechanism(bodies={"ground": ROD["m"]}), "ground"),
        (lambda: Mechanism(bodies=ROD, gravity=(0.0, 0.0, -9.8)), "gravity"),
        (lambda: Mechanism(bodies=ROD | {"n": Rigid(mass=1.0, centre=(0.0, 0.0, 0.0))}), "some in space"),
        (
            lambda: Mechanism(bodies=ROD, joints={"j": Hinge(between=("ground", "rod"), at=(0.0, 0.0))}),
            r"joints.j.between: no body 'rod'\n  try: one of \['m', 'ground'\]",
        ),
        (lambda: Mechanism(bodies=ROD, joints={"j": Hinge(between=("m", "m"), at=(0.0, 0.0))}), "'m' twice"),
        (lambda: Mechanism(bodies=ROD, joints={"j": Hinge(between=("ground", "m"), at=(0.0, 0.0, 0.0))}), "joints.j"),
    ],
)
def test_wrong_descriptions_are_refused(make, told: str) -> None:
    with pytest.raises(sw.InputError, match=told):
        make()


@pytest.mark.parametrize(
    ("joint", "told"),
    [
        (Hinge(between=("ground", "m"), at=(0.0, 0.0)), "joints.j: turns 'm' about an axis without inertia"),
        (Rod(between=("ground", "m"), ends=((1.0, 0.0), (1.0, 0.0))), "joints.j.ends: both at"),
        (Slider(between=("ground", "m"), at=(1.0, 0.0), axis=(0.0, 0.0)), "joints.j.axis"),
    ],
)
def test_joints_that_cannot_be_are_refused(joint, told: str) -> None:
    with pytest.raises(sw.InputError, match=told):
        march(Mechanism(bodies=ROD, joints={"j": joint}), until=1.0, step=0.1)


def test_a_hinge_in_space_needs_its_axis_and_a_torque_its_components() -> None:
    body = {"b": Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))}
    with pytest.raises(sw.InputError, match="joints.j.axis: Hinge in space without an axis"):
        march(Mechanism(bodies=body, joints={"j": Hinge(between=("ground", "b"), at=(0, 0, 0))}), until=1.0, step=0.1)
    with pytest.raises(sw.InputError, match=r"torques\[0\].value"):
        march(Mechanism(bodies=body, torques=(Torque(on="b", value=1.0),)), until=1.0, step=0.1)


@pytest.mark.parametrize(
    ("given", "told"), [({"until": -1.0, "step": 0.1}, "until"), ({"until": 1.0, "step": 2.0}, "step")]
)
def test_times_that_cannot_be_are_refused(given: dict[str, float], told: str) -> None:
    with pytest.raises(sw.InputError, match=told):
        march(Mechanism(bodies=ROD), **given)
