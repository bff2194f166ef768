"""How a march starts, and what is refused before it does."""

from contextlib import suppress
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from softway.bodies.inertia.inertia_scaling import Off
from softway.bodies.prescribed_motion import Table, Translation, Turning
from softway.bodies.setup.initial_fields import Affine, Uniform
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.solid import Driven, Fixed, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, Impulse, Paper
from softway.errors import InputError, NumericsError
from softway.laws.bulk.viscoelastic import Kelvin
from softway.marching.march import march
from softway.marching.start.initial_state import initial_state
from softway.marching.start.slab_length import evenly
from softway.marching.state.step_control import StepControl
from softway.meshes.generators.shapes import interval
from softway.model.build import build
from softway.model.scene import Scene, StaticStart
from softway.model.time_weight import Collocation, EndPeaks, Momentum
from softway.obstacles.half_space import HalfSpace
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton


def scene(shop, solid, tool=None, tag="bottom", timing=None, **rest) -> Scene:
    tools = {"floor": tool} if tool is not None else {}
    contacts = tuple(Contact(between=(f"body.{tag}", name), timing=timing or Energy()) for name in tools)
    return Scene(bodies={"body": solid, **tools}, contacts=contacts, **rest)


def refused(call) -> InputError:
    with pytest.raises(InputError) as error:
        call()
    assert error.value.remedy
    return error.value


def test_a_body_without_inertia_that_only_contact_holds_is_refused(shop) -> None:
    guided = shop.block(height=0.0, supports=(Fixed(on="left", components="x"),))
    error = refused(lambda: march(scene(shop, guided, shop.floor["floor"], inertia=Off()), until=1.0, step=0.1))
    assert error.where == "bodies.body.supports"
    assert "translation along y" in error.problem


def test_a_start_inside_an_obstacle_is_refused_with_the_depth(shop) -> None:
    low = scene(shop, shop.block(height=-0.25), shop.plane((0.0, 0.0), (0.0, 1.0)))
    error = refused(lambda: march(low, until=1.0, step=0.1))
    assert error.where == "contacts[0].between"
    assert "'body' starts 0.25 m inside 'floor'" in error.problem
    assert "0.25 m" in error.remedy


def test_a_start_on_an_obstacle_far_from_the_origin(shop) -> None:
    """Rounding of the coordinates is no overlap."""
    solid = shop.block(height=1000.1)
    initial_state(build(scene(shop, solid, shop.plane((0.0, 1000.1 + 1e-13), (0.0, 1.0)))))


def test_initial_displacements_count_for_the_overlap(shop) -> None:
    solid = shop.block(height=0.1, displacement=Uniform(value=(0.0, -0.2)))
    error = refused(lambda: march(scene(shop, solid, shop.plane((0.0, 0.0), (0.0, 1.0))), until=1.0, step=0.1))
    assert "0.1 m inside" in error.problem


def test_a_static_start_needs_supports(shop) -> None:
    loads = (Gravity(acceleration=(0.0, -1.0)),)
    error = refused(lambda: march(scene(shop, shop.block(), loads=loads, start=StaticStart()), until=1.0, step=0.1))
    assert error.where == "bodies.body.supports"
    assert "rotation" in error.problem


def test_a_static_start_is_an_equilibrium(shop) -> None:
    solid = shop.bar(5, v=0.0, supports=(Fixed(on="left"),))
    at = initial_state(build(scene(shop, solid, loads=(Gravity(acceleration=0.2),), start=StaticStart())))
    x = np.linspace(0.0, 1.0, 6)
    np.testing.assert_allclose(at.start.displacement[:, 0], 0.2 * (x - x**2 / 2), atol=1e-15)


def test_a_static_start_may_have_loads_of_its_own(shop) -> None:
    solid = shop.bar(5, v=0.0, supports=(Fixed(on="left"),))
    start = StaticStart(loads=(Traction(on="body.right", value=0.1),))
    plucked = scene(shop, solid, start=start)
    np.testing.assert_allclose(
        initial_state(build(plucked)).start.displacement[:, 0], 0.1 * np.linspace(0, 1, 6), atol=1e-15
    )
    motion = shop.move(solid, start=start, until=2.0, step=0.02)
    assert motion.energy_error <= 1e-12
    assert motion.last.after.displacement["body"][-1, 0] == pytest.approx(-0.1, abs=0.02), "half a period later"


def test_wrong_loads_of_the_start_are_named(shop) -> None:
    start = StaticStart(loads=(Traction(on="nobody.right", value=0.1),))
    solid = shop.bar(5, v=0.0, supports=(Fixed(on="left"),))
    assert refused(lambda: initial_state(build(scene(shop, solid, start=start)))).where.startswith("start.loads[0]")


