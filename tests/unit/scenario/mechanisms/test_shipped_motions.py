"""Shipped scenarios of rigid bodies: their motions are those of exact solutions and of published numbers."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import softway as sw
from softway.arrays import Array
from softway.record.storage.table import Table
from softway.record.write.mechanism.columns import placed

FOLDER = Path(__file__).parents[4] / "scenarios"
G = 9.81


@cache
def motion_of(name: str, *changes: str) -> sw.Run:
    return sw.run(sw.load(FOLDER / f"{name}.toml", changes))


def turned(run: sw.Run, body: str) -> float:
    """Angle of a body at the end, up to full turns."""
    return float(run.motion[f"{body}.angle"][-1])


def test_squeezer_ends_at_the_published_angles():
    """Test set for IVP solvers (1996): angles beta, beta + Theta, gamma of k1, k2, k3 at 30 ms."""
    run = motion_of("squeezer")
    start = (-0.0617138900142765, -0.0617138900142765, 0.45527981916307)
    end = (15.810771195154118, 15.810771195154118 - 15.756371058412343, 0.04082224011961387)
    for name, before, after, within in zip(("k1", "k2", "k3"), start, end, (2e-4, 2e-4, 1e-5), strict=True):
        error = turned(run, name) - (after - before)
        assert abs((error + np.pi) % (2.0 * np.pi) - np.pi) < within


def loose_pin(t: float) -> tuple[Array, Array]:
    """Place of the pin against the bearing and its rate before the first touch: crank and rod turn uniformly."""
    tip = np.array([0.05 * np.cos(60 * t) + 0.12 * np.cos(25 * t), 0.05 * np.sin(60 * t) - 0.12 * np.sin(25 * t)])
    rate = np.array([-3.0 * np.sin(60 * t) - 3.0 * np.sin(25 * t), 3.0 * np.cos(60 * t) - 3.0 * np.cos(25 * t)])
    return tip - [0.17, 0.0], rate


def test_loose_pin_first_touches_as_computed_by_hand():
    touch = motion_of("bearing_clearance").events
    at = brentq(lambda t: float(np.linalg.norm(loose_pin(t)[0])) - 1e-3, 1e-4, 5e-3, xtol=1e-15)
    place, rate = loose_pin(at)
    n, rod = place / 1e-3, np.array([np.sin(25 * at), np.cos(25 * at)])
    approach = float(n @ rate)
    arm = 0.12 * float(n @ rod)
    impulse = 1.5 * approach / (n[0] ** 2 / 0.15 + arm**2 / 4e-4)  # the slider slides, the rod turns about its end
    assert touch["time"][0] == pytest.approx(at, rel=1e-6)
    assert touch["normal_velocity_before"][0] == pytest.approx(-approach, rel=1e-5)
    assert touch["normal_velocity_after"][0] == pytest.approx(0.5 * approach, rel=1e-5)
    assert touch["impulse"][0] == pytest.approx(impulse, rel=1e-5)


def test_loose_pin_stays_in_its_bearing():
    motion = motion_of("bearing_clearance").motion
    angle = 60.0 * motion["time"]
    crank = 0.05 * np.array([np.cos(angle), np.sin(angle)])
    play = np.hypot(motion["slider.x"] - crank[0], crank[1]) - 0.12
    assert 9.9e-4 < np.abs(play).max() < 1e-3 + 1e-14


def test_thrown_ball_bounces_as_newton_and_coulomb_say():
    run = motion_of("thrown_ball")
    motion, events = run.motion, run.events
    radius, e, mu = 0.02, 0.8, 0.3
    forward, spin, down, time = 1.0, 250.0, np.sqrt(2.0 * G * 0.5), np.sqrt(1.0 / G)
    sticks = []
    for k in range(events.rows):
        slip = forward + radius * spin
        push = np.clip(2.0 / 7.0 * slip, -mu * (1.0 + e) * down, mu * (1.0 + e) * down)
        sticks.append(abs(push) < mu * (1.0 + e) * down)
        forward, spin = forward - push, spin - 2.5 * push / radius
        assert events["time"][k] == pytest.approx(time, rel=1e-12)
        assert events["impulse"][k] == pytest.approx(0.046 * (1.0 + e) * down, rel=1e-12)
        row = int(np.searchsorted(motion["time"], time))
        found = motion["ball.velocity_x"][row], motion["ball.spin"][row]
        assert found == (pytest.approx(forward, rel=1e-11), pytest.approx(spin, rel=1e-11, abs=1e-9))
        down *= e
        time += 2.0 * down / G
    assert sticks[0] is not sticks[1] and forward < 0.0


def test_follower_is_lifted_by_e_one_minus_cosine():
    history = motion_of("flat_follower").history
    assert history["lift"] == pytest.approx(0.01 * (1.0 - np.cos(25.0 * history["time"])), abs=1e-13)
    assert not motion_of("flat_follower").events.rows


def test_follower_leaves_a_fast_cam_and_lands():
    """At 40 rad/s > sqrt(g/e) it leaves where the acceleration of the cam is -g, and lands where its parabola ends."""
    fast = ("bodies.cam.spin=40 rad/s", "bodies.cam.velocity=['0.4 m/s', 0]", "motors.drive.motion.rate=40")
    events = motion_of("flat_follower", *fast, "time.end=0.2 s").events
    away = np.arccos(-G / (0.01 * 1600.0)) / 40.0
    height, rate = 0.01 * (1.0 - np.cos(40.0 * away)), 0.4 * np.sin(40.0 * away)

    def above(t: float) -> float:
        flown = height + rate * (t - away) - 0.5 * G * (t - away) ** 2
        return float(flown - 0.01 * (1.0 - np.cos(40.0 * t)))

    lands = brentq(above, away + 0.02, 0.2)
    assert list(events["kind"][:2]) == ["release", "touch"]
    assert abs(events["time"][0] - away) < 5e-4 and abs(events["time"][1] - lands) < 2e-5


M, ARM, HOOK, SPRING, INERTIA = 4.5e-3, 0.015, 0.01, 0.0056, (0.3e-3, 5e-9, 7e-7)


def toy(q: Array) -> Array:
    """Rates of the woodpecker without contacts by Lagrange's equations: height, angles of sleeve and bird; rates."""
    _, a, b, *rates = q
    along = [np.array([np.cos(x), np.sin(x)]) for x in (a, b)]
    across = [np.array([-np.sin(x), np.cos(x)]) for x in (a, b)]
    jacobian = np.array([[0.0, 1.0], HOOK * across[0], ARM * across[1]]).T
    bias = -HOOK * rates[1] ** 2 * along[0] - ARM * rates[2] ** 2 * along[1] + [0.0, G]
    moment = SPRING * (a - b)
    mass = M * jacobian.T @ jacobian + np.diag(INERTIA)
    force = -M * jacobian.T @ bias - [INERTIA[0] * G, moment, -moment]
    return np.array([*rates, *np.linalg.solve(mass, force)])


