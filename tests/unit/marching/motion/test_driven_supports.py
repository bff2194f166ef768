"""Bodies that supports move."""

import numpy as np
import pytest

from softway.bodies.inertia.inertia_scaling import Full, Off
from softway.bodies.inertia.mass_matrix import Consistent, Lumped
from softway.bodies.internal_force.slab_average import DiscreteGradient, Weighted
from softway.bodies.prescribed_motion import Sliding
from softway.bodies.setup.loads import Gravity
from softway.bodies.setup.motion_laws import (
    Haversine,
    MotionLaw,
    RatePolyline,
    Sine,
    SmoothSteps,
    Spline,
    value_and_rate,
)
from softway.bodies.solid import Driven, Fixed, Guided, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.marching.march import march
from softway.marching.state.step_control import StepControl
from softway.model.scene import Scene
from softway.model.time_weight import Momentum
from softway.obstacles.half_space import HalfSpace
from softway.solve.methods.central_difference import Explicit

pytestmark = pytest.mark.slow

RULES = [Energy(), Impulse(), Paper()]
rules = pytest.mark.parametrize("rule", RULES, ids=lambda r: type(r).__name__)
RAMP = Driven(on="right", velocity=(0.0, 0.2, 0.0), times=(0.0, 0.5, 1.0))
SLOW = 0.05


def closes(motion, of: float = 1.0) -> None:
    """Kinetic and stored energy are the work of the supports, from a start at rest and unstrained."""
    assert motion.energy_error <= 1e-12 * of
    last = motion.last.ledger
    assert last.energy_kinetic + last.energy_strain == pytest.approx(
        motion.start_energy + last.work_external - last.dissipation, rel=1e-11 * of
    )
    assert motion.momentum_error <= 1e-11


@rules
@pytest.mark.parametrize("tag", ["right", "surface"])
def test_a_bar_that_is_pulled(shop, rule: ImpactRule, tag: str) -> None:
    """One end held, the other drawn at constant velocity, with contact nodes there that touch nothing."""
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"), Driven(on="right", velocity=SLOW)))
    motion = shop.move(solid, {"wall": shop.plane(2.0, -1.0)}, timing=rule, tag=tag, until=3.0)
    closes(motion)
    assert motion.start_energy == pytest.approx(0.0 if isinstance(rule, Energy) else 0.5 * SLOW**2 / 12.0)
    for s in motion.steps:
        assert s.after.displacement["body"][-1, 0] == pytest.approx(SLOW * s.slab.end, abs=1e-15)
        assert s.after.displacement["body"][0, 0] == 0.0
    assert motion.last.ledger.work_external > 0.5 * (3.0 * SLOW) ** 2, "the static work, and waves"


@rules
def test_pulled_slowly_the_work_is_the_static_one(shop, rule: ImpactRule) -> None:
    """The velocity of the end rises and falls smoothly over 20 transits: waves keep 1e-3 of the energy."""
    table = tuple(0.01 * np.sin(np.pi * np.linspace(0.0, 1.0, 41)) ** 2)
    end = Driven(on="right", velocity=table, times=tuple(np.linspace(0.0, 20.0, 41)))
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"), end))
    motion = shop.move(solid, {"wall": shop.plane(2.0, -1.0)}, timing=rule, tag="right", until=20.0, step=0.1)
    closes(motion)
    stretch = motion.last.after.displacement["body"][-1, 0]
    assert stretch == pytest.approx(0.1, rel=1e-3)
    assert motion.last.ledger.work_external == pytest.approx(0.5 * stretch**2, rel=1e-3)
    assert motion.last.reactions["body"][-1, 0] == pytest.approx(stretch, rel=1e-2)
    assert motion.last.reactions["body"][0, 0] == pytest.approx(-stretch, rel=1e-2)


@rules
def test_the_table_is_followed_exactly(shop, rule: ImpactRule) -> None:
    """Velocities linear in a slab are integrated without error."""
    solid = shop.bar(v=0.0, supports=(RAMP,))
    motion = shop.move(solid, {"wall": shop.plane(2.0, -1.0)}, timing=rule, tag="right", until=1.0, step=0.05)
    at = [s.after.displacement["body"][-1, 0] for s in motion.steps]
    t = np.array([s.slab.end for s in motion.steps])
    np.testing.assert_allclose(at, np.where(t <= 0.5, 0.2 * t**2, 0.1 - 0.2 * (1.0 - t) ** 2), atol=1e-15)
    closes(motion)


