"""C09: a unit block on a slope of tan = 0.5 slides with mu = 0.49 and sticks with 0.50, E = 1e9 for rho = 1000."""

import numpy as np
import pytest

import softway as sw
from results import case
from softway.verify.scenes import sliding

SLOPE = float(np.rad2deg(np.arctan(0.5)))
UNIT = {"size": (1.0, 1.0), "cells": (4, 4)}


def test_it_slides():
    """The case allows 0.02; the block starts in slip, with 1e-9 m/s."""
    scene = sliding.incline(SLOPE, 0.49, -1e-9, **UNIT)
    *_, (_, x, step) = sliding.travelled(sw.march(scene, until=2.0, step=0.01))
    start = -2.5e-6
    assert -x == pytest.approx(case("C09")["reference"]["x_049_T2"] - start, rel=1e-4)
    assert abs(step.ledger.energy_error) < 1e-9


@pytest.mark.parametrize("mu", [0.5, 0.5001])
def test_it_sticks(mu):
    """Even at the limit."""
    scene = sliding.incline(SLOPE, mu, 0.0, rest=True, **UNIT)
    places = np.array([x for _, x, _ in sliding.travelled(sw.march(scene, until=2.0, step=0.01))])
    assert np.ptp(places) < 1e-10
    assert abs(places[-1]) < 1e-5
