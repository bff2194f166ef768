"""C04: a block slows down under viscoplastic friction, F = -alpha |v|^(p-1) v."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c04_viscoplastic_friction import STEP, slowed

pytestmark = pytest.mark.slow

REFERENCE = results.case("C04")["reference"]


def test_the_case():
    assert results.missed("C04") == set()


@pytest.mark.parametrize("p", [1.0, 2.0])
def test_the_velocity_after_a_second(p):
    """Second order."""
    known = REFERENCE["v_at_1"][f"{p:.1f}"]
    errors = []
    for step in (STEP, 0.5 * STEP):
        _, place, speed = slowed(p, *([step] if step < STEP else []))
        errors.append(abs(speed[-1] / known[0] - 1.0))
        assert place[-1] == pytest.approx(known[1], rel=2e-4)
    assert errors[0] / errors[1] > 3.0


def test_it_stops_in_finite_time():
    time, place, speed = slowed(0.5, until=4.5)
    assert place[-1] == pytest.approx(REFERENCE["stop_distance_p05"], rel=1e-4)
    assert np.abs(speed[time > REFERENCE["stop_time_p05"] + 0.05]).max() < 1e-6
