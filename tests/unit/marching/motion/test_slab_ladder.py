"""Slabs under a tolerance: they grow in smooth motion, and what happens stays on the lowest rung."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.cases.waves import a09_bouncing_bar as a09
from softway.apps.verify.exact import bar as waves
from softway.arrays import Array
from softway.marching.results.step import Step
from softway.marching.start.ladder import Quality, next_rung, rungs, velocity_error
from softway.marching.start.slab_tolerance import AUTO
from softway.marching.state.march_state import Settings, StepHistory
from softway.model.slab import Slab
from softway.solve.operators.operator_memory import OperatorMemory

END_PEAKS = sw.model.EndPeaks()
LONG = sw.StepControl(longest=1024.0)
GRAVITY = sw.Gravity(acceleration=-10.0)


def bar(cells: int = 20, height: float = 5.0, law: object = sw.LinearElastic(E=900.0), **given: object) -> sw.Scene:
    """A bar above a floor, lower end first."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=10.0, cells=cells, origin=height), material=law, density=1.0, **given
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=0.0, normal=1.0))
    return sw.Scene(bodies={"bar": solid, "floor": floor}, contacts=(sw.Contact(between=("bar.left", "floor")),))


OMEGA = np.sqrt(5400.0 * (1.0 - np.cos(0.1 * np.pi)) / (2.0 + np.cos(0.1 * np.pi)))
"""Frequency of the lowest mode of ten linear cells of length 1 with consistent mass."""


def vibrating() -> sw.Scene:
    """A free bar of ten cells that vibrates in its lowest mode, with the speed 1 at its ends at the start."""
    x = np.linspace(0.0, 10.0, 11)
    shape = sw.bodies.Profile(at=tuple(5.0 + x), values=tuple(np.cos(np.pi * x / 10.0)))
    return sw.Scene(bodies={"bar": replace(bar(10).bodies["bar"], velocity=shape)})


def lengths(steps: list[Step]) -> Array:
    """Slab lengths in those of the first slab."""
    spans = np.array([s.slab.span for s in steps])
    return spans / spans[0]


def test_a_falling_bar_takes_long_slabs_and_touches_at_its_instant() -> None:
    """Gravity alone: the slope does not change, so that slabs grow to the longest; the touch at t = 1 is exact."""
    scene = replace(bar(40), loads=(GRAVITY,))
    steps = list(sw.march(scene, until=2.0, tolerance=0.01))
    equal = list(sw.march(scene, until=2.0, tolerance="off"))
    touch = next(e.time for s in steps for e in s.events)
    assert abs(touch - 1.0) < 1e-12
    before = [s for s in steps if s.after.time <= 1.0]
    assert len(before) < 0.4 * sum(s.after.time <= 1.0 for s in equal)
    assert lengths(steps).max() == pytest.approx(32.0, rel=1e-9)
    energy = 500.0
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12 * energy
    assert steps[-1].report.factorisations <= 8


def test_lengths_are_powers_of_two_of_the_step_and_end_the_march() -> None:
    steps = list(sw.march(replace(bar(40), loads=(GRAVITY,)), until=2.0, tolerance=0.05))
    rung = np.log2(lengths(steps))
    assert np.abs(rung - np.round(rung)).max() < 1e-9
    assert steps[-1].after.time == 2.0  # as given
    assert len(set(np.round(rung))) == 6


def test_nothing_happens_above_the_lowest_rung() -> None:
    steps = list(sw.march(replace(bar(), loads=(GRAVITY,)), until=8.0, tolerance=0.1))
    eventful = [s for s in steps if s.events]
    assert {e.kind for s in eventful for e in s.events} == {"touch", "release"}
    assert max(s.slab.span for s in eventful) <= steps[0].slab.span * (1.0 + 1e-9)
    assert sum(lengths(steps) > 1.5) > 50


def test_slabs_do_not_grow_without_an_estimate() -> None:
    """Each rung needs three smooth slabs of its own, the lowest one more: the first slab has none before it."""
    scene = replace(bar(), loads=(GRAVITY,))
    steps = list(sw.march(scene, until=0.9, tolerance=0.01))
    assert np.round(lengths(steps)[:8]).tolist() == [1, 1, 1, 1, 2, 2, 2, 4]
    later = list(sw.march(scene, until=0.95, tolerance=0.01, state=steps[-1].march_state))
    assert lengths(later)[:3] == pytest.approx([1.0, 1.0, 1.0])