BENT = Driven(on="left", velocity=(0.0, 1.0, 0.0, 0.3), times=(0.0, 0.5, 1.0, 1.5))


@pytest.mark.few(16)
@pytest.mark.parametrize("slabs", [1, 3, 7])
@pytest.mark.parametrize("inertia", [Full(), Off()], ids=lambda i: type(i).__name__)
@pytest.mark.parametrize("tag", ["left", "right"])
@rules
def test_bends_of_the_table_inside_of_slabs(shop, rule: ImpactRule, tag: str, inertia: Full | Off, slabs: int) -> None:
    """The displacement is the integral of the velocity, the velocity its value, and the ledger closes."""
    if not rule.massless and not inertia.factor:
        return  # refused: there are no impacts without inertia
    held = () if inertia.factor else (Fixed(on="right"),)
    solid = shop.bar(v=0.0, supports=(BENT, *held))
    bodies = {"body": solid, "wall": shop.plane(20.0, -1.0) if tag == "right" else shop.plane(-20.0, 1.0)}
    contact = Contact(between=(f"body.{tag}", "wall"), timing=rule)
    scene = Scene(bodies=bodies, contacts=(contact,), inertia=inertia)
    steps = list(march(scene, until=1.5, step=1.5 / slabs, control=StepControl(knots=False)))
    assert len(steps) == slabs
    for s in steps:
        t = s.slab.end
        moved = t**2 if t <= 0.5 else 0.5 - (1.0 - t) ** 2 if t <= 1.0 else 0.5 + 0.3 * (t - 1.0) ** 2
        assert s.after.displacement["body"][0, 0] == pytest.approx(moved, abs=1e-15)
        assert s.after.velocity["body"][0, 0] == pytest.approx(BENT.at(t), abs=1e-15)
        assert s.ledger.energy_error == pytest.approx(0.0, abs=1e-14)
        assert s.certificate.momentum_error <= 1e-14


TRAVELS = [
    Spline(times=(0.2, 0.7, 1.4), points=(0.0, 0.5, 0.3)),
    SmoothSteps(times=(0.0, 0.5, 1.5), points=(0.1, 0.4, -0.2)),
    Sine(amplitude=0.3, frequency=0.9, phase=0.5),
    Haversine(height=0.4, duration=0.9, start=0.3),
    RatePolyline(times=(0.0, 0.5, 1.0, 1.5), rates=(0.0, 1.0, 0.0, 0.3)),
]


@pytest.mark.few(40)
@pytest.mark.parametrize("slabs", [1, 3, 20])
@pytest.mark.parametrize("inertia", [Full(), Off()], ids=lambda i: type(i).__name__)
@pytest.mark.parametrize("tag", ["left", "right"])
@pytest.mark.parametrize("travel", TRAVELS, ids=lambda t: type(t).__name__)
@rules
def test_a_smooth_travel(shop, rule: ImpactRule, travel: MotionLaw, tag: str, inertia: Full | Off, slabs: int) -> None:
    """Displacement and velocity at the ends of slabs are those of the law, and the ledger closes."""
    if not rule.massless and not inertia.factor:
        return  # refused: there are no impacts without inertia
    held = () if inertia.factor else (Fixed(on="right"),)
    solid = shop.bar(v=0.0, supports=(Guided(on="left", travel=travel), *held))
    bodies = {"body": solid, "wall": shop.plane(20.0, -1.0) if tag == "right" else shop.plane(-20.0, 1.0)}
    contact = Contact(between=(f"body.{tag}", "wall"), timing=rule)
    scene = Scene(bodies=bodies, contacts=(contact,), inertia=inertia)
    steps = list(march(scene, until=1.5, step=1.5 / slabs, control=StepControl(knots=False)))
    assert len(steps) == slabs
    for s in steps:
        value, rate = value_and_rate(travel.pieces, s.slab.end)
        moved = value - value_and_rate(travel.pieces, 0.0)[0]
        assert s.after.displacement["body"][0, 0] == pytest.approx(moved, abs=1e-15)
        assert s.after.velocity["body"][0, 0] == pytest.approx(rate, abs=1e-15)
        assert s.ledger.energy_error == pytest.approx(0.0, abs=1e-14)
        assert s.certificate.momentum_error <= 1e-14


UP_AND_DOWN = RatePolyline(times=(0.0, 0.5, 1.0), rates=(0.0, 1.0, 0.0))


