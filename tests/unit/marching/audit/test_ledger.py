"""The audit of a slab, and what a step tells."""

import numpy as np
import pytest

from softway.bodies.internal_force.slab_average import EnergyMomentum
from softway.bodies.prescribed_motion import Translation
from softway.bodies.setup.initial_fields import Affine, Uniform
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Fixed, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.laws.friction import Coulomb
from softway.marching.audit.ledger import initial_ledger
from softway.marching.march import march
from softway.marching.start.initial_state import initial_state
from softway.meshes.generators.shapes import box, rectangle
from softway.model.build import build
from softway.model.scene import Scene, StaticStart
from softway.obstacles.half_space import HalfSpace

RULES = [Energy(), Impulse(), Paper()]
rules = pytest.mark.parametrize("rule", RULES, ids=lambda r: type(r).__name__)


def test_the_opening_entry(shop) -> None:
    stretched = Affine(gradient=0.1)
    solid = shop.bar(v=2.0, displacement=stretched)
    ledger = initial_ledger(*(lambda m: (m, initial_state(m)))(build(Scene(bodies={"body": solid}))))
    assert ledger.energy_kinetic == pytest.approx(2.0)
    assert ledger.energy_strain == pytest.approx(0.005)
    assert ledger.momentum == pytest.approx([2.0, 0.0, 0.0])
    assert (ledger.work_external, ledger.dissipation, ledger.energy_error) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_spin_of_a_thrown_block_is_its_mass_times_place_cross_velocity(shop, dim: int) -> None:
    """It flies as a whole, so that its momentum acts at its centre; counter-clockwise is positive."""
    velocity = (0.3, -0.2, 0.5)[:dim]
    origin, size = (2.0, 1.0, -0.5)[:dim], (1.0, 2.0, 3.0)[:dim]
    mesh = rectangle(size, (2, 3), origin=origin) if dim == 2 else box(size, (1, 2, 2), origin=origin)
    solid = shop.block(velocity, mesh=mesh, place=Placement(), density=0.7)
    centre, mass = np.zeros(3), 0.7 * np.prod(size)
    centre[:dim] = np.array(origin) + 0.5 * np.array(size)
    momentum = mass * np.array([*velocity, 0.0][:3])
    for step in march(Scene(bodies={"body": solid}), until=0.4, step=0.1):
        assert step.ledger.momentum == pytest.approx(momentum, abs=1e-13)
        assert step.ledger.spin == pytest.approx(np.cross(centre, momentum), abs=1e-12)


def test_the_spin_of_a_wheel_is_its_moment_of_inertia_times_its_rate(shop) -> None:
    """About its own centre, counter-clockwise; m (a^2 + b^2) / 12 for a rectangle."""
    turning = Affine(gradient=((0.0, -0.01), (0.01, 0.0)))
    mesh = rectangle((1.0, 2.0), (3, 3), origin=(-0.5, -1.0))
    solid = shop.block(mesh=mesh, place=Placement(), velocity=turning, force=EnergyMomentum())
    (step,) = march(Scene(bodies={"body": solid}), until=0.1, step=0.1)
    assert step.ledger.spin == pytest.approx([0.0, 0.0, 0.01 * 2.0 * (1.0 + 4.0) / 12.0], abs=1e-12)


def test_work_of_loads_is_accumulated(shop) -> None:
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"),))
    motion = shop.move(solid, loads=(Traction(on="body.right", value=0.1),), until=3.0)
    for s in motion.steps:
        assert s.ledger.work_external == pytest.approx(0.1 * s.after.displacement["body"][-1, 0], abs=1e-15)
    assert motion.energy_error <= 1e-12


def test_the_ledger_of_a_continued_march_counts_from_its_start(shop) -> None:
    model = shop.move(shop.block(), shop.floor, until=0.1).model
    whole = list(march(model, until=1.0, step=0.05))
    rest = list(march(model, until=1.0, step=0.05, state=whole[9].after))
    last, first = rest[-1].ledger, whole[9].ledger
    assert last.energy_kinetic + last.energy_strain == pytest.approx(
        first.energy_kinetic + first.energy_strain, rel=1e-11
    )
    assert abs(last.energy_error) <= 1e-13


@rules
def test_steps_follow_each_other_without_a_gap(shop, rule: ImpactRule) -> None:
    motion = shop.move(shop.block(), shop.floor, timing=rule, until=1.0, step=0.3)
    assert motion.steps[0].slab.start == 0.0
    assert motion.last.slab.end == 1.0
    for a, b in zip(motion.steps, motion.steps[1:], strict=False):
        assert a.after is b.before
        assert a.slab.end == b.slab.start == b.before.time
    assert len({round(s.slab.span, 12) for s in motion.steps}) == 1


@rules
def test_events_lie_in_their_slab_and_on_the_obstacle(shop, rule: ImpactRule) -> None:
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
def test_an_event_names_the_node_in_its_body(shop, rule: ImpactRule) -> None:
    """The second body of the scene hits the first one, which rests on its right."""
    bodies = {"struck": shop.bar(3, 0.0, place=Placement(translation=(1.1,))), "thrown": shop.bar(4, 1.0)}
    contact = Contact(between=("thrown.right", "struck.left"), timing=rule)
    steps = march(Scene(bodies=bodies, contacts=(contact,)), until=0.2, step=0.05)
    (event,) = (e for s in steps for e in s.events)
    assert (event.kind, event.contact, event.node) == ("touch", "thrown.right-struck.left", 4)
    assert event.position == pytest.approx([1.1], abs=1e-12)


@rules
def test_an_event_lies_on_a_tool_where_that_is_at_its_instant(shop, rule: ImpactRule) -> None:
    wall = Tool(shape=HalfSpace(point=1.1, normal=-1.0), motion=Translation(velocity=(-0.5,)))
    motion = shop.move(shop.bar(v=0.3), {"wall": wall}, timing=rule, tag="right", until=0.3, step=0.06)
    (event,) = motion.events
    assert event.time == pytest.approx(0.1 / 0.8, abs=1e-9)
    assert event.position == pytest.approx([1.1 - 0.5 * event.time], abs=1e-12)


@rules
def test_closed_nodes_are_counted_and_pushed(shop, rule: ImpactRule) -> None:
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


def test_the_tangential_force_is_the_resultant_of_those_of_the_nodes(shop) -> None:
    """A block that is pressed flat rubs outward on both sides: its two halves pull at the floor against each other."""
    solid, floor = shop.block((0.0, -0.1), height=0.0), shop.plane((0.0, 0.0), (0.0, 1.0))
    contact = Contact(between=("body.bottom", "floor"), name="floor", friction=Coulomb(mu=0.2))
    steps = list(march(Scene(bodies={"body": solid, "floor": floor}, contacts=(contact,)), until=0.5, step=0.05))
    rubbed = max(float(np.abs(s.after.traction["floor"]).sum()) for s in steps)
    assert rubbed > 1e-4
    assert max(s.ledger.contacts["floor"].force_t for s in steps) < 1e-9 * rubbed


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
def test_supports_far_from_the_contact_balance_momentum(shop, rule: ImpactRule) -> None:
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
