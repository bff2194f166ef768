"""Friction against rolling and drilling: exact decelerations, finite times, rest on slopes, momentum and spin kept."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.mechanisms import AngleStop, DistanceStop, Hinge, Mechanism, MechanismStep, PlaneStop, Rigid, Spring, march

G, R, M = 9.81, 0.1, 2.0


def marched(mechanism: Mechanism, until: float, h: float) -> list[MechanismStep]:
    """Steps of a march whose energy is balanced, and dissipated at all times."""
    steps = list(march(mechanism, until=until, step=h))
    scale = max(s.energy_kinetic + abs(s.energy_potential) + s.dissipation for s in steps)
    assert max(abs(s.energy_error) for s in steps) <= 1e-12 * scale
    assert min(np.diff([s.dissipation for s in steps])) >= -1e-12 * scale
    return steps


def rolling(dim: int, beta: float, speed: float, slope: float = 0.0, **words: object) -> Mechanism:
    """Disc or ball of inertia beta m r^2 that rolls down a slope with this speed."""
    normal, down = (np.array([np.sin(slope), np.cos(slope), 0.0])[:dim], np.array([np.cos(slope), -np.sin(slope), 0.0]))
    inertia = beta * M * R * R
    body = Rigid(
        mass=M,
        centre=tuple((R * normal).tolist()),
        inertia=inertia if dim == 2 else (inertia,) * 3,
        velocity=tuple((speed * down[:dim]).tolist()),
        spin=-speed / R if dim == 2 else (0.0, 0.0, -speed / R),
    )
    stop = PlaneStop(between=("ground", "b"), point=body.centre, plane=(0.0,) * dim, normal=tuple(normal.tolist()),
                     radius=R, **({"friction": 0.5} | words))  # fmt: skip
    return Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=(0.0, -G, 0.0)[:dim])


@pytest.mark.few(4)
@pytest.mark.parametrize("h", [0.01, 0.0037, 0.001])
@pytest.mark.parametrize(("dim", "beta"), [(2, 0.5), (2, 1.0), (3, 0.4)])
def test_a_ball_that_rolls_comes_to_rest(dim: int, beta: float, h: float) -> None:
    """I w' = F r - d N and m v' = -F: v' = -g (d/r)/(1 + beta); it comes to rest short by at most v' h^2/8."""
    delta, speed = 0.004, 0.2
    slowing = G * delta / R / (1.0 + beta)
    steps = marched(rolling(dim, beta, speed, rolling=delta), 1.3, h)
    h = steps[1].time
    states = [(s.time, s.bodies["b"]) for s in steps]
    for time, body in states:
        if time < speed / slowing - h:
            assert body.velocity[0] == pytest.approx(speed - slowing * time, rel=1e-9)
            assert abs(body.velocity[0] + R * body.spin[-1]) < 1e-13, "it rolls"
    rest = [body for time, body in states if time > speed / slowing + h]
    assert max(np.abs(body.velocity).max() + np.abs(body.spin).max() for body in rest) < 1e-13
    assert np.ptp([body.centre for body in rest], axis=0).max() < 1e-14
    short = 0.5 * speed**2 / slowing - rest[-1].centre[0]
    assert -1e-13 <= short <= slowing * h**2 / 8.0 + 1e-13
    assert steps[-1].dissipation == pytest.approx(0.5 * M * speed**2 * (1.0 + beta), rel=1e-12)


@pytest.mark.parametrize(("dim", "beta"), [(2, 0.5), (3, 0.4)])
@pytest.mark.parametrize("part", [0.5, 0.99, 1.01, 4.0])
def test_a_ball_on_a_slope_rolls_if_the_slope_is_more_than_its_friction(dim: int, beta: float, part: float) -> None:
    """It stays if tan(slope) <= d/r; else it rolls with g (sin - (d/r) cos)/(1 + beta)."""
    delta = 0.005
    slope = np.arctan(part * delta / R)
    steps = marched(rolling(dim, beta, 0.0, slope, rolling=delta), 1.0, 0.01)
    moved = float(np.linalg.norm(steps[-1].bodies["b"].centre - steps[0].bodies["b"].centre))
    along = G * (np.sin(slope) - delta / R * np.cos(slope)) / (1.0 + beta)
    assert moved == pytest.approx(max(0.0, 0.5 * along), rel=1e-8, abs=1e-15)


def test_a_ball_that_spins_about_the_normal_comes_to_rest() -> None:
    """It stops after w I/(d m g), and has turned by half of w times that."""
    drilling, spin, inertia = 0.002, 5.0, 0.4 * M * R * R
    body = Rigid(mass=M, centre=(0.0, R, 0.0), inertia=(inertia,) * 3, spin=(0.0, spin, 0.0))
    stop = PlaneStop(between=("ground", "b"), point=body.centre, plane=(0.0,) * 3, normal=(0.0, 1.0, 0.0), radius=R,
                     friction=0.3, drilling=drilling)  # fmt: skip
    steps = marched(Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=(0.0, -G, 0.0)), 1.2, 0.005)
    time = spin * inertia / (drilling * M * G)
    for s in steps:
        assert s.bodies["b"].spin[1] == pytest.approx(max(0.0, spin * (1.0 - s.time / time)), abs=spin * 0.005)
        assert s.time < time + 0.005 or np.abs(s.bodies["b"].spin).max() < 1e-13
    turn = steps[-1].bodies["b"].rotation
    assert np.arctan2(turn[0, 2], turn[0, 0]) == pytest.approx(0.5 * spin * time, abs=1e-4)


def test_a_bowling_ball_slides_until_it_rolls_and_then_slows_down() -> None:
    """While it slides v' = -mu g and r w' = (mu - d/r) g/beta; from then on as one that rolls."""
    beta, friction, delta, speed = 0.4, 0.3, 0.002, 5.0
    body = Rigid(mass=M, centre=(0.0, R, 0.0), inertia=(beta * M * R * R,) * 3, velocity=(speed, 0.0, 0.0))
    for mu_s in (None, 0.4):
        stop = PlaneStop(between=("ground", "b"), point=body.centre, plane=(0.0,) * 3, normal=(0.0, 1.0, 0.0),
                         radius=R, friction=friction, mu_s=mu_s, rolling=delta)  # fmt: skip
        steps = marched(Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=(0.0, -G, 0.0)), 1.0, 0.002)
        rolls = speed / G / (friction + (friction - delta / R) / beta)
        last = speed - friction * G * rolls - G * delta / R / (1.0 + beta) * (1.0 - rolls)
        assert steps[-1].bodies["b"].velocity[0] == pytest.approx(last, rel=1e-9 if mu_s else 2e-6)
        sticks = [event.time for s in steps for event in s.events if event.kind == "stick"]
        assert sticks == ([pytest.approx(rolls, rel=1e-12)] if mu_s else [])


@pytest.mark.parametrize("dim", [2, 3])
def test_two_balls_that_press_on_each_other_stop_each_other_from_turning(dim: int) -> None:
    """A spring presses them together; the moments are opposite: momentum and spin stay, turning ends."""
    places = ((0.0, 0.0, 0.0)[:dim], (0.25, 0.0, 0.0)[:dim])
    spins: tuple = (2.0, -1.0) if dim == 2 else ((1.0, 2.0, 0.5), (-2.0, 0.5, -1.0))
    inertia: tuple = (0.004, 0.02) if dim == 2 else ((0.004,) * 3, (0.02,) * 3)
    bodies = {f"b{k}": Rigid(mass=1.0 + k, centre=places[k], inertia=inertia[k], spin=spins[k]) for k in range(2)}
    words = {"rolling": 0.01} | ({"drilling": 0.01} if dim == 3 else {})
    touch = DistanceStop(between=("b0", "b1"), points=places, distance=0.25, contact=0.4, friction=0.4, **words)
    press = Spring(between=("b0", "b1"), ends=places, stiffness=100.0, rest=0.0)
    mechanism = Mechanism(bodies=bodies, stops={"touch": touch}, springs=(press,))
    steps = marched(mechanism, 1.0, 0.001)
    np.testing.assert_allclose([s.momentum for s in steps], [steps[0].momentum] * len(steps), atol=1e-13)
    np.testing.assert_allclose([s.spin for s in steps], [steps[0].spin] * len(steps), atol=1e-12)
    one, other = (steps[-1].bodies[name] for name in bodies)
    assert steps[-1].dissipation > 1e-3
    np.testing.assert_allclose(one.spin, other.spin, atol=1e-9)


def test_stops_without_such_friction_beside_others_have_none() -> None:
    """A point mass, an angle and a ball in one mechanism: only the ball has rows of turning."""
    ball = rolling(3, 0.4, 0.2, rolling=0.004)
    arm = Rigid(mass=1.0, centre=(0.0, 1.0, 0.5), inertia=(0.1,) * 3, spin=(0.0, 0.0, 1.0))
    point = Rigid(mass=1.0, centre=(0.0, 0.0, 1.0), velocity=(1.0, 0.0, 0.0))
    floor = PlaneStop(
        between=("ground", "point"), point=point.centre, plane=(0.0,) * 3, normal=(0.0, 1.0, 0.0), friction=0.1
    )
    mechanism = Mechanism(
        bodies={**ball.bodies, "arm": arm, "point": point},
        joints={"hinge": Hinge(between=("ground", "arm"), at=arm.centre, axis=(0.0, 0.0, 1.0))},
        stops={**ball.stops, "floor": floor, "limit": AngleStop(joint="hinge", limit=0.5, restitution=0.5)},
        gravity=ball.gravity,
    )
    last, alone = marched(mechanism, 1.0, 0.01)[-1], marched(ball, 1.0, 0.01)[-1]
    np.testing.assert_allclose(last.bodies["b"].centre, alone.bodies["b"].centre, atol=1e-12)
    assert last.bodies["point"].centre[0] == pytest.approx(1.0 - 0.05 * G, rel=1e-12)
    assert last.bodies["arm"].spin[2] == pytest.approx(-0.5, rel=1e-12)


def test_an_impact_without_such_friction_is_that_of_a_mechanism_without() -> None:
    """A rod hits the floor by Poisson's law and slides back, alone and beside a disc that rolls."""
    tip = (2.0, 0.0)
    rod = Rigid(mass=1.0, centre=(2.4, 0.35), inertia=0.1, velocity=(0.5, -1.0))
    floor = PlaneStop(between=("ground", "rod"), point=tip, plane=tip, normal=(0.0, 1.0), friction=0.3, restitution=0.5)
    disc = rolling(2, 0.5, 0.2, rolling=0.004)
    words = {"restitution": "Poisson", "impacts": "sequential"}
    alone = Mechanism(bodies={"rod": rod}, stops={"floor": floor}, **words)
    both = Mechanism(bodies={**disc.bodies, "rod": rod}, stops={**disc.stops, "floor": floor}, **words)
    one, other = (next(iter(march(it, until=0.01, step=0.01))).bodies["rod"] for it in (alone, both))
    np.testing.assert_allclose([*one.velocity, *one.spin], [*other.velocity, *other.spin], rtol=1e-14)
    assert one.spin[0] < -1.0


@pytest.mark.parametrize("key", ["rolling", "drilling"])
def test_wrong_lengths_are_refused(key: str) -> None:
    for value, dim in ((-1.0, 3), (np.inf, 3), *([(0.1, 2)] if key == "drilling" else [])):
        with pytest.raises(InputError) as refused:
            rolling(dim, 0.4, 0.0, **{key: value})
        assert refused.value.where == key


def test_a_body_without_inertia_has_no_friction_against_rolling() -> None:
    stop = PlaneStop(between=("ground", "b"), point=(0.0, 0.0), plane=(0.0, 0.0), normal=(0.0, 1.0), rolling=0.01)
    mechanism = Mechanism(bodies={"b": Rigid(mass=1.0, centre=(0.0, 0.0))}, stops={"s": stop})
    with pytest.raises(InputError, match="without inertia"):
        next(march(mechanism, until=1.0, step=0.1))
