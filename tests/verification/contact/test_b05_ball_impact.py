"""B05: a steel ball meets a rigid plane at 1 m/s, as a body of revolution; quasi-static impact by Hertz.

A ball is a little stiffer than a half-space (case B04): the remaining differences fall with the size of the contact.
"""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.contact.b05_ball_impact import Course, exact, thrown


@pytest.fixture(scope="module")
def course() -> Course:
    """The case."""
    return thrown(1.0)


def test_case():
    assert results.missed("B05") == set()


def test_duration_force_and_approach(course):
    """The case allows 3, 3 and 4 percent."""
    assert course.duration == pytest.approx(exact(1.0).duration, rel=0.02)
    assert course.force.max() == pytest.approx(exact(1.0).force, rel=0.025)
    assert course.approach == pytest.approx(exact(1.0).approach, rel=0.02)
    assert course.across >= 8


def test_the_ball_leaves_with_its_speed(course):
    """The case allows 2 percent; hardly any energy is left in vibrations."""
    assert course.restitution == pytest.approx(1.0, abs=1e-4)


def test_the_energy_is_kept_and_nothing_is_below_the_plane(course):
    assert course.error <= 1e-9
    assert course.gap >= -1e-12


def test_the_force_is_one_hump(course):
    """Rising to its maximum and falling from it, but for what one node more in contact makes of a slab."""
    variation = np.abs(np.diff(np.concatenate([[0.0], course.force, [0.0]]))).sum()
    assert variation / (2.0 * course.force.max()) < 1.01


def test_few_iterations(course):
    """Linear elasticity: one solves and one confirms, what is more finds the contact and the scalar."""
    assert course.iterations.mean() < 8


def test_a_slower_ball_is_nearer_to_hertz(course):
    """At a hundredth of the speed the contact is 6.3 times smaller."""
    slow = thrown(0.01)
    for name in ("duration", "approach"):
        fast_error, slow_error = (
            abs(getattr(c, name) / getattr(exact(v), name) - 1.0) for c, v in ((course, 1.0), (slow, 0.01))
        )
        assert slow_error < 0.5 * fast_error
    assert slow.force.max() == pytest.approx(exact(0.01).force, rel=0.005)
