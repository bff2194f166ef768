"""A07: two equal bars collide, in one, two and three dimensions, with meshes that do not match across the bars.

The case throws the left bar with the speed of waves.  In the plane and in space it has a hundredth of it, and results
are given as parts of it: bars shortened by half, pressed end to end without friction and held by nothing at their
sides, would buckle; rounding grows there by about exp(13 t).
"""

from dataclasses import replace

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.waves import a07_equal_bars
from softway.apps.verify.scenes.colliding import Bar, Collision, collided, pair

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", params=a07_equal_bars.SCENES)
def collision(request: pytest.FixtureRequest) -> tuple[Collision, float]:
    """The collision and the speed; 50 elements along each bar, 3 and 4 or 2 and 3 across them."""
    return a07_equal_bars.crashed(request.param), a07_equal_bars.speed(request.param)


def test_case():
    assert results.missed("A07") == set()


def test_duration_and_velocities(collision):
    """The case allows 2 percent and 0.01: the bars exchange their velocities after the round trip of a wave."""
    march, speed = collision
    assert march.touch == 0.0
    assert march.duration == pytest.approx(2.0, rel=0.01)
    along = march.velocity[:, 0] / speed
    assert along == pytest.approx([0.0, 1.0], abs=0.002)


def test_momentum_and_energy(collision):
    """The case allows 1e-12 and 1 percent."""
    march, _ = collision
    assert march.momentum <= 1e-12
    assert march.error <= 1e-12
    assert march.energy == pytest.approx(1.0, abs=1e-12)
    assert march.gap >= -1e-14


def test_the_force_is_half_the_impedance_times_the_speed(collision):
    """Its level before and after the reflection at the free ends, and its rise at the touch of massless nodes."""
    march, speed = collision
    assert march.mean_force(0.1, 0.95) / speed == pytest.approx(0.5, rel=0.015)
    assert march.mean_force(1.05, 1.95) / speed == pytest.approx(0.5, rel=0.01)
    assert march.force.max() / speed <= 1.1 * 0.5
    assert march.force.min() >= 0.0
    assert march.falls(0.25 * speed) == pytest.approx(2.0, rel=0.01)


def test_nothing_moves_sideways(collision, request):
    """There is no lateral contraction: what the sides do is rounding, however the meshes divide the interface.

    Nodes on faces hand over forces, not a pressure; their interface ripples.
    """
    march, speed = collision
    sideways = [np.abs(v[:, 1:]).max(initial=0.0) for s in march.steps for v in s.after.velocity.values()]
    ripple = "nodes on faces" in request.node.name
    assert max(sideways) <= (0.05 if ripple else 1e-9) * speed


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("rule", [sw.contact.Paper(), sw.contact.Impulse()])
def test_the_layers_that_meet_become_one(rule, dim):
    """Rules that stop nodes lose what half a layer of each bar loses in an inelastic impact, with lumped mass, and
    keep the momentum.
    """
    scene = pair(Bar(speed=0.01, along=20, across=2), Bar(along=25, across=2), dim, gap=3e-4)
    bodies = {name: replace(body, mass=sw.bodies.Lumped()) for name, body in scene.bodies.items()}
    march = collided(
        replace(scene, bodies=bodies, contacts=(replace(scene.contacts[0], timing=rule),)), 2.3, step=0.0165
    )
    one, two = 1.0 / 40.0, 1.0 / 50.0
    lost = next(s.ledger.dissipation for s in march.steps if s.ledger.dissipation)
    start = march.steps[0].ledger
    assert lost == pytest.approx(start.energy_kinetic * one * two / (one + two), rel=1e-9)
    assert march.momentum <= 1e-12
    assert march.gap >= -1e-14