def test_contact_nodes_of_the_energy_rule_are_relaxed(shop) -> None:
    squeezed = Affine(gradient=((0.0, 0.0), (0.0, -0.1)), origin=(0.0, 0.5))
    model = build(scene(shop, shop.block(height=0.5, displacement=squeezed), shop.plane((0.0, 0.0), (0.0, 1.0))))
    at = initial_state(model)
    light = ~model.massive
    np.testing.assert_array_equal(at.start.displacement[~light], model.displacement[~light])
    np.testing.assert_allclose(at.start.force[light], 0.0, atol=1e-14)
    assert at.start.energy.sum() < model.energy_and_force(model.displacement)[0].sum()
    assert model.rows(at.start.displacement).gap(at.start.displacement).min() >= 0.0
    assert not at.closed.any()


@pytest.mark.parametrize(("gradient", "pressed"), [(0.1, False), (-0.1, True)], ids=["stretched", "squeezed"])
def test_relaxed_nodes_stay_outside_the_obstacle(shop, gradient: float, pressed: bool) -> None:
    """About half its height the body is stretched or squeezed; relaxing moves the bottom back towards the floor."""
    along = Affine(gradient=((0.0, 0.0), (0.0, gradient)), origin=(0.0, 0.56))
    level = 0.09 if pressed else 0.0
    model = build(scene(shop, shop.block(height=0.06, displacement=along), shop.plane((0.0, level), (0.0, 1.0))))
    at = initial_state(model)
    gap = model.rows(at.start.displacement).gap(at.start.displacement)
    assert gap.min() >= -1e-15
    assert at.closed.any() == pressed
    np.testing.assert_array_equal(at.closed, at.pressure > 0.0)
    np.testing.assert_allclose(gap[at.closed], 0.0, atol=1e-15)
    pushed = model.rows(at.start.displacement).spread(at.pressure, model.shape)
    np.testing.assert_allclose((at.start.force - pushed)[~model.massive], 0.0, atol=1e-14)


@pytest.mark.parametrize("timing", [Impulse(), Paper()], ids=lambda r: type(r).__name__)
def test_a_static_start_against_an_obstacle_is_closed(shop, timing: object) -> None:
    solid = shop.bar(v=0.0, supports=(Fixed(on="left"),))
    pulled = {"loads": (Gravity(acceleration=0.1),), "start": StaticStart()}
    at = initial_state(build(scene(shop, solid, shop.plane(1.0, -1.0), "right", timing, **pulled)))
    assert at.closed.tolist() == [True]
    assert at.pressure == pytest.approx([0.05])


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"until": 0.0}, "time.end"),
        ({"until": -1.0}, "time.end"),
        ({"step": 0.0}, "time.step"),
        ({"step": -1.0}, "time.step"),
        ({"step": float("nan")}, "time.step"),
        ({"step": float("inf")}, "time.step"),
        ({"step": 0.5, "weight": Momentum()}, "time.step"),
        ({"weight": Collocation(at=(0.2,))}, "time.weight"),
    ],
    ids=str,
)
def test_wrong_times_are_refused_before_the_first_step(shop, options: dict[str, object], where: str) -> None:
    free = Scene(bodies={"body": shop.bar(8)})
    assert refused(lambda: march(free, **{"until": 1.0, "step": 0.05, **options})).where == where


def test_the_energy_rule_wants_its_weight(shop) -> None:
    falling = scene(shop, shop.block(), shop.plane((0.0, 0.0), (0.0, 1.0)))
    for weight in (Momentum(), EndPeaks(theta=0.7), Collocation()):
        error = refused(lambda w=weight: march(falling, until=1.0, step=0.01, weight=w))
        assert error.where == "time.weight"
        assert "Energy rule" in error.problem


def test_the_located_rule_wants_small_strain(shop) -> None:
    falling = scene(shop, shop.block(), shop.plane((0.0, 0.0), (0.0, 1.0)), timing=Energy(located=True))
    error = refused(lambda: march(falling, until=1.0, step=0.01))
    assert error.where == "contacts[0].timing.located"


def test_the_split_of_figure_4_wants_the_end_of_a_bar(shop) -> None:
    split = Paper(split="triangle")
    falling = scene(shop, shop.block(), shop.plane((0.0, 0.0), (0.0, 1.0)), timing=split)
    assert refused(lambda: march(falling, until=1.0, step=0.01)).where == "contacts[0].timing.split"
    inside = scene(shop, shop.bar(), shop.plane(2.0, -1.0), "all", split)
    assert "not the end of a bar" in refused(lambda: march(inside, until=1.0, step=0.01)).problem


