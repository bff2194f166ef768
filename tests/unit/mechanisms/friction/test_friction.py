"""Coulomb's friction of rigid bodies: sticking without creep, slipping, rolling, impacts; never a gain of energy."""

import numpy as np
import pytest

from softway.mechanisms import (
    DistanceStop,
    Hinge,
    Mechanism,
    MechanismStep,
    Motor,
    PlaneStop,
    Rigid,
    Slider,
    Spring,
    Steady,
    march,
)

G = 9.81


def on_plane(point: tuple[float, ...], body: str = "b", slope: float = 0.0, **changes: float) -> PlaneStop:
    """Contact of a point of a body, or a ball around it, with a plane through the origin that falls to the right."""
    normal = (np.sin(slope), np.cos(slope), 0.0)[: len(point)]
    return PlaneStop(between=("ground", body), point=point, plane=(0.0,) * len(point), normal=normal, **changes)


def box(speed: float, friction: float, restitution: float = 0.0) -> Mechanism:
    """A box of half width .1 and half height .05 on its two lower corners."""
    corners = {side: (0.1 * sign, 0.0) for side, sign in (("left", -1.0), ("right", 1.0))}
    stops = {k: on_plane(at, friction=friction, restitution=restitution) for k, at in corners.items()}
    body = Rigid(mass=2.0, centre=(0.0, 0.05), inertia=2.0 * (0.2**2 + 0.1**2) / 12.0, velocity=(speed, 0.0))
    return Mechanism(bodies={"b": body}, stops=stops, gravity=(0.0, -G))


def never_gains(steps: list[MechanismStep]) -> bool:
    """True if the balance is closed and no time step gives dissipated energy back."""
    scale = max(s.energy_kinetic + abs(s.energy_potential) + s.dissipation for s in steps)
    closed = max(abs(s.energy_error) for s in steps) <= 1e-12 * scale
    return closed and all(
        b.dissipation >= a.dissipation - 1e-12 * scale for a, b in zip(steps, steps[1:], strict=False)
    )


@pytest.mark.parametrize("h", [0.01, 0.0037, 0.001])
@pytest.mark.parametrize("speed", [0.3, 0.71, -1.3])
def test_a_box_slides_to_rest_and_then_does_not_move(h: float, speed: float) -> None:
    """Inside the slab in which it stops it comes short of v^2/(2 mu g), by at most mu g h^2/8."""
    steps = list(march(box(speed, 0.3), until=1.0, step=h))
    short = speed**2 / (2.0 * 0.3 * G) - abs(steps[-1].bodies["b"].centre[0])
    h = 1.0 / (len(steps) - 1)
    assert -1e-13 <= short <= 0.3 * G * h**2 / 8.0 + 1e-13
    rest = [s.bodies["b"] for s in steps if s.time > abs(speed) / (0.3 * G) + h]
    assert max(np.abs(s.velocity).max() for s in rest) < 1e-13
    assert np.ptp([s.centre for s in rest], axis=0).max() < 1e-13
    assert never_gains(steps)
    assert steps[-1].dissipation == pytest.approx(0.5 * 2.0 * speed**2, rel=1e-12)


@pytest.mark.parametrize("speed", [1e-7, 1e-8, 1e-9, 1e-10])
@pytest.mark.parametrize("law", ["Newton", "Poisson"])
def test_blows_one_after_the_other_end_beside_a_great_velocity(speed: float, law: str) -> None:
    """Two feet of a box that slides fast approach the floor slowly: what the blows leave is rounding of the sliding."""
    stops = {k: on_plane(at, friction=0.5) for k, at in {"left": (-0.11, 0.0), "right": (0.1, 0.0)}.items()}
    body = Rigid(mass=2.0, centre=(0.0, 0.05), inertia=0.01, velocity=(5.0, -speed), spin=3.0 * speed)
    mechanism = Mechanism(bodies={"b": body}, stops=stops, gravity=(0.0, -G), impacts="sequential", restitution=law)
    steps = list(march(mechanism, until=0.1, step=0.01))
    assert never_gains(steps)
    assert steps[-1].bodies["b"].velocity[0] == pytest.approx(5.0 - 0.05 * G, rel=1e-6)


