"""C02: a mass on a spring on a rough floor goes to rest at an offset.

A stiff block on a thin column that bends, see ``scenes/sprung.py``; ten times the weight and a tenth of the friction,
whose product is that of the case.
"""

import numpy as np
import pytest

import softway as sw
from results import case
from softway.verify.scenes import sprung

REFERENCE = case("C02")["reference"]


def test_it_goes_to_rest():
    it = sprung.Sprung(dim=2, mass=1.0, stiffness=100.0, weight=98.1)
    scene = it.scene((-1e-9, 0.0), (0.2, 0.0)[:1], sw.Coulomb(mu=0.03))
    steps = list(sw.march(scene, until=1.2, step=2e-3))
    times = np.array([s.after.time for s in steps])
    x = np.array([it.mean(s.after.displacement["b"])[0] for s in steps])
    for t, place in REFERENCE["turning_points"][1:]:
        turn = int(np.argmin(np.abs(times - t)))
        assert times[turn] == pytest.approx(t, abs=1e-4)
        assert x[turn] == pytest.approx(place, abs=2e-7)
    assert x[-1] == pytest.approx(REFERENCE["final_rest"], abs=1e-5)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-8
    assert not any(s.report.rejections for s in steps)
