"""C04: a block slows down under viscoplastic friction, F = -alpha |v|^(p-1) v.

A block of length 1 and mass 1.3, E = 1e6, pressed to the floor; K = 1 over its length makes the traction.
"""

import numpy as np
import pytest

import softway as sw
from results import case
from softway.verify.scenes import sliding

CASE = case("C04")
MASS, ALPHA, START = 1.3, 0.9, 2.0


def slowed(p: float, step: float, until: float) -> list[tuple[float, float, float]]:
    """Time, place and velocity at the ends of the slabs."""
    scene = sliding.on_plane(
        friction=sw.NortonHoffFriction(alpha=ALPHA, p=p),
        velocity=START,
        gravity=(0.0, -100.0),
        resisted=-ALPHA * START**p / MASS,
        size=(1.0, 0.2),
        cells=(4, 4),
        E=1e6,
        nu=0.0,
        density=MASS / 0.2,
    )
    return [
        (t, x, s.ledger.momentum[0] / MASS) for t, x, s in sliding.travelled(sw.march(scene, until=until, step=step))
    ]


@pytest.mark.parametrize("p", [1.0, 2.0])
def test_the_velocity_after_a_second(p):
    """The case allows 1e-4; second order."""
    errors = []
    for step in (0.02, 0.01):
        _, place, speed = slowed(p, step, 1.0)[-1]
        known = CASE["reference"]["v_at_1"][f"{p:.1f}"]
        errors.append(abs(speed / known[0] - 1.0))
        assert place == pytest.approx(known[1], rel=2e-4)
    assert errors[0] < 1e-4
    assert errors[0] / errors[1] > 3.0


def test_it_stops_in_finite_time():
    march = np.array(slowed(0.5, 0.02, 4.5))
    stop, way = CASE["reference"]["stop_time_p05"], CASE["reference"]["stop_distance_p05"]
    moving = np.abs(march[:, 2]) > 1e-4
    assert march[moving, 0].max() == pytest.approx(stop - np.sqrt(1e-4) * 2.0 * MASS / ALPHA, abs=0.02)
    assert march[-1, 1] == pytest.approx(way, rel=1e-4)
    assert np.abs(march[march[:, 0] > stop + 0.05, 2]).max() < 1e-6
