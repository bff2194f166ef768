"""C08: the friction oscillator of SDND100 (Code_Aster), displaced at 45 degrees in the plane of the floor."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c08_friction_oscillator import AWAY, HALF, swung

pytestmark = pytest.mark.slow


def test_the_case():
    assert results.missed("C08") == set()


def test_it_swings_along_its_diagonal_and_stops():
    """The place of the start is .4 um off, since the block gives way a little; each half swing loses the same way."""
    swing, turning = swung(), results.case("C08")["reference"]["turning"]
    places = np.array([swing.at(k * HALF)[:2] for k in range(1, len(turning) + 1)])
    assert places == pytest.approx(np.outer(turning, np.full(2, np.sqrt(0.5))), abs=5e-4 * AWAY)
    losses = -np.diff(np.linalg.norm(places, axis=1))
    assert losses == pytest.approx(-np.diff(np.abs(turning)), rel=5e-4)
    assert swing.place[-1, :2] == pytest.approx(np.full(2, turning[-1] / np.sqrt(2.0)), rel=1e-2)