def pose(motion: Table, row: int, start: tuple[float, float]) -> Array:
    """Height, angles and their rates of the woodpecker in a row."""
    keys = ("sleeve.y", "sleeve.angle", "bird.angle", "sleeve.velocity_y", "sleeve.spin", "bird.spin")
    return np.array([motion[key][row] for key in keys]) + [0.0, *start, 0.0, 0.0, 0.0]


@pytest.mark.slow
def test_woodpecker_flies_and_swings_as_lagrange_says():
    run = motion_of("woodpecker", "time.step=0.25 ms", "output.fields_every=0.25 ms")
    motion, events = run.motion, run.events
    lean = -brentq(lambda t: 3.1 * np.cos(t) - 5.8 * np.sin(t) - 2.5, 0.0, 0.2, xtol=1e-15)
    start = (lean, -0.2788)
    free = events["time"][events["kind"] == "release"]
    beak = events["time"][events["contact"] == "beak"]
    row = int(np.searchsorted(motion["time"], free[0] + 1e-3))

    def gap(t: float, q: Array) -> float:
        return float(0.01 * np.cos(q[1]) + (ARM - 0.0201) * np.cos(q[2]) - 0.02 * np.sin(q[2]) - 0.0025)

    gap.terminal = True  # type: ignore[attr-defined]
    state, span = pose(motion, row, start), (motion["time"][row], beak[0] + 0.1)
    flown = solve_ivp(lambda t, q: toy(q), span, state, rtol=1e-11, atol=1e-13, events=gap)
    assert flown.t_events[0][0] == pytest.approx(beak[0], abs=1e-6)

    still = np.abs(motion["sleeve.velocity_y"]) < 1e-12
    ends = np.flatnonzero(np.diff(still.astype(int)))
    first, last = max(
        ((one + 1, two + 1) for one, two in zip(ends, ends[1:], strict=False) if still[one + 1]),
        key=lambda pair: pair[1] - pair[0],
    )
    held = motion["sleeve.y"][first:last]
    assert last - first > 100 and np.ptp(held) < 1e-13  # it sticks and does not creep

    def swing(t: float, q: Array) -> tuple[float, float]:
        moment = -SPRING * (q[0] - lean) - M * G * ARM * np.cos(q[0])
        return q[1], moment / (INERTIA[2] + M * ARM**2)

    times = motion["time"][first:last]
    swung = solve_ivp(swing, times[[0, -1]], pose(motion, first, start)[[2, 5]], t_eval=times, rtol=1e-11, atol=1e-13)
    assert motion["bird.angle"][first:last] - 0.2788 == pytest.approx(swung.y[0], abs=1.5e-5)


