"""Torsion springs, torques about hinges, and dead loads: exact motions, work, and balances."""

import numpy as np
import pytest

import softway as sw
from softway.mechanisms import (
    Cylindrical,
    Hinge,
    HingeTorque,
    Mechanism,
    MechanismStep,
    PointForce,
    Rigid,
    Spring,
    Torque,
    TorsionSpring,
    Weld,
    march,
)

AT = (0.6, 0.1, -0.2)
AXIS = tuple(np.array([1.0, 2.0, 2.0]) / 3.0)
WHEEL = Mechanism(
    bodies={"wheel": Rigid(mass=1.0, centre=(0.0, 0.0), inertia=0.5)},
    joints={"axle": Hinge(between=("ground", "wheel"), at=(0.0, 0.0))},
)


def changed(mechanism: Mechanism, **members: object) -> Mechanism:
    fields = {
        name: getattr(mechanism, name) for name in ("bodies", "joints", "springs", "torques", "forces", "gravity")
    }
    return Mechanism(**(fields | members))


def free_pair(**members: object) -> Mechanism:
    """Two free bodies in space with a hinge."""
    bodies = {
        "a": Rigid(mass=2.0, centre=(0, 0, 0), inertia=(0.3, 0.5, 0.6), velocity=(0.1, 0.0, 0.2), spin=(1, -2, 3)),
        "b": Rigid(mass=1.0, centre=(1, 0.3, 0.1), inertia=(0.2, 0.1, 0.15), velocity=(0, -0.4, 0.1), spin=(-2, 4, 1)),
    }
    return Mechanism(bodies=bodies, joints={"hinge": Hinge(between=("a", "b"), at=AT, axis=AXIS)}, **members)


def counted(steps: list[MechanismStep]) -> np.ndarray:
    """Angle of the wheel, with all turns."""
    return np.unwrap([np.arctan2(s.bodies["wheel"].rotation[1, 0], s.bodies["wheel"].rotation[0, 0]) for s in steps])


def test_a_torsion_spring_counts_turns_and_swings_with_its_period() -> None:
    """Released 9 rad from the angle without moment: phi = 9 (1 - cos 2 t)."""
    errors = []
    for h in (0.005, 0.0025):
        steps = list(
            march(changed(WHEEL, springs=(TorsionSpring(joint="axle", stiffness=2.0, rest=9.0),)), until=6.0, step=h)
        )
        exact = 9.0 * (1.0 - np.cos(2.0 * np.array([s.time for s in steps])))
        errors.append(np.abs(counted(steps) - exact).max())
        assert max(abs(s.energy_error) for s in steps) < 1e-12 * steps[0].energy_potential
    assert steps[0].energy_potential == pytest.approx(81.0)
    assert errors[1] < 0.01 and np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


def test_a_torsion_spring_in_space_keeps_energy_momentum_and_spin() -> None:
    """Between free bodies about a skew hinge, over several turns and thousands of slabs."""
    springs = (TorsionSpring(joint="hinge", stiffness=0.3, rest=8.0),)
    steps = list(march(free_pair(springs=springs), until=40.0, step=0.01, every=50))
    total = steps[0].energy_kinetic + steps[0].energy_potential
    assert np.ptp([s.energy_potential for s in steps]) > 0.5 * total
    for step in steps:
        assert abs(step.energy_error) < 1e-12 * total and step.joints < 1e-12
        np.testing.assert_allclose(step.momentum, steps[0].momentum, atol=1e-12)
        np.testing.assert_allclose(step.spin, steps[0].spin, atol=1e-11)


def test_a_torsion_spring_works_on_a_cylindrical_joint_that_slides() -> None:
    mechanism = free_pair(springs=(TorsionSpring(joint="hinge", stiffness=0.5),))
    mechanism = changed(mechanism, joints={"hinge": Cylindrical(between=("a", "b"), at=AT, axis=AXIS)})
    steps = list(march(mechanism, until=5.0, step=0.01))
    assert max(abs(s.energy_error) for s in steps) < 1e-12
    np.testing.assert_allclose(steps[-1].spin, steps[0].spin, atol=1e-12)


