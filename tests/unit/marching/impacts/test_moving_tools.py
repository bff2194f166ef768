"""Rigid tools that move: the answer does not depend on the frame, and their work enters the ledger."""

import numpy as np
import pytest

from softway.bodies.prescribed_motion import Table, Translation
from softway.bodies.solid import Driven, Fixed, Tool
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.errors import InputError
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Sphere
from softway.solve.methods.newton import Newton

pytestmark = pytest.mark.slow

RULES = [Energy(), Impulse(), Paper(), Paper(approach="extrapolated")]
rules = pytest.mark.parametrize("rule", RULES, ids=str)
LABEL = "body.right-wall"


def wall(point: float, velocity: float = 0.0) -> dict[str, Tool]:
    motion = {"motion": Translation(velocity=(velocity,))} if velocity else {}
    return {"wall": Tool(shape=HalfSpace(point=point, normal=-1.0), **motion)}


def same_but_for_the_frame(a, b, velocity: np.ndarray, near: float = 1e-10, predicted: float = 0.0) -> None:
    """Frame b moves with the velocity against frame a: fields, forces, instants, losses and the rest of the ledger.

    ``predicted`` is for the instants of the Energy rule, read off the first iterate of the slab and the compliance of
    its operator: frozen ones are renewed at different slabs, Newton's always.
    """
    assert len(a.steps) == len(b.steps)
    for s, t in zip(a.steps, b.steps, strict=True):
        drift = velocity * s.slab.end
        np.testing.assert_allclose(s.after.displacement["body"] - drift, t.after.displacement["body"], atol=near)
        np.testing.assert_allclose(s.after.velocity["body"] - velocity, t.after.velocity["body"], atol=near)
        for c, d in zip(s.ledger.contacts.values(), t.ledger.contacts.values(), strict=True):
            assert c.force_n == pytest.approx(d.force_n, abs=10.0 * near)
            assert c.min_gap == pytest.approx(d.min_gap, abs=near)
            assert c.count == d.count
        assert s.ledger.dissipation == pytest.approx(t.ledger.dissipation, abs=near)
        assert s.ledger.energy_error == pytest.approx(t.ledger.energy_error, abs=near)
    told = [[(e.kind, e.node) for e in m.events] for m in (a, b)]
    assert told[0] == told[1]
    for e, f in zip(a.events, b.events, strict=True):
        assert e.time == pytest.approx(f.time, abs=predicted or near)
        assert e.velocity_before == pytest.approx(f.velocity_before, abs=predicted or near)
        assert e.velocity_after == pytest.approx(f.velocity_after, abs=near)
        assert e.impulse == pytest.approx(f.impulse, abs=near)


@rules
@pytest.mark.parametrize("gap", [0.0, 0.103])
def test_a_wall_that_hits_a_bar_is_a_bar_that_hits_a_wall(shop, rule: ImpactRule, gap: float) -> None:
    options = {"timing": rule, "tag": "right", "until": 3.0}
    thrown = shop.move(shop.bar(v=1.0), wall(1.0 + gap), **options)
    struck = shop.move(shop.bar(v=0.0), wall(1.0 + gap, -1.0), **options)
    same_but_for_the_frame(thrown, struck, np.array([1.0]))
    assert {e.kind for e in struck.events} == {"touch", "release"}
    assert struck.momentum_error <= 1e-11
    last = struck.last.ledger
    if isinstance(rule, Energy):
        assert struck.energy_error <= 1e-12
        assert last.work_external == pytest.approx(last.energy_kinetic + last.energy_strain, rel=1e-12)
    assert last.work_external == pytest.approx(struck.impulse, rel=1e-11), "force times the velocity of the wall"


@pytest.mark.few(5)
@rules
@pytest.mark.parametrize("velocity", [-0.5, 0.3, 1.0])
def test_the_motion_is_the_same_in_every_inertial_frame(shop, rule: ImpactRule, velocity: float) -> None:
    options = {"timing": rule, "tag": "right", "until": 2.5, "step": 0.04}
    one = shop.move(shop.bar(v=0.6, material=shop.neo), wall(1.05), **options)
    other = shop.move(shop.bar(v=0.6 - velocity, material=shop.neo), wall(1.05, -velocity), **options)
    same_but_for_the_frame(one, other, np.array([velocity]), 1e-9, 0.01 if isinstance(rule, Energy) else 0.0)


