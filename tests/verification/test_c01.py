"""C01: a block thrown up an incline of 20 degrees; it comes back with mu = 0.2, and stays with mu = 0.5.

The block is elastic, 0.2 x 0.1, stiff: E = 1e9 for rho = 1000, so that its deflections are 1e-7 of the way.
"""

import numpy as np
import pytest

import softway as sw
from results import case
from softway.verify.scenes import sliding

REFERENCE = case("C01")["reference"]


def test_a_block_comes_back():
    known = REFERENCE["mu_0_2"]
    scene = sliding.incline(20.0, 0.2, 3.0)
    march = list(sliding.travelled(sw.march(scene, until=1.8, step=0.01)))
    times, places = np.array([(t, x) for t, x, _ in march]).T
    assert np.abs(times - known["t_stop"]).min() < 1e-8
    assert places.max() == pytest.approx(known["d_up"], rel=1e-7)
    down = (times > known["t_stop"] + 0.05) & (places > 0.0)
    speeds = np.array([s.ledger.momentum[0] for _, _, s in march]) / 20.0
    falls = np.polyfit(times[down] - known["t_stop"], speeds[down], 1)
    assert falls[0] == pytest.approx(-known["a_down"], rel=1e-5)
    back = np.interp(0.0, -places[times > 1.0], times[times > 1.0])
    assert back == pytest.approx(known["t_return"], rel=1e-4)
    assert np.interp(back, times, speeds) == pytest.approx(-known["v_return"], rel=1e-4)
    assert max(abs(s.ledger.energy_error) for _, _, s in march) < 1e-9 * 90.0


def test_a_block_stays():
    """It stops where it should to 1e-7, and does not creep in 10 s, which are 200 slabs: its own vibrations remain."""
    known = REFERENCE["mu_0_5"]
    scene = sliding.incline(20.0, 0.5, 3.0)
    march = list(sliding.travelled(sw.march(scene, until=10.4, step=0.05)))
    times, places = np.array([(t, x) for t, x, _ in march]).T
    assert np.abs(times - known["t_stop"]).min() < 1e-8
    after = times > known["t_stop"] + 0.01
    assert places[after] == pytest.approx(np.full(after.sum(), known["d_up"]), rel=1e-6)
    feet = np.array([s.after.displacement["b"][:9, 0].mean() for t, _, s in march if t > known["t_stop"] + 0.01])
    assert np.ptp(feet) < 1e-8
    assert march[-1][2].ledger.dissipation == pytest.approx(
        0.5 * 20.0 * 9.0 - 20.0 * 9.81 * np.sin(np.deg2rad(20.0)) * known["d_up"], rel=1e-6
    )