def test_a_torsion_damper_dissipates_what_the_wheel_loses() -> None:
    wheel = Rigid(mass=1.0, centre=(0.0, 0.0), inertia=0.5, spin=6.0)
    damped = changed(WHEEL, bodies={"wheel": wheel}, springs=(TorsionSpring(joint="axle", damping=0.25),))
    steps = list(march(damped, until=4.0, step=0.002, every=100))
    assert steps[-1].bodies["wheel"].spin[0] == pytest.approx(6.0 * np.exp(-2.0), rel=2e-5)
    assert all(b.dissipation > a.dissipation for a, b in zip(steps, steps[1:], strict=False))
    assert max(abs(s.energy_error) for s in steps) < 1e-13


def test_a_torque_about_a_hinge_acts_on_both_bodies_and_works_by_the_angle() -> None:
    """The free bodies turn against each other; momentum and spin stay."""
    steps = list(march(free_pair(torques=(HingeTorque(joint="hinge", value=0.7),)), until=10.0, step=0.01))
    axis = np.array([s.bodies["a"].rotation @ AXIS for s in steps])
    rate = [(s.bodies["b"].spin - s.bodies["a"].spin) @ n for s, n in zip(steps, axis, strict=True)]
    angle = 0.005 * (np.array(rate[1:]) + rate[:-1]).sum()
    assert angle > 20.0 and steps[-1].work == pytest.approx(0.7 * angle, rel=1e-2)
    for step in steps:
        assert abs(step.energy_error) < 1e-12 * step.energy_kinetic
        np.testing.assert_allclose(step.momentum, steps[0].momentum, atol=1e-12)
        np.testing.assert_allclose(step.spin, steps[0].spin, atol=1e-12)


def test_a_torque_on_one_of_two_free_bodies_leaves_the_momentum() -> None:
    steps = list(march(free_pair(torques=(Torque(on="a", value=(0.0, 0.5, 0.2)),)), until=5.0, step=0.01))
    for step in steps:
        assert abs(step.energy_error) < 1e-8, "kept until the bodies move against each other again"
        np.testing.assert_allclose(step.momentum, steps[0].momentum, atol=1e-13)
    assert abs(steps[-1].energy_error) < 1e-12


def test_a_dead_load_works_like_weight() -> None:
    """The weight of a rod as a force at its centre: the same motion, and its work is exact."""
    rod = {"rod": Rigid(mass=2.0, centre=(0.5, 0.0), inertia=0.2)}
    hinge = {"hinge": Hinge(between=("ground", "rod"), at=(0.0, 0.0))}
    load = PointForce(on="rod", at=(0.5, 0.0), value=(3.0, -20.0))
    loaded = list(march(Mechanism(bodies=rod, joints=hinge, forces=(load,)), until=20.0, step=0.005))
    heavy = list(march(Mechanism(bodies=rod, joints=hinge, gravity=(1.5, -10.0)), until=20.0, step=0.005))
    for one, other in zip(loaded, heavy, strict=True):
        np.testing.assert_allclose(one.bodies["rod"].centre, other.bodies["rod"].centre, atol=1e-11)
        assert one.work == pytest.approx(np.dot((3.0, -20.0), one.bodies["rod"].centre - (0.5, 0.0)), abs=1e-12)
        assert abs(one.energy_error) < 1e-12


