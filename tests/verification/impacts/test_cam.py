"""A follower on a cam: it leaves and lands where a rigid one does, the nearer the stiffer it is."""

import numpy as np
import pytest
from scipy.optimize import brentq

import softway as sw
from softway.apps.verify.exact.cam import Cam

RADIUS, ECCENTRICITY, LENGTH, AREA, DENSITY, PULL = 0.02, 0.005, 0.06, 1e-4, 1140.0, 770.0
MASS = DENSITY * AREA * LENGTH


def cam(rate: float) -> Cam:
    """The cam, started where its follower has no acceleration."""
    still = Cam(radius=RADIUS, eccentricity=ECCENTRICITY, rate=rate)
    return Cam(
        radius=RADIUS, eccentricity=ECCENTRICITY, rate=rate, angle=rate * brentq(still.acceleration, 0, 1 / rate)
    )


def follow(rate: float, stiffness: float, end: float, step: float) -> sw.Run:
    """A bar on the cam, drawn down by its weight."""
    exact = cam(rate)
    centre = (ECCENTRICITY * np.cos(exact.angle), ECCENTRICITY * np.sin(exact.angle))
    rod = sw.Solid(
        mesh=sw.meshes.Interval(length=LENGTH, cells=6, origin=(0.0, exact.lift(0.0)), direction=(0.0, 1.0), dim=2),
        material=sw.LinearElastic(E=stiffness),
        density=DENSITY,
        section=sw.bodies.Bar(area=AREA),
        velocity=sw.bodies.Uniform(value=(0.0, exact.velocity(0.0))),
        supports=(sw.Fixed(on="all", components="x"),),
    )
    disc = sw.Tool(
        shape=sw.obstacles.Sphere(centre=centre, radius=RADIUS), motion=sw.bodies.Turning(point=(0.0, 0.0), rate=rate)
    )
    scenario = sw.Scenario(
        bodies={"rod": rod, "cam": disc},
        contacts=(sw.Contact(between=("rod.left", "cam"), name="cam"),),
        loads=(sw.Gravity(acceleration=(0.0, -PULL)),),
        start=sw.model.StaticStart(),
        time=sw.Time(end=end, step=step),
        output=sw.Output(probes=(sw.Probe(name="tip", of="rod", tag="left", quantity="position", component="y"),)),
    )
    return sw.run(scenario)


def ringing(exact: Cam, stiffness: float) -> float:
    """Bound of the error of the instant at which an elastic bar leaves: see docs/theory/exact_solutions.md."""
    left, small = exact.leaves(PULL), 1e-6 / exact.rate
    first, last = ((exact.acceleration(t + small) - exact.acceleration(t - small)) for t in (0.0, left))
    return 0.5 * LENGTH / np.sqrt(stiffness / DENSITY) * abs(first / last)


def test_the_rates_are_those_of_the_lift():
    exact, small = cam(400.0), 1e-7
    for t in (1e-3, 4e-3, 9e-3):
        slope = (exact.lift(t + small) - exact.lift(t - small)) / (2.0 * small)
        bend = (exact.velocity(t + small) - exact.velocity(t - small)) / (2.0 * small)
        assert exact.velocity(t) == pytest.approx(slope, rel=1e-6)
        assert exact.acceleration(t) == pytest.approx(bend, rel=1e-6)


def test_a_great_disc_is_a_flat_follower():
    """Its lift is a sine; it leaves at the angle whose sine is g / (omega^2 e), above omega^2 e = g only."""
    flat = Cam(radius=1e4, eccentricity=1.0, rate=2.0)
    assert flat.limit(4.0) == pytest.approx(2.0, rel=1e-4)
    assert np.sin(flat.rate * flat.leaves(2.0)) == pytest.approx(0.5, abs=1e-3)
    assert flat.leaves(4.01) == np.inf


def test_it_leaves_above_the_limit_and_lands_on_the_cam():
    limit = cam(100.0).limit(PULL)
    assert cam(0.999 * limit).leaves(PULL) == np.inf
    exact = cam(1.3 * limit)
    left, landed = exact.leaves(PULL), exact.lands(PULL)
    assert exact.acceleration(left) == pytest.approx(-PULL, rel=1e-9)
    assert exact.push(left, MASS, PULL) == pytest.approx(0.0, abs=1e-9)
    flown = landed - left
    assert exact.lift(landed) == pytest.approx(exact.lift(left) + exact.velocity(left) * flown - 0.5 * PULL * flown**2)


@pytest.mark.parametrize("stiffness", [1e8, 4e8])
def test_an_elastic_follower_leaves_within_the_ringing_of_its_start(stiffness):
    exact = cam(471.239)
    run = follow(471.239, stiffness, 1.4e-3, 4e-5)
    assert list(run.events["kind"])[:1] == ["release"]
    assert abs(run.events["time"][0] - exact.leaves(PULL)) <= ringing(exact, stiffness)
    assert run.summary["energy_error_relative"] < 1e-9


@pytest.mark.slow
def test_it_lands_where_a_rigid_one_does():
    exact = cam(471.239)
    run = follow(471.239, 4e8, 9.1e-3, 1e-4)
    touch = run.events["time"][list(run.events["kind"]).index("touch")]
    assert abs(touch - exact.lands(PULL)) <= 0.2 * ringing(exact, 4e8), "of the ringing only the momentum counts"


@pytest.mark.slow
def test_below_the_limit_it_follows_with_the_force_of_a_rigid_one():
    exact = cam(300.0)
    run = follow(300.0, 4e8, 7e-3, 1e-4)
    assert not len(run.events["kind"])
    time, step = run.history["time"][1:], np.diff(run.history["time"])
    np.testing.assert_allclose(run.history["tip"][1:], [exact.lift(t) for t in time], atol=1e-12)
    rigid = np.array([exact.push(t - 0.5 * h, MASS, PULL) for t, h in zip(time, step, strict=True)])
    jerk = 300.0**3 * ECCENTRICITY
    rings = 0.5 * MASS * jerk * LENGTH / np.sqrt(4e8 / DENSITY)
    assert np.abs(run.history["contact.cam.force_n"][1:] - rigid).max() <= 2.0 * rings
    assert rigid.min() < 0.3 * MASS * PULL, "at the top the cam hardly presses"
