"""C09: a unit block on a slope of tan = 0.5 slides with mu = 0.49 and sticks with 0.50."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c09_slope_stick_or_slip import let_go

pytestmark = pytest.mark.slow


def test_the_case():
    assert results.missed("C09") == set()


def test_it_slides():
    """The case allows 0.02."""
    _, way, error = let_go(0.49)
    assert way[-1] == pytest.approx(results.case("C09")["reference"]["x_049_T2"], rel=1e-4)
    assert error < 1e-9


@pytest.mark.parametrize("mu", [0.5, 0.5001])
def test_it_sticks(mu):
    """Even at the limit."""
    _, way, _ = let_go(mu)
    assert np.ptp(way) < 1e-10
    assert abs(way[-1]) < 1e-10
