"""Bounces between two planes: energy, gap and force of the Energy rule; the loss of the rules that stop nodes."""

from math import acosh, sqrt, tanh

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import softway as sw
from bouncing import CLEARANCE, SPEED, ball, between_planes, bounced, cube, step_of
from orders import order

pytestmark = pytest.mark.slow

BODIES = {"cube": cube(4), "ball": ball(4)}
TIMES = (0.5, 1.0, 2.0)
"""Slabs in units of the time in which a wave crosses the shortest edge."""
HUMPS = {"cube": 1.25, "ball": 1.1}
"""Total variation of the force of a bounce over twice its maximum. The ball has one hump; the force of a cube that
rests on its face has two, since it swings sideways: 1.21 with four cells a side, 1.41 with eight, 1.25 with twelve."""


@pytest.mark.few(2)
@pytest.mark.parametrize(("speed", "courant"), [*((0.1, t) for t in TIMES), *((0.2, t) for t in TIMES[1:])])
@pytest.mark.parametrize("body", BODIES)
def test_ten_bounces(body, speed, courant):
    mesh = BODIES[body]
    march = bounced(between_planes(mesh, speed), step_of(mesh, courant), 10)
    assert np.abs(march.energy - 1.0).max() <= 1e-9
    assert march.gap.min() >= -1e-12
    assert march.force.min() >= 0.0
    assert march.variation <= HUMPS[body]
    assert march.scalar.max() <= 0.5
    assert march.iterations.max() <= 25


@pytest.mark.few(3)
@pytest.mark.parametrize("courant", TIMES[:2])
@pytest.mark.parametrize(
    ("rule", "mass", "part"),
    [
        (sw.contact.Paper(), sw.bodies.Lumped(), 1.0 / 8.0),
        (sw.contact.Impulse(), sw.bodies.Lumped(), 1.0 / 8.0),
        (sw.contact.Impulse(), sw.bodies.Consistent(), sqrt(3.0) / 24.0 * tanh(4.0 * acosh(2.0))),
    ],
)
def test_a_flat_touch_loses_the_energy_of_the_layer_that_stops(rule, mass, part, courant):
    """All nodes of a face of N^2 elements touch at once: 1/(2 N) of the energy with lumped mass, the share of half a
    layer; with consistent mass and a balanced jump that of a bar of N elements.
    """
    scene = between_planes(BODIES["cube"], 0.1, timing=rule, mass=mass)
    march = bounced(scene, step_of(BODIES["cube"], courant), 1)
    assert first_loss(march) == pytest.approx(part, rel=1e-12)


def test_a_flat_touch_by_the_paper_rule_with_consistent_mass():
    """2/(3 N) of the energy. The neighbours take part, and inside the slab they feel the touch: second order in h."""
    steps = [CLEARANCE / 0.1 / (slabs + 0.65) for slabs in (8, 16, 32)]
    scene = between_planes(BODIES["cube"], 0.1, timing=sw.contact.Paper(), mass=sw.bodies.Consistent())
    marches = [bounced(scene, step, 1) for step in steps]
    assert order([abs(first_loss(m) - 1.0 / 6.0) for m in marches], steps) > 1.8
    assert order([abs(m.energy[-1] - 5.0 / 6.0) for m in marches], steps) > 1.5
    assert marches[-1].energy[-1] == pytest.approx(5.0 / 6.0, abs=1e-3)


@pytest.mark.parametrize("rule", [sw.contact.Paper(), sw.contact.Impulse()])
def test_the_touch_of_one_node_loses_its_kinetic_energy(rule):
    """The pole of a ball: its lumped mass, or the mass that the consistent matrix sets against its jump."""
    mass = sw.bodies.Lumped() if rule == sw.contact.Paper() else sw.bodies.Consistent()
    scene = between_planes(BODIES["ball"], 0.1, timing=rule, mass=mass)
    march = bounced(scene, step_of(BODIES["ball"], 1.0), 1)
    matrix = sw.build(scene).mass
    pole = np.zeros(matrix.shape[0])
    pole[BODIES["ball"].nearest((0.0, 0.0, -0.5))] = 1.0
    assert first_loss(march) == pytest.approx(1.0 / (pole @ spsolve(matrix.tocsc(), pole)) / matrix.sum(), rel=1e-12)


def first_loss(march):
    """Part of the energy that the first touch dissipates."""
    return march.dissipation[np.flatnonzero(march.dissipation)[0]]


def test_the_speed_of_waves():
    moduli = sw.NeoHookean(E=1.0, nu=0.3).tangent(np.zeros((3, 3)))
    assert pytest.approx(sqrt(moduli[0, 0, 0, 0]), rel=1e-12) == SPEED
