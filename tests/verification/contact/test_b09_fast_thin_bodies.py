"""B09: thin bodies, so fast that one slab of the length asked for carries one of them through the other and away.

The step is 0.01 s, the speed 100 m/s, the distance 0.3 m and the thickness 0.01 m.  The case shortens the bodies by
half (E = 10 kPa); where they meet with corners and edges they are stiffer.
"""

import pytest

import results
import softway as sw
from softway.apps.verify.cases.contact import b09_fast_thin_bodies
from softway.apps.verify.cases.contact.b09_fast_thin_bodies import GAP, SPEED, THICKNESS, Shot, away, pair, shot

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", params=["1D", "2D"])
def aligned(request: pytest.FixtureRequest) -> Shot:
    """Faces that meet squarely: 50 elements in 1D, 20 x 3 and 20 x 4 in 2D."""
    return b09_fast_thin_bodies.aligned(request.param)


@pytest.mark.minutes
def test_case():
    assert results.missed("B09") == set()


def test_the_instant_of_the_touch(aligned):
    """The case allows 1e-10."""
    assert min(aligned.instants("touch")) == pytest.approx(GAP / SPEED, abs=1e-10)


def test_the_bodies_exchange_their_velocities(aligned):
    """The case allows 3 percent; the contact lasts for the round trip of a wave."""
    assert aligned.velocity[:, 0] == pytest.approx([0.0, SPEED], abs=0.03 * SPEED)
    assert max(aligned.instants("release")) - GAP / SPEED == pytest.approx(2e-4, rel=0.04)
    assert aligned.error <= 1e-10


def test_the_order_is_never_inverted(aligned):
    assert not aligned.inverted
    for step in aligned.steps:
        (_, left), (_, right) = aligned.places(step)
        assert right[:, 0].min() - left[:, 0].max() >= -1e-10
    assert min(s.certificate.min_gap for s in aligned.steps) >= -1e-14


@pytest.mark.parametrize("aside", [0.0, 0.003])
def test_blocks_with_their_whole_surfaces(aside):
    """In the plane, corners included, flush and moved aside."""
    meshes = [sw.meshes.Rectangle(size=(THICKNESS, 2.0 * THICKNESS), cells=(10, k)) for k in (6, 7)]
    march = shot(pair(meshes, 1e6, (sw.bodies.Placement(), away(aside))), 3.05e-3)
    assert min(march.instants("touch")) == pytest.approx(GAP / SPEED, abs=1e-10)
    assert march.velocity[1, 0] > 0.8 * SPEED
    assert not march.inverted
    assert march.depth <= 0.01 * THICKNESS
    assert march.error <= 1e-8


@pytest.mark.parametrize("name", ["corner on face", pytest.param("edge on edge", marks=pytest.mark.minutes)])
def test_plates_that_meet_with_edges_and_corners(name):
    """No node of a surface comes near the place where edges cross; the touch is that of the plates as rigid bodies.

    The plates are crushed where they meet; their faces, which see each other at nodes or on average, overlap by a
    fraction of an edge, 0.6 and 0.75 of the thickness.
    """
    met = b09_fast_thin_bodies.plates(name)
    march = met.march
    assert met.points == b09_fast_thin_bodies.PLATES[name][2]
    assert min(march.instants("touch")) == pytest.approx(met.instant, abs=1e-10)
    assert march.velocity[1, 0] > 0.4 * SPEED
    assert not march.inverted
    assert met.depth <= 0.05 * THICKNESS
    assert march.error <= 1e-8
