"""Friction of contact nodes with inertia: the rules Impulse and Paper."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw

G, MU = 9.81, 0.3
RULES = [sw.contact.Impulse(), sw.contact.Paper()]
FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))


def block(*, velocity, E=1e9, cells=2, dim=2, lift=0.0, density=1000.0):
    np.eye(dim)[-1]
    mesh = (
        sw.meshes.Rectangle(size=(0.1, 0.1), cells=(cells, cells))
        if dim == 2
        else sw.meshes.Box(size=(0.1, 0.1, 0.1), cells=(cells, cells, cells))
    )
    mesh = mesh.build() if hasattr(mesh, "build") else mesh
    return sw.Solid(
        mesh=mesh,
        material=sw.LinearElastic(E=E, nu=0.3),
        density=density,
        velocity=sw.bodies.Uniform(value=tuple(velocity)),
    )


def sliding(rule, *, dim=2, speed=3.0, friction=None, load=(0.0, -G), start=(-MU * -1.0, -1.0)):
    """A block in steady slip on a floor, under a gravity (along, up)."""
    way = np.array([1.0] if dim == 2 else [0.6, 0.8])
    full = lambda one: tuple(float(v) for v in np.append(one[0] * way, one[1]))  # noqa: E731
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0,) * dim, normal=tuple(np.eye(dim)[-1])))
    return sw.Scene(
        bodies={"block": block(velocity=full((speed, 0.0)), dim=dim), "floor": floor},
        contacts=(
            sw.Contact(
                between=("block.bottom", "floor"), name="floor", friction=friction or sw.Coulomb(mu=MU), timing=rule
            ),
        ),
        loads=(sw.Gravity(acceleration=full(load)),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=full((G * start[0], G * start[1]))),)),
    )


def lost(steps):
    return np.diff([0.0, *(s.ledger.dissipation for s in steps)])


@pytest.mark.parametrize("rule", RULES, ids=str)
@pytest.mark.parametrize("dim", [2, 3])
def test_a_block_that_slides_loses_speed_evenly(rule, dim):
    mass = 1000.0 * 0.1**dim
    steps = list(sw.march(sliding(rule, dim=dim), until=0.1, step=0.01))
    for s in steps:
        speed = 3.0 - MU * G * s.after.time
        assert np.linalg.norm(s.ledger.momentum) == pytest.approx(mass * speed, rel=1e-10)
        assert s.ledger.contacts["floor"].force_t == pytest.approx(MU * s.ledger.contacts["floor"].force_n, rel=1e-10)
        assert s.ledger.dissipation == pytest.approx(0.5 * mass * (9.0 - speed**2), rel=1e-10)
        assert abs(s.ledger.energy_error) < 1e-10


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_the_distance_to_rest_is_of_second_order(rule):
    """The slab of the stop spreads the rest of the momentum over its length: at most ``mu g h^2 / 8`` too far."""
    distance = 1.0 / (2.0 * MU * G)
    for step in (0.02, 0.01):
        steps = list(sw.march(sliding(rule, speed=1.0), until=0.5, step=step))
        x = [s.after.displacement["block"][:, 0].mean() for s in steps]
        assert -1e-7 < x[-1] - distance < MU * G * step**2 / 8.0 + 1e-7
        assert lost(steps).min() >= 0.0
        assert steps[-1].ledger.dissipation == pytest.approx(5.0, rel=1e-6)
        resting = [s for s in steps if s.before.time > 1.0 / (MU * G) + step]
        bottom = np.array([s.after.displacement["block"][:3] for s in resting])
        assert np.ptp(bottom[:, :, 0], axis=0).max() < 1e-6 * distance


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_a_block_within_its_cone_stays(rule):
    steps = list(sw.march(sliding(rule, speed=0.0, load=(0.2 * G, -G), start=(0.2, -1.0)), until=0.05, step=1e-3))
    assert np.ptp([s.after.displacement["block"] for s in steps], axis=0).max() < 1e-15


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_a_block_beyond_its_cone_slides(rule):
    scene = sliding(rule, speed=0.0, load=(0.5 * G, -G), start=(MU, -1.0))
    last = list(sw.march(scene, until=0.2, step=0.01))[-1]
    assert last.ledger.momentum[0] == pytest.approx(10.0 * 0.2 * G * 0.2, rel=1e-6)


@pytest.mark.parametrize(
    "law",
    [
        sw.laws.Tresca(shear=100.0),
        sw.laws.StaticKinetic(mu_s=0.4, mu_k=0.3),
        sw.laws.Stribeck(mu_s=0.4, mu_k=0.3, v_s=0.1),
    ],
    ids=lambda law: type(law).__name__,
)
@pytest.mark.parametrize("rule", RULES, ids=str)
def test_every_law_takes_energy_in_every_slab(rule, law):
    scene = replace(sliding(rule, friction=law, speed=1.0), start=sw.model.AsGiven())
    steps = list(sw.march(scene, until=0.1, step=0.01))
    assert lost(steps).min() >= 0.0
    assert steps[-1].ledger.momentum[0] < 10.0
    assert steps[-1].ledger.dissipation > 0.0


@pytest.mark.parametrize("rule", RULES, ids=str)
@pytest.mark.parametrize("mu", [0.2, 5.0])
def test_an_oblique_impact(rule, mu):
    """Sliding throughout, the tangential impulse is mu times the normal one; a rough floor stops the touching nodes."""
    solid = block(velocity=(2.0, -1.0), E=1e6)
    scene = sw.Scene(
        bodies={"block": solid, "floor": FLOOR},
        contacts=(
            sw.Contact(between=("block.bottom", "floor"), name="floor", friction=sw.Coulomb(mu=mu), timing=rule),
        ),
    )
    steps = list(sw.march(scene, until=2e-3, step=1e-4))
    normal = sum(s.ledger.contacts["floor"].force_n * s.slab.span for s in steps)
    tangential = 20.0 - steps[-1].ledger.momentum[0]
    assert lost(steps).min() >= -1e-12
    if mu < 1.0:
        assert tangential == pytest.approx(mu * normal, rel=1e-10)
    else:
        stuck = [s for s in steps if not s.after.sliding["floor"].any() and s.after.closed["floor"].all()]
        assert stuck
        bottom = stuck[0].after.velocity["block"][:3, 0]
        assert np.abs(bottom).max() < 1e-12
        assert tangential < mu * normal


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_the_answer_is_that_of_the_energy_rule(rule):
    """A block in steady slip, at an instant before its stop."""
    scene = sliding(rule, speed=1.0)
    other = replace(scene, contacts=(replace(scene.contacts[0], timing=sw.contact.Energy()),))
    ours, theirs = (
        list(sw.march(s, until=0.2, step=0.01))[-1].after.displacement["block"][:, 0].mean() for s in (scene, other)
    )
    assert ours == pytest.approx(theirs, rel=1e-7)


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_two_blocks_share_the_momentum(rule):
    lower = replace(block(velocity=(0.0, 0.0), E=1e6, cells=2))
    upper = block(velocity=(1.0, -1.0), E=1e6, cells=3)
    mesh = upper.mesh
    upper = replace(upper, mesh=replace(mesh, points=mesh.points + [0.0, 0.1]) if hasattr(mesh, "points") else mesh)
    scene = sw.Scene(
        bodies={"upper": upper, "lower": lower},
        contacts=(
            sw.Contact(between=("upper.bottom", "lower.top"), name="pair", friction=sw.Coulomb(mu=MU), timing=rule),
        ),
    )
    steps = list(sw.march(scene, until=2e-3, step=1e-4))
    for s in steps:
        assert s.ledger.momentum[:2] == pytest.approx([10.0, -10.0], rel=1e-10)
    assert lost(steps).min() >= -1e-12


@pytest.mark.parametrize("rule", RULES, ids=str)
def test_a_march_goes_on_from_a_state_bit_by_bit(rule):
    step, scene = 2.0**-6, sliding(rule, dim=3, speed=0.5)
    whole = list(sw.march(scene, until=12.0 * step, step=step))
    rest = list(sw.march(scene, until=12.0 * step, step=step, state=whole[5].after))
    for name in ("displacement", "velocity"):
        assert np.array_equal(getattr(rest[-1].after, name)["block"], getattr(whole[-1].after, name)["block"])
    for name in ("traction", "sliding", "slip"):
        assert np.array_equal(getattr(rest[-1].after, name)["floor"], getattr(whole[-1].after, name)["floor"])
