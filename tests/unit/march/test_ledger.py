"""The audit of a slab, and what a step tells."""

import numpy as np
import pytest

from softway.bodies.fields import Affine, Uniform
from softway.bodies.loads import Gravity, Traction
from softway.bodies.solid import Fixed
from softway.contact.timing import Energy, Impulse, Paper, Timing
from softway.march.begin import begin
from softway.march.ledger import opening
from softway.march.march import march
from softway.model import build
from softway.scene import Scene, StaticStart

RULES = [Energy(), Impulse(), Paper()]
rules = pytest.mark.parametrize("rule", RULES, ids=lambda r: type(r).__name__)


def test_the_opening_entry(shop) -> None:
    stretched = Affine(gradient=0.1)
    solid = shop.bar(v=2.0, displacement=stretched)
    ledger = opening(*(lambda m: (m, begin(m)))(build(Scene(bodies={"body": solid}))))
    assert ledger.energy_kinetic == pytest.approx(2.0)
    assert ledger.energy_strain == pytest.approx(0.005)
    assert ledger.momentum == pytest.approx([2.0, 0.0, 0.0])
    assert (ledger.work_external, ledger.dissipation, ledger.energy_error) == (0.0, 0.0, 0.0)


def test_work_of_loads_is_accumulated(shop) -> None:
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"),))
    motion = shop.move(solid, loads=(Traction(on="body.right", value=0.1),), until=3.0)
    for s in motion.steps:
        assert s.ledger.work_external == pytest.approx(0.1 * s.after.displacement["body"][-1, 0], abs=1e-15)
    assert motion.energy_error <= 1e-12


def test_a_ledger_taken_up_again_counts_from_there(shop) -> None:
    model = shop.move(shop.block(), shop.floor, until=0.1).model
    whole = list(march(model, until=1.0, step=0.05))
    rest = list(march(model, until=1.0, step=0.05, state=whole[9].after))
    last, first = rest[-1].ledger, whole[9].ledger
    assert last.energy_kinetic + last.energy_strain == pytest.approx(
        first.energy_kinetic + first.energy_strain, rel=1e-11
    )
    assert abs(last.energy_error) <= 1e-13


@rules
def test_steps_follow_each_other_without_a_gap(shop, rule: Timing) -> None:
    motion = shop.move(shop.block(), shop.floor, timing=rule, until=1.0, step=0.3)
    assert motion.steps[0].slab.start == 0.0
    assert motion.last.slab.end == 1.0
    for a, b in zip(motion.steps, motion.steps[1:], strict=False):
        assert a.after is b.before
        assert a.slab.end == b.slab.start == b.before.time
    assert len({round(s.slab.span, 12) for s in motion.steps}) == 1


@rules
def test_events_lie_in_their_slab_and_on_the_obstacle(shop, rule: Timing) -> None:
    motion = shop.move(shop.block((0.05, -0.1), angle=0.2), shop.floor, timing=rule, tag="surface", until=2.5)
    points = motion.model.parts[0].mesh.points
    kinds = []
    for s in motion.steps:
        times = [e.time for e in s.events]
        assert times == sorted(times)
        for e in s.events:
            assert s.slab.start - 1e-12 <= e.time <= s.slab.end + 1e-12
            assert e.position[1] == pytest.approx(0.0, abs=1e-14)
            ends = [points[e.node] + x.displacement["body"][e.node] for x in (s.before, s.after)]
            assert min(x[0] for x in ends) - 1e-9 <= e.position[0] <= max(x[0] for x in ends) + 1e-9
            assert e.velocity_before <= 1e-12
            assert e.velocity_after >= -1e-12
            assert e.impulse >= 0.0
            kinds.append((e.node, e.kind))
    for node in {n for n, _ in kinds}:
        mine = [k for n, k in kinds if n == node]
        assert mine == ["touch", "release"] * (len(mine) // 2) + ["touch"] * (len(mine) % 2)


@rules
def test_closed_nodes_are_counted_and_pushed(shop, rule: Timing) -> None:
    motion = shop.move(shop.block(), shop.floor, timing=rule, until=2.0)
    label = "body.bottom-floor"
    for s in motion.steps:
        closed, pressure = s.after.closed[label], s.after.pressure[label]
        assert s.ledger.contacts[label].count == closed.sum()
        assert pressure.min() >= 0.0
        assert not pressure[~closed].any()
        u = motion.model.join(s.after.displacement)
        gap = motion.model.rows(u).gap(u)
        assert np.abs(gap[closed]).max(initial=0.0) <= 1e-15
        assert s.ledger.contacts[label].min_gap == gap.min()
        assert s.ledger.contacts[label].force_t == 0.0


def test_supports_carry_the_load_in_equilibrium(shop) -> None:
    """A hanging block that starts in equilibrium and is set in slight motion."""
    solid = shop.block((0.0, 1e-6), height=0.0, supports=(Fixed(on="top"),))
    loads = (Gravity(acceleration=(0.0, -0.01)), Traction(on="body.right", value=(0.002, 0.0)))
    motion = shop.move(solid, loads=loads, start=StaticStart(), until=0.5)
    assert motion.momentum_error <= 1e-11
    for s in motion.steps:
        carried = s.reactions["body"]
        assert carried.sum(axis=0) == pytest.approx([-0.002, 0.01], abs=1e-5)
        assert not carried[motion.model.free].any()


@rules
def test_supports_far_from_the_contact_balance_momentum(shop, rule: Timing) -> None:
    solid = shop.block((0.0, -0.1), height=0.005, supports=(Fixed(on="top"),))
    motion = shop.move(solid, shop.floor, timing=rule, until=1.0)
    assert motion.momentum_error <= 1e-11
    assert motion.impulse > 0.0


def test_scalars_are_told_for_each_body(shop) -> None:
    bodies = {
        "a": shop.block((0.0, 0.1), velocity=Uniform()),
        "b": shop.block(velocity=Affine(gradient=((0.3, 0.0), (0.0, 0.2)))),
    }
    (step,) = march(Scene(bodies=bodies), until=0.1, step=0.1)
    assert step.report.scalars["a"] == 0.0
    assert step.report.scalars["b"] != 0.0
    assert step.report.passes == 1
    assert step.report.rejections == ()
