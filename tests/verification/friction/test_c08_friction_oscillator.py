"""C08: the friction oscillator of SDND100 (Code_Aster), displaced at 45 degrees in the plane of the floor."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c08_friction_oscillator import HALF, swung

pytestmark = pytest.mark.slow


def test_the_case():
    assert results.missed("C08") == set()


def test_it_swings_along_its_diagonal_and_stops():
    swing, turning = swung(), results.case("C08")["reference"]["turning"]
    for k, place in enumerate(turning, 1):
        tolerance = {"rel": 1e-3} if k < 4 else {"rel": 1e-2}
        assert swing.at(k * HALF)[:2] == pytest.approx(np.full(2, place / np.sqrt(2.0)), **tolerance)
    assert swing.place[-1, :2] == pytest.approx(np.full(2, turning[-1] / np.sqrt(2.0)), rel=1e-2)