def test_the_automatic_step(shop) -> None:
    """The crossing time of a cell over sqrt(2), and never beyond nine tenths of the stability limit."""
    free = Scene(bodies={"body": shop.bar(8)})
    (span,) = {round(s.slab.span, 12) for s in march(free, until=1.0)}
    assert span == pytest.approx(1.0 / np.ceil(8 * np.sqrt(2)))
    (short,) = {round(s.slab.span, 12) for s in march(free, until=1.0, weight=Collocation(at=(0.5,)))}
    assert short <= 0.9 * np.sqrt(2 / 3) / 8


def test_slabs_divide_the_time_evenly() -> None:
    assert evenly(1.0, 0.1) == pytest.approx(0.1)
    assert evenly(1.0, 0.3) == pytest.approx(0.25)
    assert evenly(1.0, 5.0) == 1.0


@pytest.mark.parametrize("timing", [Energy(), Impulse()], ids=lambda r: type(r).__name__)
def test_a_bar_in_the_plane_has_no_stiffness_across(shop, timing: object) -> None:
    """Massless nodes of a bar in the plane cannot be in equilibrium across it: that is told, not computed."""
    solid = shop.bar(4, mesh=interval(1.0, 4, direction=(0.0, 1.0), dim=2), velocity=Uniform(value=(0.0, -0.1)))
    falling = scene(shop, solid, shop.plane((0.0, -0.01), (0.0, 1.0)), "left", timing)
    if timing == Impulse():
        assert len(list(march(falling, until=0.5, step=0.05))) == 10
    else:
        with pytest.raises((InputError, NumericsError)):
            list(march(falling, until=0.5, step=0.05))


@pytest.mark.parametrize("cells", [2, 3])
def test_a_mesh_too_coarse_for_massless_nodes_is_refused(shop, cells: int) -> None:
    """All of the surface may touch: of two by two cells one node keeps its inertia, about which the others turn."""
    solid = shop.block(cells=cells, angle=0.3)
    falling = scene(shop, solid, shop.plane((0.0, 0.0), (0.0, 1.0)), "surface")
    if cells == 3:
        assert len(list(march(falling, until=0.5, step=0.05))) == 10
    else:
        with pytest.raises((InputError, NumericsError)):
            list(march(falling, until=0.5, step=0.05))


def test_newton_marches_too(shop) -> None:
    assert shop.move(shop.block(), shop.floor, until=0.5, method=Newton()).energy_error <= 1e-12


@pytest.mark.filterwarnings("error")
def test_a_body_thrown_too_fast_is_no_warning(shop) -> None:
    """Cells crushed within a slab make it shorter; the run goes on and the balance stays closed."""
    motion = shop.move(shop.block((0.0, -0.9), cells=4), shop.floor, until=1.0, step=0.1)
    assert any(s.report.rejections for s in motion.steps)
    assert motion.energy_error <= 1e-11
    assert motion.least_gap >= -1e-15


def test_a_snapping_corner_does_not_penetrate(shop) -> None:
    """The massless nodes of a crushed corner may lose their equilibrium; then the march stops rather than go wrong."""
    solid = shop.block((0.05, -0.21), cells=4, cell="quad9", height=0.05, angle=0.92)
    falling = scene(
        shop, solid, shop.plane((0.0, 0.0), (0.0, 1.0)), "surface", loads=(Gravity(acceleration=(0.0, -0.042)),)
    )
    with suppress(NumericsError):
        for s in march(falling, until=2.6, step=0.182):
            assert s.ledger.contacts["body.surface-floor"].min_gap >= -1e-12
            assert s.after.pressure["body.surface-floor"].min() >= 0.0


def test_a_corner_that_only_the_contact_holds_goes_on(shop) -> None:
    """Without the floor the massless nodes would give way; on it they are stable, and the slab has a solution."""
    solid = shop.block((0.0, -0.19), cells=4, cell="quad9", height=0.05, angle=0.92)
    loads = (Gravity(acceleration=(0.0, -0.038)),)
    motion = shop.move(solid, shop.floor, tag="surface", loads=loads, until=2.4, step=0.15)
    assert motion.energy_error <= 1e-11
    assert motion.momentum_error <= 1e-10
    assert motion.least_gap >= -1e-15


def test_a_start_without_equilibrium_of_the_contact_nodes_is_told(shop) -> None:
    squeezed = Affine(gradient=((0.0, 0.0), (0.0, -0.55)))
    solid = shop.block(cells=4, cell="quad9", height=0.0, displacement=squeezed)
    with pytest.raises(NumericsError):
        initial_state(build(scene(shop, solid, shop.plane((0.0, 0.0), (0.0, 1.0)), "surface")))


