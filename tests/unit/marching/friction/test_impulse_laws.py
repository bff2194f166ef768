"""Friction laws with the rules Impulse and Paper, against the exact motion of a block that they slow down."""

import numpy as np
import pytest

import softway as sw

RULES = [sw.contact.Impulse(), sw.contact.Paper()]
SPEED, WEIGHT, E, HEIGHT = 2.0, 100.0, 1e6, 0.25


def slowed(rule, law, step, until):
    """Times and speeds of a block of mass 1 and length 1, compressed by its weight from the start."""
    squeezed = sw.bodies.Affine(gradient=((0.0, 0.0), (0.0, -0.5 * WEIGHT / E)))
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(2, 1)),
        material=sw.LinearElastic(E=E, nu=0.0),
        density=1.0 / HEIGHT,
        velocity=sw.bodies.Uniform(value=(SPEED, 0.0)),
        displacement=squeezed,
    )
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    scene = sw.Scene(
        bodies={"block": block, "plane": plane},
        contacts=(sw.Contact(between=("block.bottom", "plane"), friction=law, timing=rule),),
        loads=(sw.Gravity(acceleration=(0.0, -WEIGHT)),),
    )
    steps = list(sw.march(scene, until=until, step=step))
    assert np.diff([0.0, *(s.ledger.dissipation for s in steps)]).min() >= 0.0
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12
    return np.array([(s.after.time, s.ledger.momentum[0]) for s in steps]).T


def root(t):
    """Speed under a friction of .9 times the root of the speed, which stops the block."""
    return np.clip(np.sqrt(SPEED) - 0.45 * t, 0.0, None) ** 2


@pytest.mark.few(3)
@pytest.mark.parametrize(
    ("law", "exact"),
    [
        (sw.laws.NortonHoffFriction(alpha=0.9, p=1.0), lambda t: SPEED * np.exp(-0.9 * t)),
        (sw.laws.NortonHoffFriction(alpha=0.9, p=2.0), lambda t: SPEED / (1.0 + 0.9 * SPEED * t)),
        (sw.laws.NortonHoffFriction(alpha=0.9, p=0.5), root),
        (sw.laws.Lubricated(viscosity=0.9e-3, film=1e-3), lambda t: SPEED * np.exp(-0.9 * t)),
    ],
    ids=["viscous", "square", "root", "film"],
)
@pytest.mark.parametrize("rule", RULES, ids=str)
def test_friction_of_the_speed_is_of_second_order(rule, law, exact):
    errors = []
    for step in (0.05, 0.025):
        time, speed = slowed(rule, law, step, until=1.0)
        errors.append(np.abs(speed - exact(time)).max())
    assert errors[0] < 1e-3
    assert 1.8 < np.log2(errors[0] / errors[1]) < 2.2


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_a_limited_law_has_its_limit_first(rule):
    """The limit 1.5 until the speed is 1.5 / .9, then an exponential: a slab with the change errs by half of it."""
    law = sw.laws.LimitedViscoplastic(alpha=0.9, p=1.0, K=1.0, mbar=1.0, sigma_eq=1.5 * np.sqrt(3.0), mu=1.0)
    slow, step = 1.5 / 0.9, 0.025
    change = (SPEED - slow) / 1.5
    time, speed = slowed(rule, law, step, until=1.0)
    exact = np.where(time < change, SPEED - 1.5 * time, slow * np.exp(-0.9 * (time - change)))
    assert np.abs(speed - exact).max() < 0.5 * 0.9 * 1.5 * step**2
    assert np.abs(speed - exact)[time < change - step].max() < 1e-12


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_friction_without_pressure_is_steady(rule):
    time, speed = slowed(rule, sw.laws.Tresca(shear=0.5), 0.05, until=1.0)
    assert speed == pytest.approx(SPEED - 0.5 * time, abs=1e-12)


@pytest.mark.few(1)
@pytest.mark.parametrize("rule", RULES, ids=str)
def test_a_law_of_the_root_of_the_speed_stops_the_block(rule):
    time, speed = slowed(rule, sw.laws.NortonHoffFriction(alpha=0.9, p=0.5), 0.05, until=3.6)
    assert np.abs(speed - root(time)).max() < 1e-3
    assert 0.0 <= speed[-1] < 1e-3 * SPEED