def test_woodpecker_dissipates_what_its_weight_gives():
    """In settled cycles the energy at the pecks is the same."""
    run = motion_of("woodpecker")
    history, pecks = run.history, run.events["time"][run.events["contact"] == "beak"]
    lost, height = (np.interp(pecks, history["time"], history[key]) for key in ("dissipation", "height"))
    fallen = -(4.8e-3 * G) * (height[-1] - height[2])
    assert len(pecks) == 8 and lost[-1] - lost[2] == pytest.approx(fallen, rel=0.01)


def test_woodpecker_at_rest_holds_from_a_friction_on_that_statics_gives():
    """Moments about the middle of the sleeve give the normal force at the edge that carries the weight."""
    toy = sw.load(FOLDER / "woodpecker.toml")
    (x, y), bird, whole = toy.stops["lower"].point, toy.bodies["bird"], 4.8e-3
    limit = whole * -y / (bird.mass * bird.centre[0] - whole * x)
    moment = M * G * (bird.centre[0] - toy.joints["hinge"].at[0])
    still = ("bodies.sleeve.velocity=[0, 0]", "bodies.bird.velocity=[0, 0]", "bodies.bird.spin=0", "time.end=0.1 s")
    rest = (*still, f"springs[0].rest={moment / SPRING}")
    fallen = [
        abs(motion_of("woodpecker", *rest, f"stops.lower.friction={part * limit}").motion["sleeve.y"][-1])
        for part in (0.999, 1.001)
    ]
    assert fallen[0] > 1e-4 and fallen[1] < 1e-12


def jellett(run: sw.Run) -> Array:
    """Angular momentum of the tippe top times the arm from its centre of mass to the floor."""
    motion, axis = run.motion, np.array([np.sin(0.1), 0.0, np.cos(0.1)])
    found = []
    for row in range(motion.rows):
        rotation = placed(motion, "top", row)[1]
        arm = 0.005 * rotation @ axis - [0.0, 0.0, 0.025]
        found.append(-1.5e-5 * arm @ [motion[f"top.spin_{a}"][row] for a in "xyz"])
    return np.array(found)


@pytest.mark.minutes
def test_tippe_top_turns_over_and_keeps_its_constant():
    coarse, fine = motion_of("tippe_top"), motion_of("tippe_top", "time.step=0.1 ms")
    change = [np.ptp(jellett(run)) / jellett(run)[0] for run in (coarse, fine)]
    assert change[0] < 1.2e-4 and 3.8 < change[0] / change[1] < 4.2
    assert 0.0299 < fine.motion["top.z"][-1] < 0.03 and fine.history["crown"][-1] < 1e-3
    assert fine.motion["top.spin_z"][-1] == pytest.approx(200.0 * (25.0 - 5.0 * np.cos(0.1)) / 30.0, rel=2e-3)
