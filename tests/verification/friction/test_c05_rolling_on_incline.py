"""C05: round bodies on an incline; the way of many facets is left to ``softway verify``."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c05_rolling_on_incline import gone

pytestmark = pytest.mark.slow


def test_a_ring_slips():
    course = gone("ring", 0.6, 0.15, 0.1, 2e-3)
    known = next(q["value"] for q in results.case("C05")["qoi"] if q["name"] == "acceleration, ring slips")
    assert 2.0 * course.place[-1] / course.time[-1] ** 2 == pytest.approx(known, rel=1e-3)
    assert course.slides.mean() > 0.5
    assert course.error < 1e-9


def test_a_cylinder_rolls_without_slip():
    course = gone("cylinder", 0.4, 0.5, 0.06, 2e-3)
    assert course.creep[~course.slides].max() < 1e-8
    assert course.spin[-1] * 0.1 == pytest.approx(course.velocity[-1], rel=0.05)
    assert np.diff(course.place).min() > 0.0