@pytest.mark.few(8)
@pytest.mark.parametrize("slabs", [1, 3, 20])
@pytest.mark.parametrize("travel", [UP_AND_DOWN, *TRAVELS], ids=lambda t: type(t).__name__)
def test_a_tool_follows_its_law_exactly(shop, travel: MotionLaw, slabs: int) -> None:
    """The end of a bar that it compresses is where the law says, and its work is what the bar stores."""
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"),))
    ram = Tool(shape=HalfSpace(point=0.4, normal=-1.0), motion=Sliding(direction=(1.0,), travel=travel))
    contact = Contact(between=("body.right", "ram"), start="fit")
    scene = Scene(bodies={"body": solid, "ram": ram}, contacts=(contact,), inertia=Off())
    start = value_and_rate(travel.pieces, 0.0)[0]
    steps = list(march(scene, until=1.5, step=1.5 / slabs))
    assert len(steps) >= slabs, "more where the tool moves by more than the mesh allows"
    for s in steps:
        shortened = 0.6 - (value_and_rate(travel.pieces, s.slab.end)[0] - start)
        assert s.after.displacement["body"][-1, 0] == pytest.approx(-shortened, abs=1e-14)
        assert s.ledger.work_external == pytest.approx(0.5 * (shortened**2 - 0.6**2), abs=1e-13)


def test_the_integral_of_a_velocity_up_and_down_is_a_half(shop) -> None:
    """In three slabs whose ends are not its knots, by a support, a tool and a table of the support."""
    for support in (
        Guided(on="left", travel=UP_AND_DOWN),
        Driven(on="left", velocity=(0.0, 1.0, 0.0), times=(0.0, 0.5, 1.0)),
    ):
        scene = Scene(bodies={"body": shop.bar(v=0.0, supports=(support,))})
        steps = list(march(scene, until=1.0, step=1.0 / 3.0, control=StepControl(knots=False)))
        assert len(steps) == 3 and steps[-1].after.displacement["body"][0, 0] == pytest.approx(0.5, abs=1e-15)
    assert Sliding(direction=(1.0,), travel=UP_AND_DOWN).at(1.0).shift[0] == pytest.approx(0.5, abs=1e-15)


@rules
def test_a_smooth_press(shop, rule: ImpactRule) -> None:
    """A tool pressed against a bar, and a bar pressed against a wall: the work is what they store and do."""
    law = SmoothSteps(times=(0.0, 1.5), points=(0.0, 0.2))
    ram = Tool(shape=HalfSpace(point=1.05, normal=-1.0), motion=Sliding(direction=(-1.0,), travel=law))
    held = shop.move(shop.bar(v=0.0, supports=(Fixed(on="left"),)), {"wall": ram}, timing=rule, tag="right", until=1.5)
    assert held.impulse > 0.0 and held.momentum_error <= 1e-11 and held.least_gap >= -1e-15
    if isinstance(rule, Energy):
        closes(held)
        pushed = shop.bar(v=0.0, supports=(Guided(on="left", travel=law),))
        wall = shop.move(pushed, {"wall": shop.plane(1.05, -1.0)}, timing=rule, tag="right", until=1.5)
        closes(wall)
        assert wall.impulse > 0.0


@pytest.mark.parametrize("mass", [Consistent(), Lumped()], ids=lambda m: type(m).__name__)
def test_a_bar_that_is_set_in_motion_by_central_differences(shop, mass: Consistent | Lumped) -> None:
    """Free nodes take their share of a consistent mass: the momentum balance closes, and the energy returns."""
    found = []
    for step in (0.05, 0.025):
        solid = shop.bar(v=0.0, supports=(RAMP,), mass=mass)
        motion = shop.move(solid, {"wall": shop.plane(20.0, -1.0)}, tag="left", until=1.0, step=step, method=Explicit())
        assert motion.momentum_error <= 1e-14
        assert motion.last.after.displacement["body"][-1, 0] == pytest.approx(0.1, abs=1e-15)
        found.append(motion.energy_error)
    assert found[1] < found[0] / 3.0, "second order"


@pytest.mark.parametrize(
    ("rule", "options"), [(r, {}) for r in RULES] + [(r, {"weight": Momentum()}) for r in RULES[1:]], ids=str
)
def test_a_body_that_is_moved_as_a_whole(shop, rule: ImpactRule, options: dict[str, object]) -> None:
    """It has the velocity of its support already: no force, no work."""
    solid = shop.bar(v=SLOW, supports=(Driven(on="left", velocity=SLOW),))
    motion = shop.move(solid, {"wall": shop.plane(2.0, -1.0)}, timing=rule, tag="surface", until=1.0, **options)
    for s in motion.steps:
        np.testing.assert_allclose(s.after.displacement["body"], SLOW * s.slab.end, atol=1e-14)
        np.testing.assert_allclose(s.after.velocity["body"], SLOW, atol=1e-14)
    assert motion.last.ledger.work_external == pytest.approx(0.0, abs=1e-14)


