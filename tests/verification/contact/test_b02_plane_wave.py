"""B02: a plane wave through two blocks on lateral rollers whose meshes, 5 and 8 elements across, do not match.

E = rho = 1, nu = 0.3; the waves are pressure waves, c = sqrt((lambda + 2 mu)/rho).
"""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.contact.b02_plane_wave import DURATION, PRESSURE, crashed, uneven
from softway.apps.verify.scenes.colliding import Collision

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", params=[2, 3], ids=["plane strain", "3D"])
def collision(request: pytest.FixtureRequest) -> Collision:
    """The collision: 50 elements along each block, in space 25."""
    return crashed(request.param)


def test_case():
    assert results.missed("B02") == set()


def test_duration_pressure_and_velocities(collision):
    """The case allows 2 percent, 2 percent and 0.01."""
    assert collision.duration == pytest.approx(DURATION, rel=0.02)
    assert collision.mean_force(0.0, DURATION) == pytest.approx(PRESSURE, rel=0.02)
    assert collision.velocity[:, 0] == pytest.approx([0.0, 1.0], abs=0.01)


def test_the_pressure_is_uniform_across(collision):
    """The case allows 1e-8 of it: the forces on the nodes are in proportion to their areas as long as they push."""
    assert uneven(collision) <= 1e-8


def test_nothing_moves_across(collision):
    across = [np.abs(v[:, 1:]).max() for s in collision.steps for v in s.after.velocity.values()]
    assert max(across) <= 1e-8


def test_momentum_and_energy(collision):
    assert collision.momentum <= 1e-12
    assert collision.error <= 1e-12
    assert collision.gap >= -1e-14
