"""Bodies at rest, nearly at rest, and resting on the floor for many slabs."""

from dataclasses import replace

import numpy as np
import pytest

from softway.bodies.setup.loads import Gravity
from softway.bodies.solid import Fixed
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.marching.march import march
from softway.marching.start.initial_state import initial_state
from softway.marching.state.model_state import split_states
from softway.model.build import build
from softway.model.scene import Scene, StaticStart
from softway.model.time_weight import EndPeaks

RULES = [Energy(), Energy(located=True), Impulse(), Paper()]


def name(rule: ImpactRule) -> str:
    return "located" if rule == Energy(located=True) else type(rule).__name__


rules = pytest.mark.parametrize("rule", RULES, ids=name)
PULL = (Gravity(acceleration=0.1),)


@rules
def test_a_body_without_load_and_velocity_stays(shop, rule: ImpactRule) -> None:
    motion = shop.move(shop.block((0.0, 0.0), height=0.0, material=shop.linear), shop.floor, timing=rule)
    assert not motion.last.after.displacement["body"].any()
    assert not motion.events
    assert all(s.report.iterations == 1 for s in motion.steps)


def pressed(shop, rule: ImpactRule, law: object) -> Scene:
    """A bar held on the left, pulled against a wall, in static equilibrium."""
    solid = shop.bar(supports=(Fixed(on="left"),), v=0.0, material=law)
    bodies = {"body": solid, "wall": shop.plane(1.0, -1.0)}
    contact = Contact(between=("body.right", "wall"), timing=rule)
    return Scene(bodies=bodies, contacts=(contact,), loads=PULL, start=StaticStart())


@pytest.mark.parametrize(
    ("rule", "law"),
    [(r, law) for r in RULES for law in ("linear", "neo") if law == "linear" or r != Energy(located=True)],
    ids=str,
)
def test_a_loaded_body_in_equilibrium_stays(shop, rule: ImpactRule, law: str) -> None:
    """It is pressed on the wall with half its weight."""
    for s in march(pressed(shop, rule, getattr(shop, law)), until=1.0, step=0.1):
        assert not s.report.rejections, "the first slab is enough to see it"
        assert s.slab.span == pytest.approx(0.1)
        assert np.abs(s.after.velocity["body"]).max() <= 1e-14
        assert s.ledger.contacts["body.right-wall"].force_n == pytest.approx(0.05, rel=0.1)
        assert not s.events


def test_a_hanging_body_in_equilibrium_stays(shop) -> None:
    """No contact at all: a bar that hangs from its support."""
    solid = shop.bar(supports=(Fixed(on="left"),), v=0.0)
    for s in march(Scene(bodies={"body": solid}, loads=PULL, start=StaticStart()), until=1.0, step=0.1):
        assert not s.report.rejections
        assert s.reactions["body"][0, 0] == pytest.approx(-0.1)


def test_a_motion_that_is_about_to_die_out_goes_on(shop) -> None:
    """Velocities of 1e-9 about a deformed equilibrium, as damping by theta = 1 leaves them after a while."""
    model = build(pressed(shop, Impulse(), shop.linear))
    at = initial_state(model)
    v = 1e-9 * np.array([[0.0], [1.0], [-1.0], [1.0], [0.0]])
    state = split_states(model, replace(at, start=replace(at.start, velocity=v)))
    for s in march(model, until=1.0, step=0.1, state=state, weight=EndPeaks(theta=1.0)):
        assert not s.report.rejections


@pytest.mark.few(2)
@pytest.mark.parametrize("rule", RULES, ids=name)
def test_a_bar_that_sinks_into_its_weight(shop, rule: ImpactRule) -> None:
    """From rest on the floor under gravity: it vibrates about u = -g (x - x^2/2) / c^2 and never lets go."""
    solid = shop.bar(v=0.0)
    loads = (Gravity(acceleration=-0.01),)
    motion = shop.move(
        solid, {"floor": shop.plane(0.0, 1.0)}, timing=rule, tag="left", loads=loads, until=40.0, step=0.1
    )
    assert [e.kind for e in motion.events] == ["touch"]
    assert motion.energy_error <= 1e-11
    assert all(abs(s.after.displacement["body"][0, 0]) <= 1e-15 for s in motion.steps), "it does not creep"
    top = np.array([s.after.displacement["body"][-1, 0] for s in motion.steps])
    force = np.array([s.ledger.contacts["body.left-floor"].force_n for s in motion.steps])
    assert top.min() >= -0.0106, "twice the static value of -0.005, and the waves of four cells"
    assert top.max() <= 0.0006
    early, late = top[:200], top[200:]
    assert late.mean() == pytest.approx(early.mean(), rel=0.02)
    assert np.ptp(late) == pytest.approx(np.ptp(early), rel=0.05)
    assert top.mean() == pytest.approx(-0.005, rel=0.02)
    assert force.mean() == pytest.approx(0.01, rel=0.02)
    pressure = np.array([s.after.pressure["body.left-floor"][0] for s in motion.steps])
    np.testing.assert_allclose(0.5 * (pressure[1:] + pressure[:-1]), force[1:], atol=1e-15)


@pytest.mark.parametrize("rule", [Energy(), Impulse(), Paper()], ids=name)
def test_a_block_that_stands_on_the_floor(shop, rule: ImpactRule) -> None:
    loads = (Gravity(acceleration=(0.0, -0.01)),)
    solid = shop.block((0.0, 0.0), height=0.0, cells=2)
    motion = shop.move(solid, shop.floor, timing=rule, loads=loads, until=20.0, step=0.2)
    assert motion.energy_error <= (1e-11 if rule == Energy() else 2e-2)
    bottom = motion.model.parts[0].mesh.nodes("bottom")
    for s in motion.steps:
        u = s.after.displacement["body"]
        assert np.abs(u[bottom, 1]).max() <= 1e-15
        assert abs(u[:, 0].sum()) <= 1e-12, "it does not wander"
    assert motion.momentum_error <= 1e-11
    assert [e.kind for e in motion.events] == ["touch"] * 3
    assert motion.impulse == pytest.approx(0.01 * 20.0, rel=0.03)
