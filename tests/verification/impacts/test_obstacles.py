"""Curved rigid obstacles at large deformation: energy kept by the Energy rule, no penetration, frame independence."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw

pytestmark = pytest.mark.slow

BLOCK = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(4, 4, 4), origin=(-0.3, -0.4, 0.05))
RUBBER = sw.NeoHookean(E=1.0, nu=0.3)
UPRIGHT = sw.bodies.Placement()


def dropped(shape, *, mesh=BLOCK, velocity=(0.0, 0.0, -0.2), tag="bottom", place=UPRIGHT, until=3.0, step=0.1,
            timing=sw.contact.Energy()):  # fmt: skip
    """Steps of a block thrown at a shape."""
    body = sw.Solid(
        mesh=mesh,
        material=RUBBER,
        density=1.0,
        velocity=sw.bodies.Uniform(value=velocity),
        mass=sw.bodies.Lumped(),
        place=place,
    )
    contact = sw.Contact(between=(f"body.{tag}", "tool"), name="c", timing=timing)
    scene = sw.Scene(bodies={"body": body, "tool": sw.Tool(shape=shape)}, contacts=(contact,))
    return list(sw.march(scene, until=until, step=step))


def kept(steps, size=1.0):
    """Assert the balance, the gap at the ends of the slabs, eq. (3.9), and that there was an impact; last ledger."""
    start = steps[0].ledger
    total = start.energy_kinetic + start.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-11 * total
    assert min(s.ledger.contacts["c"].min_gap for s in steps) >= -1e-12 * size
    assert max(s.ledger.contacts["c"].power_residual for s in steps) <= 1e-12 * total
    assert {e.kind for s in steps for e in s.events} == {"touch", "release"}
    return steps[-1].ledger


def test_a_block_on_a_ball():
    """The prototype of the rule takes 13.9 iterations here; the tangential momentum comes from the turning normal."""
    steps = dropped(sw.obstacles.Sphere(centre=(0.0, 0.0, -0.6), radius=0.6))
    last = kept(steps)
    assert last.momentum[2] > 0.1
    assert abs(last.momentum[0]) > 0.01
    assert np.mean([s.report.iterations for s in steps]) < 18
    assert not any(s.report.rejections for s in steps)


def test_the_position_converges_at_second_order():
    shape = sw.obstacles.Sphere(centre=(0.0, 0.0, -0.6), radius=0.6)
    ends = [dropped(shape, step=h)[-1].after.displacement["body"] for h in (0.1, 0.05, 0.0125)]
    coarse, fine = (np.sqrt(np.mean((u - ends[-1]) ** 2)) for u in ends[:2])
    assert coarse / fine > 2**1.7


def test_a_block_on_a_roller_keeps_the_momentum_along_the_roller():
    last = kept(dropped(sw.obstacles.Roller(point=(0.0, 0.0, -0.5), axis=(0.0, 1.0, 0.0), radius=0.5)))
    assert abs(last.momentum[1]) <= 1e-12
    assert abs(last.momentum[0]) > 0.01


def test_a_disc_in_a_round_bowl():
    """In the plane, and from inside: the disc slides down the wall of a hollow and climbs it again."""
    disc = sw.meshes.Disc(radius=0.5, cells=8)
    bowl = sw.obstacles.Cavity(of=sw.obstacles.Sphere(centre=(0.0, 0.0), radius=2.0))
    place = sw.bodies.Placement(translation=(1.2, -0.6))
    steps = dropped(bowl, mesh=disc, velocity=(0.1, -0.2), tag="boundary", place=place, until=8.0, step=0.05)
    kept(steps)


def test_a_turned_frame_gives_the_turned_answer():
    """Scene and obstacle turned by the same rotation about the centre of the block."""
    ball = sw.obstacles.Sphere(centre=(0.0, 0.0, -0.6), radius=0.6)
    plain = dropped(ball, until=1.5)
    turn = sw.bodies.Rotation(angle=0.7, axis=(1.0, 2.0, 0.5))
    matrix, middle = turn.matrix(), np.array([0.2, 0.1, 0.55])
    centre = tuple((np.array(ball.centre) - middle) @ matrix.T + middle)
    velocity = tuple(np.array([0.0, 0.0, -0.2]) @ matrix.T)
    turned = dropped(
        replace(ball, centre=centre), velocity=velocity, place=sw.bodies.Placement(rotations=(turn,)), until=1.5
    )
    ours = turned[-1].after.displacement["body"] @ matrix
    assert np.abs(ours - plain[-1].after.displacement["body"]).max() <= 1e-9


def test_newton_agrees_with_the_fixed_point():
    shape = sw.obstacles.Sphere(centre=(0.0, 0.0, -0.6), radius=0.6)
    one = dropped(shape, until=1.0)[-1].after.displacement["body"]
    body = sw.Solid(
        mesh=BLOCK,
        material=RUBBER,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0, 0, -0.2)),
        mass=sw.bodies.Lumped(),
    )
    contact = sw.Contact(between=("body.bottom", "tool"), name="c")
    scene = sw.Scene(bodies={"body": body, "tool": sw.Tool(shape=shape)}, contacts=(contact,))
    two = list(sw.march(scene, until=1.0, step=0.1, method=sw.Newton()))[-1].after.displacement["body"]
    assert np.abs(one - two).max() <= 1e-9


@pytest.mark.parametrize("timing", [sw.contact.Impulse(), sw.contact.Paper()], ids=lambda t: type(t).__name__)
def test_nodes_with_inertia_slide_on_a_ball(timing):
    """The gap closes at the end of every slab; between the ends nodes leave the ball by the curvature of their way."""
    mesh, shape = replace(BLOCK, cells=(2, 2, 2)), sw.obstacles.Sphere(centre=(0.0, 0.0, -0.6), radius=0.6)
    power = []
    for h in (0.1, 0.05):
        steps = dropped(shape, mesh=mesh, timing=timing, until=2.0, step=h)
        assert min(s.certificate.min_gap for s in steps) >= -1e-15
        assert max(s.certificate.momentum_error for s in steps) <= 1e-15
        assert abs(steps[-1].ledger.momentum[0]) > 0.01
        power.append(max(s.certificate.power_residual for s in steps))
    assert np.log2(power[0] / power[1]) > 1.7
