"""Motors: the motion is the prescribed one, their work closes the balance, their torques are those of the motion."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import softway as sw
from softway.bodies.setup.motion_laws import Haversine, SmoothSteps, Spline, value_and_rate
from softway.mechanisms import (
    Cylindrical,
    Hinge,
    Mechanism,
    MechanismStep,
    Motor,
    PlaneStop,
    Polyline,
    RatePolyline,
    Rigid,
    Sine,
    Slider,
    Spring,
    Steady,
    TorsionSpring,
    Weld,
    march,
)
from softway.mechanisms.members.motors import Prescribed

AT = (0.6, 0.1, -0.2)
AXIS = tuple(np.array([1.0, 2.0, 2.0]) / 3.0)
INERTIA = 0.5


def wheel(motion: Prescribed, **members: object) -> Mechanism:
    """Wheel with a motor."""
    return Mechanism(
        bodies={"wheel": Rigid(mass=1.0, centre=(0.0, 0.0), inertia=INERTIA)},
        joints={"axle": Hinge(between=("ground", "wheel"), at=(0.0, 0.0))},
        motors={"motor": Motor(joint="axle", motion=motion)},
        **members,
    )


def turned(step: MechanismStep, body: str = "wheel") -> float:
    rotation = step.bodies[body].rotation
    return float(np.arctan2(rotation[1, 0], rotation[0, 0]))


def same_angle(one: float, other: float) -> float:
    """Difference of two angles without full turns."""
    return abs(float(np.remainder(one - other + np.pi, 2.0 * np.pi) - np.pi))


def test_a_motor_of_constant_rate_works_against_a_damper() -> None:
    damped = wheel(Steady(rate=10.0), springs=(TorsionSpring(joint="axle", damping=0.2),))
    for step in march(damped, until=5.0, step=0.01, every=10):
        assert same_angle(turned(step), 10.0 * step.time) < 1e-12 and step.joints < 1e-13
        assert step.bodies["wheel"].spin[0] == pytest.approx(10.0, rel=1e-13)
        assert step.work == pytest.approx(0.2 * 100.0 * step.time, rel=1e-11)
        assert step.motors["motor"] == pytest.approx(2.0 if step.time else 0.0, rel=1e-3)
        assert abs(step.energy_error) < 1e-12


def test_a_ramp_of_the_rate_has_the_torque_of_the_inertia() -> None:
    """Three ramps whose knots are ends of slabs."""
    steps = list(
        march(wheel(RatePolyline(times=(0.0, 1.0, 2.0, 3.0), rates=(0.0, 4.0, 4.0, 1.0))), until=4.0, step=0.01)
    )
    for step, rate in ((50, 2.0), (150, 4.0), (250, 2.5), (400, 1.0)):
        assert steps[step].bodies["wheel"].spin[0] == pytest.approx(rate, rel=1e-12)
        assert steps[step].work == pytest.approx(0.5 * INERTIA * rate**2, rel=1e-12)
    assert [steps[k].motors["motor"] for k in (50, 150, 250)] == pytest.approx([2.0, 0.0, -1.5], abs=1e-3)
    assert same_angle(turned(steps[-1]), 2.0 + 4.0 + 2.5 + 1.0) < 1e-12


def test_a_table_of_angles_is_followed_with_its_corners() -> None:
    """Corners inside slabs: the angle is exact, and the balance closes."""
    times, values = (-1.0, 0.333, 0.777, 1.234), (2.0, 3.333, 0.5, 8.0)
    steps = list(march(wheel(Polyline(times=times, values=values)), until=2.0, step=0.01))
    for step in steps:
        assert same_angle(turned(step), float(np.interp(step.time, times, values)) - 3.0) < 1e-12
        assert abs(step.energy_error) < 1e-13
    assert steps[-1].work == pytest.approx(-steps[0].energy_kinetic, rel=1e-12), "it rests at the end"


def test_the_torque_of_a_sine_is_of_second_order() -> None:
    errors = []
    for h in (0.01, 0.005):
        steps = list(march(wheel(Sine(amplitude=0.7, frequency=0.5, phase=0.3)), until=3.0, step=h))
        angle = [0.7 * (np.sin(np.pi * s.time + 0.3) - np.sin(0.3)) for s in steps]
        assert max(same_angle(turned(s), a) for s, a in zip(steps, angle, strict=True)) < 1e-13
        assert max(abs(s.energy_error) for s in steps) < 1e-13
        middle = np.array([s.time for s in steps[1:]]) - 0.5 * h
        torque = -INERTIA * 0.7 * np.pi**2 * np.sin(np.pi * middle + 0.3)
        errors.append(np.abs([s.motors["motor"] for s in steps[1:]] - torque)[1:].max())
    assert errors[0] < 1e-3 and np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


SMOOTH = [
    Spline(times=(-0.3, 0.333, 0.777, 1.234), points=(2.0, 3.333, 0.5, 4.0)),
    SmoothSteps(times=(0.2, 0.9, 1.4), points=(0.0, 2.0, -1.0)),
    Haversine(height=1.5, duration=0.77, start=0.4),
]


@pytest.mark.parametrize("law", SMOOTH, ids=lambda law: type(law).__name__)
def test_a_smooth_law_is_followed(law: Prescribed) -> None:
    """The angle is exact at the end of every slab, the balance closes, and the work of a return to rest is none."""
    steps = list(march(wheel(law), until=2.0, step=0.013))
    start = value_and_rate(law.pieces, 0.0)[0]
    for step in steps:
        assert same_angle(turned(step), value_and_rate(law.pieces, step.time)[0] - start) < 1e-12
        assert abs(step.energy_error) < 1e-13
    assert steps[-1].bodies["wheel"].spin[0] == pytest.approx(0.0, abs=1e-12)
    assert max(abs(s.bodies["wheel"].spin[0]) for s in steps) > 1.0


def test_a_pendulum_on_a_shaken_cart() -> None:
    """Against an integration of its equation; the motor of the cart does the work that the pendulum has."""
    size, often = 0.2, 1.3
    cart = Rigid(mass=5.0, centre=(0.0, 0.0), inertia=1.0)
    joints = {
        "rail": Slider(between=("ground", "cart"), at=(0.0, 0.0), axis=(1.0, 0.0)),
        "pin": Hinge(between=("cart", "arm"), at=(0.0, 0.0)),
    }
    mechanism = Mechanism(
        bodies={"cart": cart, "arm": Rigid(mass=1.0, centre=(0.0, -1.0), inertia=0.1)},
        joints=joints,
        motors={"shaker": Motor(joint="rail", motion=Sine(amplitude=size, frequency=often))},
        gravity=(0.0, -9.81),
    )
    w = 2.0 * np.pi * often

    def rates(t: float, y: np.ndarray) -> list[float]:
        return [y[1], (-9.81 * np.sin(y[0]) + size * w * w * np.sin(w * t) * np.cos(y[0])) / 1.1]

    start = [0.0, -size * w / 1.1]  # the pin has the velocity of the cart, the momentum about it was zero
    times = np.linspace(0.0, 4.0, 201)
    exact = solve_ivp(rates, (0.0, 4.0), start, rtol=1e-11, atol=1e-12, t_eval=times).y[0]
    errors = []
    for every in (5, 10):
        steps = list(march(mechanism, until=4.0, step=0.02 / every, every=every))
        errors.append(np.abs(np.array([turned(s, "arm") for s in steps]) - exact).max())
        for step in steps:
            assert step.bodies["cart"].centre[0] == pytest.approx(size * np.sin(w * step.time), abs=1e-13)
            assert abs(step.energy_error) < 1e-12 and step.joint_velocity < 1e-12
    assert errors[0] < 1e-3 and np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)


def test_a_driven_slider_crank_has_no_other_freedom() -> None:
    """The work of the motor is the energy, the integral of its torque over the angle, and the crank is exact."""
    bodies = {
        "crank": Rigid(mass=0.04, centre=(0.05, 0.0), inertia=3e-5),
        "rod": Rigid(mass=0.06, centre=(0.2, 0.0), inertia=2e-4),
        "slider": Rigid(mass=0.1, centre=(0.3, 0.0), inertia=1e-5),
    }
    joints = {
        "main": Hinge(between=("ground", "crank"), at=(0.0, 0.0)),
        "pin": Hinge(between=("crank", "rod"), at=(0.1, 0.0)),
        "wrist": Hinge(between=("rod", "slider"), at=(0.3, 0.0)),
        "guide": Slider(between=("ground", "slider"), at=(0.3, 0.0), axis=(1.0, 0.0)),
    }
    motors = {"motor": Motor(joint="main", motion=Steady(rate=100.0))}
    spring = Spring(between=("ground", "slider"), ends=((0.5, 0.0), (0.3, 0.0)), stiffness=500.0)
    engine = Mechanism(bodies=bodies, joints=joints, motors=motors, springs=(spring,), gravity=(0.0, -9.81))
    steps = list(march(engine, until=0.5, step=1e-4))
    total = np.array([s.energy_kinetic + s.energy_potential for s in steps])
    assert max(abs(s.energy_error) for s in steps) < 1e-12 * total.max()
    assert steps[-1].joints < 1e-14 and same_angle(turned(steps[-1], "crank"), 50.0) < 1e-12
    power = 100.0 * np.array([s.motors["motor"] for s in steps[1:]])
    np.testing.assert_allclose(1e-4 * np.cumsum(power), total[1:] - total[0], atol=1e-4 * total.max())


def test_a_motor_between_free_bodies_keeps_momentum_and_spin() -> None:
    """A reaction wheel about a skew axis, several turns over thousands of slabs."""
    bodies = {
        "a": Rigid(mass=2.0, centre=(0, 0, 0), inertia=(0.3, 0.5, 0.6), velocity=(0.1, 0.0, 0.2), spin=(1, -2, 3)),
        "b": Rigid(mass=1.0, centre=(1, 0.3, 0.1), inertia=(0.2, 0.1, 0.15), velocity=(0, -0.4, 0.1), spin=(-2, 4, 1)),
    }
    joints = {"hinge": Hinge(between=("a", "b"), at=AT, axis=AXIS)}
    motors = {"motor": Motor(joint="hinge", motion=RatePolyline(times=(0.0, 10.0), rates=(1.0, 4.0)))}
    steps = list(march(Mechanism(bodies=bodies, joints=joints, motors=motors), until=40.0, step=0.01, every=100))
    for step in steps:
        np.testing.assert_allclose(step.momentum, steps[0].momentum, atol=1e-12)
        np.testing.assert_allclose(step.spin, steps[0].spin, atol=1e-11)
        assert abs(step.energy_error) < 1e-11 * step.energy_kinetic and step.joints < 1e-11
        one, other = step.bodies["a"], step.bodies["b"]
        assert (other.spin - one.spin) @ (one.rotation @ AXIS) == pytest.approx(
            min(1.0 + 0.3 * step.time, 4.0), rel=1e-11
        )


def test_a_motor_at_rest_is_a_weld() -> None:
    """It does no work, and the energy is kept as by a joint."""
    bodies = {
        "one": Rigid(mass=1.0, centre=(0.5, 0.0), inertia=0.1),
        "two": Rigid(mass=1.0, centre=(1.5, 0.0), inertia=0.1),
    }
    joints = {
        "first": Hinge(between=("ground", "one"), at=(0.0, 0.0)),
        "second": Hinge(between=("one", "two"), at=(1.0, 0.0)),
    }
    held = Mechanism(
        bodies=bodies, joints=joints, motors={"m": Motor(joint="second", motion=Steady(rate=0.0))}, gravity=(0.0, -9.81)
    )
    weld = Weld(between=("one", "two"), at=(1.0, 0.0))
    welded = Mechanism(bodies=bodies, joints=joints | {"second": weld}, gravity=(0.0, -9.81))
    for one, other in zip(*(march(m, until=10.0, step=0.005, every=20) for m in (held, welded)), strict=True):
        np.testing.assert_allclose(one.bodies["two"].centre, other.bodies["two"].centre, atol=1e-4)
        assert abs(one.work) < 1e-14 and abs(one.energy_error) < 1e-12


def test_motors_go_on_through_touches_of_stops() -> None:
    """A ball that bounces beside a driven wheel: its touches end parts of slabs."""
    mechanism = wheel(Sine(amplitude=2.0, frequency=1.0), gravity=(0.0, -9.81))
    falling = Rigid(mass=1.0, centre=(3.0, 1.0))
    floor = PlaneStop(
        between=("ground", "ball"), point=(3.0, 1.0), plane=(0.0, 0.0), normal=(0.0, 1.0), restitution=0.8
    )
    both = replace(mechanism, bodies={**mechanism.bodies, "ball": falling}, stops={"floor": floor})
    steps = list(march(both, until=3.0, step=0.01))
    assert sum(len(s.events) for s in steps) >= 3
    assert max(same_angle(turned(s), 2.0 * np.sin(2.0 * np.pi * s.time)) for s in steps) < 1e-12
    assert max(abs(s.energy_error) for s in steps) < 1e-11


TWO = wheel(Steady(rate=1.0))


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Steady(rate=np.inf), "rate: inf is not finite"),
        (lambda: Sine(amplitude=1.0, frequency=np.nan), "frequency"),
        (lambda: Polyline(times=(0.0,), values=(1.0,)), "values: 1 values at 1 times"),
        (lambda: Polyline(times=(0.0, 1.0), values=(1.0,)), "values: 1 values at 2 times"),
        (lambda: RatePolyline(times=(0.0, 0.0), rates=(1.0, 2.0)), "times: .* do not increase"),
        (lambda: RatePolyline(times=(1.0, 2.0), rates=(1.0, 2.0)), "times: .* zero or before"),
        (
            lambda: replace(TWO, motors={"m": Motor(joint="pin", motion=Steady(rate=1.0))}),
            r"motors.m.joint: 'pin' is no joint with one motion.*\['axle'\]",
        ),
        (lambda: replace(TWO, motors={"axle": TWO.motors["motor"]}), "motors: .* names of joints, too"),
        (
            lambda: next(march(replace(TWO, motors=TWO.motors | {"n": TWO.motors["motor"]}), until=1.0, step=0.1)),
            "prescribes a motion that joints or other motors determine",
        ),
    ],
)
def test_wrong_motors_are_refused(make, told: str) -> None:
    with pytest.raises(sw.InputError, match=f"(?s){told}"):
        make()


def test_motors_of_welded_bodies_and_of_cylindrical_joints_are_refused() -> None:
    bodies = {name: Rigid(mass=1.0, centre=(float(k), 0.0), inertia=1.0) for k, name in enumerate(("a", "b"))}
    joints = {"weld": Weld(between=("a", "b"), at=(0.5, 0.0)), "hinge": Hinge(between=("a", "b"), at=(0.5, 0.0))}
    motors = {"m": Motor(joint="hinge", motion=Steady(rate=1.0))}
    with pytest.raises(sw.InputError, match="motors.m.joint: 'hinge' joins parts of one body"):
        next(march(Mechanism(bodies=bodies, joints=joints, motors=motors), until=1.0, step=0.1))
    body = {"a": Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))}
    guide = {"hinge": Cylindrical(between=("ground", "a"), at=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))}
    with pytest.raises(sw.InputError, match="no joint with one motion"):
        Mechanism(bodies=body, joints=guide, motors=motors)