def test_a_wedge_on_a_slope_sticks_without_creep_below_the_angle_of_friction() -> None:
    for friction, expected in ((0.7, 0.0), (0.4, G * (np.sin(0.5) - 0.4 * np.cos(0.5)))):
        slope = 0.5
        down = np.array([np.cos(slope), -np.sin(slope)])
        corners = {k: tuple((s * 0.1 * down).tolist()) for k, s in (("upper", -1.0), ("lower", 1.0))}
        stops = {k: on_plane(at, slope=slope, friction=friction) for k, at in corners.items()}
        centre = tuple((0.02 * np.array([np.sin(slope), np.cos(slope)])).tolist())
        body = Rigid(mass=1.0, centre=centre, inertia=0.01)
        steps = list(march(Mechanism(bodies={"b": body}, stops=stops, gravity=(0.0, -G)), until=1.0, step=0.01))
        moved = (steps[-1].bodies["b"].centre - centre) @ down
        assert moved == pytest.approx(0.5 * expected, abs=1e-12)
        assert never_gains(steps)


@pytest.mark.parametrize(("beta", "friction"), [(0.4, 0.5), (0.4, 0.1), (0.5, 0.5), (1.0, 0.15)])
def test_a_ball_on_a_slope_rolls_or_slips(beta: float, friction: float) -> None:
    """In space: it rolls if tan(slope) <= mu (1 + 1/beta); beta is the moment of inertia over m r^2."""
    slope, r, m = 0.4, 0.1, 2.0
    normal, down = np.array([np.sin(slope), np.cos(slope), 0.0]), np.array([np.cos(slope), -np.sin(slope), 0.0])
    body = Rigid(mass=m, centre=tuple((r * normal).tolist()), inertia=(beta * m * r * r,) * 3)
    stop = on_plane(body.centre, slope=slope, radius=r, friction=friction)
    mechanism = Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=(0.0, -G, 0.0))
    steps = list(march(mechanism, until=1.0, step=0.01))
    rolls = np.tan(slope) <= friction * (1.0 + 1.0 / beta)
    along = G * np.sin(slope) / (1.0 + beta) if rolls else G * (np.sin(slope) - friction * np.cos(slope))
    last = steps[-1].bodies["b"]
    np.testing.assert_allclose(last.velocity, along * down, rtol=1e-10, atol=1e-12)
    spin = along / r if rolls else friction * G * np.cos(slope) / (beta * r)
    np.testing.assert_allclose(last.spin, [0.0, 0.0, -spin], rtol=1e-10, atol=1e-11)
    slip = [s.bodies["b"].velocity @ down + r * s.bodies["b"].spin[2] for s in steps]
    assert not rolls or np.abs(slip).max() < 1e-13
    assert never_gains(steps)


def test_a_bowling_ball_slides_until_it_rolls() -> None:
    r, friction, speed = 0.1, 0.3, 5.0
    body = Rigid(mass=6.0, centre=(0.0, r, 0.0), inertia=(0.4 * 6.0 * r * r,) * 3, velocity=(speed, 0.0, 0.0))
    stop = on_plane(body.centre, radius=r, friction=friction)
    mechanism = Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=(0.0, -G, 0.0))
    steps = list(march(mechanism, until=0.6, step=0.001))
    assert steps[-1].bodies["b"].velocity[0] == pytest.approx(speed * 5.0 / 7.0, rel=1e-12)
    slip = np.array([s.bodies["b"].velocity[0] + r * s.bodies["b"].spin[2] for s in steps])
    rolling = steps[int(np.argmax(np.abs(slip) < 1e-9))].time
    assert rolling == pytest.approx(2.0 * speed / (7.0 * friction * G), abs=1e-3)
    assert never_gains(steps)


@pytest.mark.parametrize(("friction", "sticks"), [(0.05, False), (0.6, True)])
def test_a_spinning_ball_thrown_at_a_floor(friction: float, sticks: bool) -> None:
    """The impact changes the sliding by mu (1 + e) v_n, or ends it: the place of contact has 2/7 of the mass."""
    r, m, e = 0.1, 1.5, 0.7
    body = Rigid(mass=m, centre=(0.0, r + 0.3, 0.0), inertia=(0.4 * m * r * r,) * 3,
                 velocity=(1.0, -2.0, 0.4), spin=(3.0, 2.0, 5.0))  # fmt: skip
    stop = on_plane(body.centre, radius=r, friction=friction, restitution=e)
    steps = list(march(Mechanism(bodies={"b": body}, stops={"s": stop}), until=0.3, step=0.01))
    slip = np.array([1.0 + r * 5.0, 0.4 - r * 3.0])
    pushed = -2.0 / 7.0 * slip if sticks else -friction * (1.0 + e) * 2.0 * slip / np.linalg.norm(slip)
    last = steps[-1].bodies["b"]
    np.testing.assert_allclose(last.velocity, [1.0 + pushed[0], e * 2.0, 0.4 + pushed[1]], rtol=1e-12)
    np.testing.assert_allclose(
        last.spin, [3.0 - pushed[1] * 2.5 / r, 2.0, 5.0 + pushed[0] * 2.5 / r], rtol=1e-11, atol=1e-12
    )
    assert never_gains(steps)


