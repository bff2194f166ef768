"""C03, C05 to C07 with rigid bodies: within the tolerances of the sheets for rigid bodies."""

import numpy as np

import results
from softway.apps.verify.cases.friction import c03_stick_slip_belt as c03
from softway.apps.verify.cases.friction import c05_rolling_on_incline as c05
from softway.apps.verify.cases.friction import c06_sliding_to_rolling as c06
from softway.apps.verify.cases.friction import c07_rod_end_collision as c07
from softway.apps.verify.quantity import compared


def misses(name: str, values: dict[str, object]) -> list[str]:
    """Names of the quantities of a case that are outside their tolerances, out of those given."""
    return [q.name for q in compared(results.case(name), values) if q.name in values and not q.passed]


def test_the_period_of_a_rigid_block_on_a_belt() -> None:
    course = c03.carried_rigid()
    values = {
        "x_max, rigid": course.place.max(),
        "time of slip, rigid": course.sticks[0] - course.slips[0],
        "period, rigid": course.slips[1] - course.slips[0],
    }
    assert misses("C03", values) == []


def test_rigid_bodies_roll_or_slip() -> None:
    ring, ball = c05.gone_rigid("ring", 0.6, 0.15, 0.4, 1e-3), c05.gone_rigid("ball", 0.4, 0.5, 0.4, 2e-3)
    values = {
        "acceleration, ring slips, rigid": ring.velocity[-1] / 0.4,
        "acceleration, ball rolls, rigid": ball.velocity[-1] / 0.4,
        "slip velocity where they roll, rigid": np.abs(ball.slip).max(),
    }
    assert misses("C05", values) == []
    assert np.abs(ring.slip).max() > 1.0


def test_a_rigid_ball_slides_until_it_rolls() -> None:
    instant, velocity = c06.rolls(c06.thrown_rigid())
    assert misses("C06", {"time until it rolls, rigid": instant, "velocity when it rolls, rigid": velocity}) == []


def test_the_march_has_the_impacts_of_the_impulse_path() -> None:
    outcome = c07.compute()
    assert misses("C07", dict(outcome.values)) == []
    np.testing.assert_allclose(*outcome.values.values(), atol=1e-12)
