"""C01: a block thrown up an incline of 20 degrees; it comes back with mu = 0.2, and stays with mu = 0.5."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.friction.c01_block_on_incline import MASS, SPEED, creep, thrown

REFERENCE = results.case("C01")["reference"]


@pytest.mark.slow
def test_the_case():
    assert results.missed("C01") == set()


def test_a_block_comes_back():
    known, way = REFERENCE["mu_0_2"], thrown(0.2)
    assert way.turn == pytest.approx(known["t_stop"], abs=1e-8)
    assert way.place.max() == pytest.approx(known["d_up"], rel=1e-7)
    down = (way.time > known["t_stop"] + 0.05) & (way.place > 0.0)
    falls = np.polyfit(way.time[down] - known["t_stop"], way.speed[down], 1)
    assert falls[0] == pytest.approx(-known["a_down"], rel=1e-5)
    assert way.back == pytest.approx((known["t_return"], -known["v_return"]), rel=1e-4)
    assert max(abs(s.ledger.energy_error) for s in way.steps) < 1e-9 * MASS * 0.5 * SPEED**2


@pytest.mark.slow
def test_a_block_stays():
    """It stops where it should to 1e-7, and does not creep in 10 s, which are 200 slabs: its own vibrations remain."""
    known, way = REFERENCE["mu_0_5"], thrown(0.5)
    assert np.abs(way.time - known["t_stop"]).min() < 1e-8
    after = way.time > known["t_stop"] + 0.01
    assert way.place[after] == pytest.approx(np.full(after.sum(), known["d_up"]), rel=1e-6)
    assert creep(way) < 1e-8
    assert way.steps[-1].ledger.dissipation == pytest.approx(
        MASS * (0.5 * SPEED**2 - 9.81 * np.sin(np.deg2rad(20.0)) * known["d_up"]), rel=1e-6
    )