def test_a_state_of_another_scene_is_refused(shop) -> None:
    floor = shop.plane((0.0, 0.0), (0.0, 1.0))
    state = next(march(scene(shop, shop.block(), floor), until=1.0, step=0.1)).after
    refused(lambda: march(scene(shop, shop.block(), floor, "surface"), until=1.0, step=0.1, state=state))


@pytest.mark.parametrize("method", [Newton(limit=1, handover=False), FixedPoint(limit=1)], ids=["Newton", "FixedPoint"])
def test_a_stop_names_what_may_help(shop, method: Newton | FixedPoint) -> None:
    """One iteration is too few; who has chosen Newton alone is told of the fixed point."""
    with pytest.raises(NumericsError) as stopped:
        shop.move(shop.block((0.1, -0.2)), shop.floor, until=1.0, step=0.1, method=method)
    assert "a smaller step" in stopped.value.remedy
    assert ("FixedPoint" in stopped.value.remedy) == isinstance(method, Newton)


@pytest.mark.parametrize("share", [1.0, 1e-4])
def test_a_stop_without_inertia_advises_a_longer_step_where_slabs_are_too_short(shop, share: float) -> None:
    """A press that moves by a quarter of an edge in a usual slab; the advised step is that of the step auto."""
    press = Driven(on="top", components="y", velocity=-0.1)
    solid = shop.block((0.0, 0.0), height=0.0, supports=(press, Fixed(on="top", components="x")))
    pressed = Scene(
        bodies={"body": solid, "floor": shop.plane((0.0, 0.0), (0.0, 1.0))},
        contacts=(Contact(between=("body.bottom", "floor")),),
        inertia=Off(),
    )
    usual = next(march(pressed, until=1.0)).slab.span
    assert usual == pytest.approx(1.0 / 20.0)
    with pytest.raises(NumericsError) as stopped:
        list(march(pressed, until=1.0, step=share * usual, method=Newton(limit=1, handover=False)))
    longer = f"a longer step, such as {usual:.3g} s"
    assert ("a smaller step" in stopped.value.remedy, longer in stopped.value.remedy) == (share == 1.0, share < 1.0)


def test_the_step_without_inertia_follows_the_fastest_tool_or_support(shop) -> None:
    def slabs(speed: float, **motion: object) -> int:
        held = Driven(on="top", components="y", velocity=-speed), Fixed(on="top", components="x")
        tool = Tool(shape=HalfSpace(point=(0.0, -1.0), normal=(0.0, 1.0)), **motion)
        solid = shop.block((0.0, 0.0), supports=held)
        bodies = {"body": solid, "tool": tool}
        first = next(march(Scene(bodies=bodies, inertia=Off()), until=1.0))
        return round(1.0 / first.slab.span)

    assert slabs(0.0) == 20
    assert slabs(2.0) == 24, "a quarter of the edge of one third"
    assert slabs(1.0, motion=Translation(velocity=(3.0, 4.0))) == 60
    assert slabs(1.0, motion=Table(times=(0.0, 0.5, 2.0), displacements=((0.0, 0.0), (0.0, 1.5), (0.0, 1.5)))) == 36
    far = np.hypot(1.0, 1.02)
    assert slabs(1.0, motion=Turning(point=(0.0, 0.0), rate=4.0)) == int(np.ceil(4.0 * far * 12.0))


def test_a_state_without_history_reaches_its_displacement_in_a_slab_of_the_march(shop) -> None:
    """A stretched bar with a dashpot: it moves as from the same displacement at the start of the scene."""
    law, stretch = Kelvin(E=1.0, shear_viscosity=0.05), Affine(value=0.0, gradient=0.01)
    model = build(scene(shop, shop.bar(4, 0.0, material=law, displacement=stretch)))
    first = next(march(model, until=1.0, step=0.1))
    bare = replace(first.before, memory={})
    assert first.before.memory
    again = next(march(model, until=1.0, step=0.1, state=bare))
    np.testing.assert_allclose(again.after.displacement["body"], first.after.displacement["body"], rtol=1e-12)


def test_a_march_that_crawls_ends_with_the_reason(shop) -> None:
    """Three iterations are enough for slabs shorter than a hundredth of the step, and every other one is halved."""
    falling = scene(shop, shop.block((0.1, -0.2)), shop.plane((0.0, 0.0), (0.0, 1.0)))
    few = FixedPoint(limit=3, handover=False)
    with pytest.raises(NumericsError, match="rejections among slabs shorter than 0.01 of the step; last: ") as why:
        list(march(falling, until=1.0, step=0.5, method=few, control=StepControl(patience=30)))
    assert "a smaller step" in why.value.remedy
    steps = list(islice(march(falling, until=1.0, step=0.5, method=few), 100))
    assert len(steps) == 100 and steps[-1].march_state.step_history.recent_rejections > 30
