"""C08: the friction oscillator of SDND100 (Code_Aster), displaced at 45 degrees in the plane of the floor.

A stiff block in space on a column that bends both ways alike, see ``scenes/sprung.py``; ten times the weight and a
tenth of the friction.
"""

import numpy as np
import pytest

import softway as sw
from results import case
from softway.verify.scenes import sprung


def test_it_swings_along_its_diagonal_and_stops():
    known, period = case("C08")["reference"], np.pi / 100.0
    it = sprung.Sprung(dim=3, mass=1.0, stiffness=1e4, weight=100.0)
    place = 0.00085 / np.sqrt(2.0)
    scene = it.scene((-1e-9, -1e-9, 0.0), (place, place), sw.Coulomb(mu=0.01))
    steps = list(sw.march(scene, until=4.5 * period, step=period / 40.0))
    times = np.array([s.after.time for s in steps])
    x = np.array([it.mean(s.after.displacement["b"])[:2] for s in steps])
    for k, swing in enumerate(known["turning"], 1):
        turn = int(np.argmin(np.abs(times - k * period)))
        tolerance = {"rel": 1e-3} if k < 4 else {"rel": 1e-2}
        assert x[turn] == pytest.approx(np.full(2, swing / np.sqrt(2.0)), **tolerance)
    assert x[-1] == pytest.approx(np.full(2, known["turning"][-1] / np.sqrt(2.0)), rel=1e-2)