def test_a_dead_load_beside_the_centre_turns_a_free_body_in_space() -> None:
    """Momentum is force times time; the work is that of the moving point."""
    at, force = (0.3, 0.2, -0.1), np.array([1.0, -2.0, 0.5])
    body = Rigid(mass=2.0, centre=(0, 0, 0), inertia=(0.3, 0.5, 0.6), spin=(1, 2, 3))
    mechanism = Mechanism(bodies={"b": body}, forces=(PointForce(on="b", at=at, value=tuple(force)),))
    for step in march(mechanism, until=20.0, step=0.01, every=20):
        way = step.bodies["b"].point(at, (0, 0, 0)) - at
        assert step.work == pytest.approx(force @ way, rel=1e-12, abs=1e-12)
        assert abs(step.energy_error) < 1e-12 * max(1.0, step.energy_kinetic)
        np.testing.assert_allclose(step.momentum, force * step.time, atol=1e-11)


def test_members_of_welded_bodies_move_to_the_whole() -> None:
    """A force on a part of the rod; the torsion spring of a hinge between welded parts is inert."""
    bodies = {
        "one": Rigid(mass=1.0, centre=(0.25, 0.0), inertia=0.1),
        "two": Rigid(mass=1.0, centre=(0.75, 0.0), inertia=0.1),
    }
    joints = {
        "hinge": Hinge(between=("ground", "one"), at=(0.0, 0.0)),
        "weld": Weld(between=("one", "two"), at=(0.5, 0.0)),
        "inner": Hinge(between=("one", "two"), at=(0.5, 0.0)),
    }
    parts = Mechanism(
        bodies=bodies,
        joints=joints,
        springs=(TorsionSpring(joint="inner", stiffness=5.0), TorsionSpring(joint="hinge", stiffness=2.0)),
        forces=(PointForce(on="two", at=(1.0, 0.0), value=(0.0, -3.0)),),
    )
    whole = Mechanism(
        bodies={"one": Rigid(mass=2.0, centre=(0.5, 0.0), inertia=0.2 + 2.0 * 0.0625)},
        joints={"hinge": joints["hinge"]},
        springs=(TorsionSpring(joint="hinge", stiffness=2.0),),
        forces=(PointForce(on="one", at=(1.0, 0.0), value=(0.0, -3.0)),),
    )
    one, other = (list(march(m, until=2.0, step=0.01))[-1].bodies["one"].rotation for m in (parts, whole))
    np.testing.assert_allclose(one, other, atol=1e-12)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: TorsionSpring(joint="axle", stiffness=-1.0), "stiffness: -1 is negative"),
        (lambda: TorsionSpring(joint="axle", rest=np.inf), "rest: inf is not finite"),
        (lambda: HingeTorque(joint="axle", value=np.nan), "value: nan is not finite"),
        (lambda: PointForce(on="wheel", at=(0.0, 0.0), value=(1.0,)), "value: .* 2 finite components"),
        (
            lambda: changed(WHEEL, forces=(PointForce(on="w", at=(0.0, 0.0), value=(1.0, 0.0)),)),
            r"forces\[0\].*no body 'w'",
        ),
        (lambda: changed(WHEEL, forces=(PointForce(on="wheel", at=(0, 0, 0), value=(1, 0, 0)),)), r"forces\[0\]"),
        (
            lambda: changed(WHEEL, springs=(TorsionSpring(joint="pin"),)),
            r"springs\[0\].joint: 'pin' is no joint .*\n.*\['axle'\]",
        ),
        (lambda: changed(WHEEL, torques=(HingeTorque(joint="pin", value=1.0),)), r"torques\[0\].joint: 'pin'"),
    ],
)
def test_wrong_forces_are_refused(make, told: str) -> None:
    with pytest.raises(sw.InputError, match=f"(?s){told}"):
        make()


def test_springs_of_all_kinds_go_together() -> None:
    springs = (
        Spring(between=("a", "b"), ends=((0, 0, 1), (1, 1, 0)), stiffness=3.0),
        TorsionSpring(joint="hinge", stiffness=1.0),
    )
    last = list(march(free_pair(springs=springs, gravity=(0.0, 0.0, -9.81)), until=5.0, step=0.005))[-1]
    assert abs(last.energy_error) < 1e-11
