"""A08: two bars that differ in length (a) or in impedance (b, c) collide, with meshes that do not match across them.

As in A07 the speed is that of waves in one dimension and a hundredth of it in the plane and in space.
"""

import pytest

import results
from softway.apps.verify.cases.waves.a08_unequal_bars import FORCE, VELOCITY, VIBRATION, thrown
from softway.apps.verify.scenes.colliding import Collision

pytestmark = pytest.mark.slow

SPACES = [("a", 1), ("a", 2), pytest.param(("a", 3), marks=pytest.mark.minutes), ("b", 1), ("b", 2), ("c", 1)]


@pytest.fixture(scope="module", params=SPACES, ids=lambda p: f"{p[0]}-{p[1]}D")
def collision(request: pytest.FixtureRequest) -> tuple[Collision, float, str]:
    """The collision, the speed and the name of the case."""
    case, dim = request.param
    return *thrown(case, dim), case


@pytest.mark.minutes
def test_case():
    assert results.missed("A08") == set()


def test_velocities_of_the_centres_of_mass(collision):
    """The case allows 0.01 for a and 0.02 for c."""
    march, speed, case = collision
    assert march.velocity[:, 0] / speed == pytest.approx(VELOCITY[case], abs=0.01)


def test_the_force_has_two_levels(collision):
    """The case allows 2 percent of the first; the second has waves on it that each reflection left behind."""
    march, speed, case = collision
    first, second = FORCE[case]
    assert march.mean_force(0.1, 0.95) / speed == pytest.approx(first, rel=0.02)
    assert march.mean_force(1.1, 1.95) / speed == pytest.approx(second, rel=0.025)
    assert march.force.max() / speed <= 1.1 * first


def test_the_force_ends_after_the_round_trip(collision):
    """The case allows 2 percent for a; the instant is that at which the force has fallen to half of its last level."""
    march, speed, case = collision
    assert march.falls(0.5 * FORCE[case][1] * speed) == pytest.approx(2.0, rel=0.02)
    assert march.release == pytest.approx(2.0, rel=0.025)


def test_momentum_and_energy(collision):
    march, _, case = collision
    assert march.momentum <= 1e-12
    assert march.error <= 1e-12
    assert march.vibration == pytest.approx(VIBRATION[case], abs=0.02)
    assert march.gap >= -1e-14


def test_the_last_release_of_a():
    """The short bar stops dead, and the end of the long one then rests before it without force: exactly, they stay.

    What is left of the force when its front has passed holds the ends together for a while, in proportion to the mesh.
    """
    late = [thrown("a", 1, refined)[0].release - 2.0 for refined in (1, 2)]
    assert late[1] <= 0.02 * 2.0
    assert late[0] / late[1] > 1.7