@pytest.mark.few(3)
@rules
@pytest.mark.parametrize("force", [Weighted(), DiscreteGradient()], ids=lambda f: type(f).__name__)
def test_a_pull_in_another_frame(shop, rule: ImpactRule, force: object) -> None:
    """One end drawn to the right, or the other to the left: the same deformation, and the same error of the ledger."""
    ends = Driven(on="left", velocity=-SLOW), Driven(on="right", velocity=SLOW)
    still = Fixed(on="right"), Fixed(on="left")
    wall = {"wall": shop.plane(2.0, -1.0)}
    found = [
        shop.move(
            shop.bar(v=v, supports=pair, force=force, material=shop.neo), wall, timing=rule, tag="right", until=2.0,
            control=StepControl(scalar=1.0),
        )
        for v, pair in ((-SLOW, (ends[0], still[0])), (0.0, (still[1], ends[1])))
    ]  # fmt: skip
    for a, b in zip(found[0].steps, found[1].steps, strict=True):
        drift = SLOW * b.slab.end
        np.testing.assert_allclose(a.after.displacement["body"] + drift, b.after.displacement["body"], atol=1e-10)
        np.testing.assert_allclose(a.reactions["body"], b.reactions["body"], atol=1e-9)
    if isinstance(rule, Energy):
        for motion in found:
            closes(motion, 10.0)


@rules
def test_a_bar_that_is_pushed_against_a_wall(shop, rule: ImpactRule) -> None:
    solid = shop.bar(v=0.0, supports=(Driven(on="left", velocity=SLOW),))
    errors = []
    for h in (0.08, 0.01):
        motion = shop.move(solid, {"wall": shop.plane(1.023, -1.0)}, timing=rule, tag="right", until=2.0, step=h)
        errors.append(motion.energy_error)
        assert motion.least_gap >= -1e-15
        assert motion.momentum_error <= 1e-11
        assert motion.impulse > 0.0
        assert motion.last.after.displacement["body"][0, 0] == pytest.approx(SLOW * 2.0, abs=1e-15)
    if isinstance(rule, Energy):
        assert max(errors) <= 1e-12
    else:
        assert errors[1] < errors[0] / 4.0, "first order, but for the place of the touch in its slab"


def test_contact_nodes_that_a_support_moves_along_the_wall(shop) -> None:
    """The bottom lies on the floor, is drawn along it, and carries the weight: its supports move nodes in contact."""
    drawn = Driven(on="bottom", components="x", velocity=SLOW)
    solid = shop.block((0.0, 0.0), height=0.0, supports=(drawn,))
    loads = (Gravity(acceleration=(0.0, -0.02)),)
    motion = shop.move(solid, shop.floor, loads=loads, until=3.0)
    closes(motion, 10.0)
    assert motion.impulse > 0.0
    bottom = motion.model.parts[0].mesh.nodes("bottom")
    np.testing.assert_allclose(motion.last.after.displacement["body"][bottom, 0], 3.0 * SLOW, atol=1e-14)


def test_a_press(shop) -> None:
    """A block driven from above against the floor and back: the work is what it stores, and all of it comes back."""
    table = Driven(on="top", velocity=(-0.1, -0.1, 0.1, 0.1), times=(0.0, 1.0, 1.2, 3.0))
    solid = shop.block((0.0, -0.1), height=0.02, supports=(table,))
    motion = shop.move(solid, shop.floor, tag="surface", until=3.0)
    assert motion.energy_error <= 1e-12
    assert motion.momentum_error <= 1e-11
    assert motion.least_gap >= -1e-15
    assert motion.last.ledger.contacts["body.surface-floor"].count == 0
    assert motion.impulse > 0.0


@rules
def test_a_march_with_a_driven_support_can_be_continued(shop, rule: ImpactRule) -> None:
    solid = shop.bar(v=0.0, supports=(RAMP,))
    wall = {"wall": shop.plane(-0.01, 1.0)}
    whole = shop.move(solid, wall, timing=rule, tag="left", until=1.0)
    rest = shop.move(solid, wall, timing=rule, tag="left", until=1.0, state=whole.steps[7].after)
    assert shop.distance(whole, rest) <= 1e-11