@rules
def test_a_floor_that_rises_under_a_block(shop, rule: ImpactRule) -> None:
    solid = {v: shop.block((0.02, -v), angle=0.2) for v in (0.1, 0.0)}
    rising = {"floor": Tool(shape=shop.floor["floor"].shape, motion=Translation(velocity=(0.0, 0.1)))}
    options = {"timing": rule, "tag": "surface", "until": 1.5, "method": Newton()}
    falling, lifted = shop.move(solid[0.1], shop.floor, **options), shop.move(solid[0.0], rising, **options)
    same_but_for_the_frame(falling, lifted, np.array([0.0, -0.1]), 1e-9, 5e-4 if isinstance(rule, Energy) else 0.0)
    assert lifted.momentum_error <= 1e-10


@rules
def test_a_floor_that_slides_is_not_felt(shop, rule: ImpactRule) -> None:
    solid = shop.block((0.02, -0.1), angle=0.2)
    sliding = {"floor": Tool(shape=shop.floor["floor"].shape, motion=Translation(velocity=(0.7, 0.0)))}
    options = {"timing": rule, "tag": "surface", "until": 1.0, "method": Newton()}
    plain, moved = (shop.move(solid, floor, **options) for floor in (shop.floor, sliding))
    same_but_for_the_frame(plain, moved, np.zeros(2))
    assert moved.last.ledger.work_external == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("rule", [Energy(), Impulse()], ids=lambda r: type(r).__name__)
def test_a_ball_that_is_thrown_at_a_block(shop, rule: ImpactRule) -> None:
    solid = {v: shop.block((0.0, -v), height=0.0) for v in (0.1, 0.0)}
    shape = Sphere(centre=(0.3, -0.52), radius=0.5)
    balls = [{"ball": Tool(shape=shape, **m)} for m in ({}, {"motion": Translation(velocity=(0.0, 0.1))})]
    falling = shop.move(solid[0.1], balls[0], timing=rule, tag="surface", until=1.2)
    struck = shop.move(solid[0.0], balls[1], timing=rule, tag="surface", until=1.2)
    if isinstance(rule, Energy):
        same_but_for_the_frame(falling, struck, np.array([0.0, -0.1]), 1e-11, 1e-4)
    else:  # rows are settled when gaps are, whose rounding is the square of that of the normals
        same_but_for_the_frame(falling, struck, np.array([0.0, -0.1]), 1e-7, 1e-6)
    assert struck.impulse > 0.0
    if isinstance(rule, Energy):
        assert struck.energy_error <= 1e-11


def test_a_ram_that_stops_and_comes_back(shop) -> None:
    """Its velocity jumps between the slabs: the work is the force times its motion all the same."""
    ram = Table(times=(0.0, 0.5, 1.0, 2.0), displacements=((0.0,), (-0.1,), (-0.1,), (0.4,)))
    tool = {"wall": Tool(shape=HalfSpace(point=1.02, normal=-1.0), motion=ram)}
    motion = shop.move(shop.bar(v=0.0, supports=(Fixed(on="left"),)), tool, tag="right", until=2.0, step=0.05)
    assert motion.energy_error <= 1e-12
    assert motion.momentum_error <= 1e-11
    assert motion.least_gap >= -1e-15
    work = [0.0, *(s.ledger.work_external for s in motion.steps)]
    for s, done in zip(motion.steps, np.diff(work), strict=True):
        moved = ram.at(s.slab.end).shift[0] - ram.at(s.slab.start).shift[0]
        assert done == pytest.approx(-s.ledger.contacts[LABEL].force_n * moved, abs=1e-15)
    assert motion.last.ledger.contacts[LABEL].count == 0


def test_a_bar_squeezed_slowly_stores_the_static_energy(shop) -> None:
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"),))
    motion = shop.move(solid, wall(1.0, -0.002), tag="right", until=20.0, step=0.1)
    assert motion.energy_error <= 1e-11
    assert motion.last.ledger.work_external == pytest.approx(0.5 * 0.04**2, rel=0.05)
    assert motion.last.after.displacement["body"][-1, 0] == pytest.approx(-0.04, abs=1e-15)


def test_a_driven_bar_between_moving_walls(shop) -> None:
    """Support and tools work together; everything moves as one, and nothing is felt."""
    walls = {
        "left": Tool(shape=HalfSpace(point=0.0, normal=1.0), motion=Translation(velocity=(0.2,))),
        "right": Tool(shape=HalfSpace(point=1.0, normal=-1.0), motion=Translation(velocity=(0.2,))),
    }
    solid = shop.bar(v=0.2, supports=(Driven(on="left", velocity=0.2),))
    motion = shop.move(solid, walls, tag={"left": "left", "right": "right"}, until=1.0)
    assert motion.last.ledger.work_external == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose(motion.last.after.displacement["body"], 0.2, atol=1e-14)


def test_the_located_rule_wants_resting_tools(shop) -> None:
    with pytest.raises(InputError, match="resting half-spaces"):
        shop.move(shop.bar(), wall(1.1, -1.0), timing=Energy(located=True), tag="right")