@pytest.mark.parametrize("dim", [2, 3])
def test_two_balls_that_rub_keep_momentum_and_spin(dim: int) -> None:
    """An oblique impact of spinning balls of different size, in the plane and in space."""
    places = ((0.0, 0.0, 0.0)[:dim], (0.5, 0.2, 0.1)[:dim])
    velocities = ((1.0, 0.0, 0.2)[:dim], (-1.5, -0.3, 0.1)[:dim])
    spins: tuple = (2.0, -7.0) if dim == 2 else ((1.0, 2.0, 3.0), (-2.0, 0.5, -7.0))
    inertia: tuple = (0.004, 0.02) if dim == 2 else ((0.004,) * 3, (0.02,) * 3)
    bodies = {
        f"b{k}": Rigid(mass=1.0 + k, centre=places[k], inertia=inertia[k], velocity=velocities[k], spin=spins[k])
        for k in range(2)
    }
    touch = DistanceStop(
        between=("b0", "b1"), points=places, distance=0.25, contact=0.1 / 0.25, restitution=0.5, friction=0.4
    )
    steps = list(march(Mechanism(bodies=bodies, stops={"touch": touch}), until=0.5, step=0.01))
    assert [event.kind for s in steps for event in s.events] == ["touch"]
    np.testing.assert_allclose([s.momentum for s in steps], [steps[0].momentum] * len(steps), atol=1e-13)
    np.testing.assert_allclose([s.spin for s in steps], [steps[0].spin] * len(steps), atol=1e-12)
    assert steps[-1].dissipation > 0.1 and never_gains(steps)


def test_a_box_that_is_thrown_tumbles_to_rest() -> None:
    """Impacts with friction and restitution at corners, until it lies: the energy is that of its height."""
    half, turn = np.array([0.1, 0.05]), 0.4
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    centre = np.array([0.0, 0.6])
    corners = {f"{i}{j}": tuple((centre + rotation @ (half * [i, j])).tolist()) for i in (-1, 1) for j in (-1, 1)}
    body = Rigid(
        mass=1.0, centre=tuple(centre.tolist()), inertia=(0.2**2 + 0.1**2) / 12.0, velocity=(1.0, 0.0), spin=3.0
    )
    stops = {k: on_plane(at, friction=0.4, restitution=0.4) for k, at in corners.items()}
    steps = list(march(Mechanism(bodies={"b": body}, stops=stops, gravity=(0.0, -G)), until=3.0, step=0.004))
    assert never_gains(steps)
    last = steps[-1]
    assert last.energy_kinetic < 1e-20 and len(last.closed) == 2
    assert last.bodies["b"].centre[1] == pytest.approx(0.05, abs=1e-12) or last.bodies["b"].centre[1] == pytest.approx(
        0.1, abs=1e-12
    )


@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_a_stack_that_was_pushed_comes_to_rest_and_stays(restitution: float) -> None:
    """Three boxes on two corners each: four rows a face, of which three are independent."""
    wide, high = 0.1, 0.05
    bodies, stops = {}, {}
    for k, speed in enumerate((0.25, -0.3, 0.4)):
        level = high * (2 * k + 1)
        inertia = (wide**2 + high**2) / 3.0
        bodies[f"b{k}"] = Rigid(mass=1.0, centre=(0.0, level), inertia=inertia, velocity=(speed, 0.0))
        below = "ground" if k == 0 else f"b{k - 1}"
        for side, x in (("l", -wide), ("r", wide)):
            foot = (x, level - high)
            stops[f"s{k}{side}"] = PlaneStop(
                between=(below, f"b{k}"), point=foot, plane=(0.0, level - high), normal=(0.0, 1.0), friction=0.5,
                restitution=restitution,
            )  # fmt: skip
    steps = list(march(Mechanism(bodies=bodies, stops=stops, gravity=(0.0, -G)), until=2.0, step=0.01))
    places = np.array([[body.centre for body in s.bodies.values()] for s in steps])
    assert np.abs(places[-1] - places[0]).max() > 1e-3, "they have slid"
    assert np.abs(places[100:] - places[100]).max() < 1e-14
    assert never_gains(steps)