def test_without_a_tolerance_slabs_are_equal_and_keep_one_operator() -> None:
    steps = list(sw.march(replace(bar(), loads=(GRAVITY,)), until=1.5, tolerance="off"))
    assert lengths(steps) == pytest.approx(np.ones(len(steps)))
    memory = steps[-1].march_state.memory
    assert memory.room == 0 and memory.others == ()


def test_slabs_of_automatic_length_grow_by_themselves() -> None:
    """In free fall; the touch, at t = 1, is in a short slab.  A given length, ``off``, and bars keep equal slabs."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 10.0), cells=(1, 20), origin=(0.0, 5.0)),
        material=sw.LinearElastic(E=900.0, nu=0.0), density=1.0,
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact, gravity = sw.Contact(between=("block.bottom", "floor")), sw.Gravity(acceleration=(0.0, -10.0))
    scene = sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,), loads=(gravity,))
    found = list(sw.march(scene, until=1.5))
    assert lengths(found).max() > 15.0
    assert found[-1].march_state.settings.tolerance == AUTO  # as given
    h = found[0].slab.span
    assert abs(next(e.time for s in found for e in s.events) - 1.0) < 10.0 * h**2 / (8.0 * 10.0)  # a straight path
    assert max(abs(s.ledger.energy_error) for s in found) < 1e-12 * 500.0
    for given in (
        {"step": found[0].slab.span},
        {"tolerance": "off"},
        {"step": found[0].slab.span, "tolerance": "auto"},
    ):
        equal = list(sw.march(scene, until=1.5, **given))
        assert lengths(equal) == pytest.approx(np.ones(len(equal))) and len(equal) > 2 * len(found)
    grown = list(sw.march(scene, until=0.9, step=found[0].slab.span, tolerance=AUTO))
    assert lengths(grown).max() > 15.0
    on_a_line = list(sw.march(replace(bar(40), loads=(GRAVITY,)), until=0.5))
    assert lengths(on_a_line) == pytest.approx(np.ones(len(on_a_line)))


@pytest.mark.parametrize(
    "given",
    [{"method": sw.Explicit()}, {"weight": sw.model.Momentum()}],
    ids=["explicit", "momentum"],
)
def test_where_nothing_estimates_the_error_automatic_slabs_stay(given: dict[str, object]) -> None:
    """Without a word: slabs have the length that stability, or the wave, asks for."""
    steps = list(sw.march(sw.Scene(bodies={"bar": bar().bodies["bar"]}, loads=(GRAVITY,)), until=0.5, **given))
    assert steps[-1].march_state.settings.tolerance is None
    assert lengths(steps) == pytest.approx(np.ones(len(steps)))


@pytest.mark.slow
def test_automatic_slabs_are_as_accurate_as_those_of_the_wave() -> None:
    """A beam of linear cells that gravity sets swinging, against one of half the cells and half the slabs."""
    end, tips = 0.25, []
    for cells, given in ((1, {"tolerance": "off"}), (1, {}), (2, {"tolerance": "off"})):
        beam = sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 0.1), cells=(10 * cells, 2 * cells)), density=1000.0,
            material=sw.LinearElastic(E=1e7, nu=0.3), supports=(sw.Fixed(on="left"),),
        )  # fmt: skip
        scene = sw.Scene(bodies={"beam": beam}, loads=(sw.Gravity(acceleration=(0.0, -9.81)),))
        steps = list(sw.march(scene, until=end, **given))
        tip = [s.after.displacement["beam"][-1, 1] for s in steps]
        tips.append((np.interp(np.linspace(0.0, end, 200), [s.after.time for s in steps], tip), len(steps)))
    (equal, many), (found, few), (fine, _) = tips
    assert few < 0.4 * many
    assert np.linalg.norm(found - fine) < 1.05 * np.linalg.norm(equal - fine)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-3, 1e-2])
def test_a_vibration_takes_the_rung_of_its_error(tolerance: float) -> None:
    """The lowest mode of a free bar: ``(omega h)^2 |cos(omega t)| / 12``, t the time at which the slope jumps."""
    steps = list(sw.march(vibrating(), until=0.7, step=0.002, tolerance=tolerance, control=LONG))
    h = lengths(steps)
    times = np.array([s.before.time for s in steps])
    expected = (h * OMEGA * steps[0].slab.span) ** 2 * np.abs(np.cos(OMEGA * times)) / 12.0
    assert 0.5 * tolerance < expected[h > 1.5].max() < 1.05 * tolerance


def test_the_error_of_a_vibration_falls_with_the_tolerance() -> None:
    """Slabs half as long for a quarter of the tolerance: errors of the second order, a quarter."""
    errors = []
    for tolerance in (4e-3, 1e-3):
        steps = list(sw.march(vibrating(), until=0.7, step=0.001, tolerance=tolerance, control=LONG))
        moved = np.array([s.after.displacement["bar"][0, 0] for s in steps])
        exact = np.sin(OMEGA * np.array([s.after.time for s in steps])) / OMEGA
        errors.append(np.abs(moved - exact).max())
    assert 2.5 < errors[0] / errors[1] < 7.0


@pytest.mark.parametrize("before", [0.5, 1.0, 4.0])
def test_the_estimate_is_exact_for_an_acceleration_that_changes_linearly(before: float) -> None:
    """Place t^3: the mean of the chord of the velocity 3 t^2 is off by ``h^2/12`` times its second derivative, 6."""
    h = 2.0
    velocity = [3.0 * t**2 for t in (-before, 0.0, h)]
    slopes = ((velocity[1] - velocity[0]) / before, (velocity[2] - velocity[1]) / h)
    states = [
        SimpleNamespace(acceleration=np.full((1, 1), a), span=s) for a, s in zip(slopes, (before, h), strict=True)
    ]
    found = velocity_error(states[0], Slab(start=0.0, end=h, weight=END_PEAKS), states[1])
    assert found[0, 0] == pytest.approx(0.5 * (velocity[1] + velocity[2]) - h**2)


def test_a_load_that_comes_without_notice_drops_a_long_slab() -> None:
    """A push whose ramp no slab ends at: the long slab shows its error, and is taken by short ones."""
    push = sw.Traction(on="bar.right", value=90.0, ramp=sw.bodies.Ramp(times=(1.0, 1.01), factors=(0.0, 1.0)))
    scene = sw.Scene(bodies={"bar": bar().bodies["bar"]}, loads=(GRAVITY, push))
    control = sw.StepControl(knots=False)
    steps = list(sw.march(scene, until=1.5, tolerance=0.01, control=control))
    told = [s for s in steps if any("error" in r for r in s.report.rejections)]
    assert told and 0.9 < told[0].before.time < 1.01
    after = [s for s in steps if 1.02 < s.before.time < 1.1]
    assert max(s.slab.span for s in after) <= 1.01 * steps[0].slab.span


def test_long_slabs_end_at_knots() -> None:
    push = sw.Traction(on="bar.right", value=9.0, ramp=sw.bodies.Ramp(times=(1.0, 1.7), factors=(0.0, 1.0)))
    steps = list(sw.march(sw.Scene(bodies={"bar": bar().bodies["bar"]}, loads=(push,)), until=2.0, tolerance=0.05))
    ends = [s.after.time for s in steps]
    assert {1.0, 1.7, 2.0} <= set(ends)
    assert max(lengths(steps)) > 15.0


def test_bodies_that_could_pass_through_each_other_do_not_leap() -> None:
    """Above the lowest rung no node moves by more than an edge where not all that may touch are half-spaces."""
    ball = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.5, -3.0), radius=0.2))
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.5), cells=(4, 2)), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -0.2)),
    )  # fmt: skip
    scene = sw.Scene(bodies={"block": block, "ball": ball}, contacts=(sw.Contact(between=("block", "ball")),))
    steps = list(sw.march(scene, until=10.0, tolerance=0.05))
    moved = [np.abs(s.after.displacement["block"] - s.before.displacement["block"]).max() for s in steps]
    assert max(m for m, h in zip(moved, lengths(steps), strict=True) if h > 1.5) <= 0.25
    assert 1.5 < lengths(steps).max() < 9.0


def settings(**given: object) -> Settings:
    return Settings(
        **{"until": 1.0, "step": 0.1, "weight": END_PEAKS, "method": sw.FixedPoint(), "control": sw.StepControl(),
           "tolerance": 0.1, **given}
    )  # fmt: skip


@pytest.mark.parametrize(
    ("error", "flow", "leap", "smooth", "expected"),
    [
        (0.024, 0.0, 0.0, 2, (2.0, 0)),
        (0.024, 0.0, 0.0, 1, (1.0, 2)),
        (0.026, 0.0, 0.0, 2, (1.0, 0)),
        (np.inf, 0.0, 0.0, 2, (1.0, 0)),
        (0.0, 0.06, 0.0, 2, (1.0, 0)),
        (0.0, 0.0, 0.6, 2, (1.0, 0)),
    ],
)
def test_a_rung_is_climbed_after_three_smooth_slabs(
    error: float, flow: float, leap: float, smooth: int, expected: tuple[float, int]
) -> None:
    history = StepHistory(span=1.0, length=1.0, smooth=smooth)
    quality = Quality(error=error, flow=flow, leap=leap)
    assert next_rung(settings(), history, 1.0, quality, events=False) == expected
    assert next_rung(settings(), history, 1.0, quality, events=True) == (1.0, 0)


def test_the_longest_slab_is_a_power_of_two() -> None:
    assert [rungs(settings(control=sw.StepControl(longest=x))) for x in (0.5, 1.0, 3.9, 4.0, 32.0)] == [0, 0, 1, 2, 5]
    assert rungs(settings(tolerance=None)) == 0


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"tolerance": 0.0}, "above 0"),
        ({"tolerance": np.nan}, "above 0"),
        ({"tolerance": 2.0}, "above 0"),
        ({"tolerance": "on"}, "'auto' or 'off'"),
        ({"method": sw.Explicit()}, "stability limit"),
        ({"weight": sw.model.Momentum()}, "EndPeaks"),
    ],
)
def test_a_tolerance_is_refused_where_nothing_estimates_the_error(asked: dict[str, object], told: str) -> None:
    with pytest.raises(sw.InputError, match=told) as caught:
        sw.march(sw.Scene(bodies={"bar": bar().bodies["bar"]}), **{"until": 1.0, "tolerance": 0.1, **asked})
    assert caught.value.where == "time.tolerance"


def test_a_tolerance_without_inertia_is_refused() -> None:
    scene = replace(bar(supports=(sw.Fixed(on="right"),)), inertia=sw.bodies.Off())
    with pytest.raises(sw.InputError, match="without inertia"):
        sw.march(scene, until=1.0, tolerance=0.1)


def force_error(steps: list[Step], until: float) -> float:
    """Root of the mean square of the error of the force in case A09, relative to the force."""
    exact = waves.solve(a09.BAR, until)
    t = (np.arange(5000) + 0.5) * until / 5000
    of = np.searchsorted([s.after.time for s in steps[:-1]], t)
    force = np.array([s.ledger.contacts["bar.left-floor"].force_n for s in steps])[of]
    wanted = np.array([exact.force(x) for x in t.tolist()])
    return float(np.sqrt(np.sum((force - wanted) ** 2) / np.sum(wanted**2)))


@pytest.mark.slow
def test_the_bouncing_bar_of_a09_needs_fewer_slabs_for_the_same_force() -> None:
    """Two contacts with 100 cells: at most 60 % of the slabs, no greater error, 8 factors; measured 36 %."""
    scene = replace(bar(100), loads=(GRAVITY,))
    equal = list(sw.march(scene, until=5.0, tolerance="off"))
    found = list(sw.march(scene, until=5.0, tolerance=0.05))
    assert len(found) <= 0.6 * len(equal)
    assert force_error(found, 5.0) <= force_error(equal, 5.0)
    assert found[-1].report.factorisations <= 8
    assert max(abs(s.ledger.energy_error) for s in found) < 1e-12 * a09.ENERGY


def test_operators_of_other_lengths_are_kept_and_found_again() -> None:
    """The last used first, as many as there is room for; counts of the whole march go on, a worn one loses all."""
    memory = OperatorMemory(room=2, origin=object(), span=1.0, factorisations=1)  # type: ignore[arg-type]
    assert memory.serving(1.0) is memory
    for k, span in enumerate((2.0, 4.0, 8.0)):
        memory = replace(memory.serving(span), span=span, factorisations=k + 2)
    assert memory.span == 8.0 and [m.span for m in memory.others] == [4.0, 2.0]  # as given
    again = memory.serving(2.0)
    assert again.span == 2.0 and [m.span for m in again.others] == [8.0, 4.0]  # as given
    assert again.factorisations == 4
    assert memory.serving(1.0).span == 8.0  # as given
    assert memory.failed().others == () and memory.failed().serving(2.0).stale
    assert replace(memory, room=0, others=()).serving(2.0).others == ()


def test_a_body_that_lies_on_a_floor_takes_long_slabs() -> None:
    """In equilibrium from the start nothing moves: closed rows alone do not keep slabs short."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.5), cells=(4, 2)), material=sw.LinearElastic(E=1e3, nu=0.3), density=1.0
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    scene = sw.Scene(
        bodies={"block": block, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, -1.0)),), start=sw.model.StaticStart(),
    )  # fmt: skip
    steps = list(sw.march(scene, until=1.0, step=0.001, tolerance=0.05))
    assert len(steps) < 130 and lengths(steps).max() == pytest.approx(32.0)
    assert steps[-1].ledger.contacts["block.bottom-floor"].force_n == pytest.approx(0.5, rel=1e-6)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-15