def slider_crank(clearance: float) -> Mechanism:
    """Slider-crank whose wrist pin of 10 mm radius has a clearance in its hole."""
    bodies = {
        "crank": Rigid(mass=0.1, centre=(0.05, 0.0), inertia=1e-4, velocity=(0.0, 4.0), spin=80.0),
        "rod": Rigid(mass=0.2, centre=(0.225, 0.0), inertia=1e-3, velocity=(0.0, 4.0), spin=-32.0),
        "slider": Rigid(mass=0.3, centre=(0.35, 0.0), inertia=1e-4),
    }
    pin = DistanceStop(
        between=("slider", "rod"), points=((0.35, 0.0), (0.35, 0.0)), distance=clearance, side="most",
        contact=1.0 + 0.01 / clearance, restitution=0.5, friction=0.1,
    )  # fmt: skip
    joints = {
        "main": Hinge(between=("ground", "crank"), at=(0.0, 0.0)),
        "big end": Hinge(between=("crank", "rod"), at=(0.1, 0.0)),
        "guide": Slider(between=("ground", "slider"), at=(0.35, 0.0), axis=(1.0, 0.0)),
    }
    return Mechanism(bodies=bodies, joints=joints, stops={"wrist": pin})


def test_a_slider_crank_with_a_clearance_rattles_without_a_gain_of_energy() -> None:
    ends = []
    for h in (4e-4, 2e-4, 1e-4, 2.5e-5):
        steps = list(march(slider_crank(1e-3), until=0.02, step=h))
        assert never_gains(steps)
        assert max(s.joints for s in steps) < 1e-14
        for s in steps:
            rod, slider = s.bodies["rod"], s.bodies["slider"]
            assert np.hypot(*(rod.point((0.35, 0.0), (0.225, 0.0)) - slider.centre)) < 1e-3 + 1e-14
        assert sum(event.kind == "touch" for s in steps for event in s.events) > 5
        ends.append(float(steps[-1].bodies["slider"].centre[0]))
    errors = np.abs(np.array(ends[:3]) - ends[3])
    assert errors[2] < 3e-6 and errors[2] < 0.3 * errors[0]


def test_a_sprung_mass_on_a_belt_that_a_motor_drives() -> None:
    """It goes with the belt until the spring pulls as much as friction, and then swings once about that place."""
    k, m, friction, speed = 100.0, 1.0, 0.4, 0.1
    bodies = {
        "belt": Rigid(mass=5.0, centre=(0.0, -0.1), inertia=1.0, velocity=(speed, 0.0)),
        "mass": Rigid(mass=m, centre=(0.0, 0.0), velocity=(speed, 0.0)),
    }
    mechanism = Mechanism(
        bodies=bodies,
        joints={"rollers": Slider(between=("ground", "belt"), at=(0.0, -0.1), axis=(1.0, 0.0))},
        motors={"drive": Motor(joint="rollers", motion=Steady(rate=speed))},
        stops={
            "top": PlaneStop(
                between=("belt", "mass"), point=(0.0, 0.0), plane=(0.0, 0.0), normal=(0.0, 1.0), friction=friction
            )
        },
        springs=(Spring(between=("ground", "mass"), ends=((-1.0, 0.0), (0.0, 0.0)), stiffness=k, rest=1.0),),
        gravity=(0.0, -G),
    )
    steps = list(march(mechanism, until=1.0, step=1e-3))
    sticks = friction * m * G / k / speed
    for s in steps:
        exact = speed * min(s.time, sticks) + speed / np.sqrt(k / m) * np.sin(
            np.sqrt(k / m) * max(0.0, s.time - sticks)
        )
        if s.time < sticks + 2.0 * np.pi / np.sqrt(k / m):
            assert s.bodies["mass"].centre[0] == pytest.approx(exact, abs=2e-6)
    assert never_gains(steps)
    assert steps[-1].work > 0.1
