"""Slabs (time steps) that end at the knots of loads and prescribed motions."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies import Haversine, RatePolyline, Sine, SmoothSteps, Spline
from softway.bodies.setup.knots import knots_of_pieces, knots_of_table
from softway.marching.start.knots import slab_ends, slab_length
from softway.marching.state.march_state import Settings
from softway.mechanisms import Hinge, Mechanism, Motor, Polyline, Rigid

UP_AND_DOWN = RatePolyline(times=(0.0, 0.5, 1.0), rates=(0.0, 1.0, 0.0))
EVERY = sw.StepControl(knots=False)
OFTEN = tuple(np.linspace(0.0, 1.0, 101).tolist())


def bar(**more: object) -> sw.Solid:
    mesh = sw.meshes.Interval(length=1.0, cells=4)
    return sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0, **more)


def pushed(motion: object, *loads: sw.Traction) -> sw.Scene:
    """A bar before a tool in motion, with loads on its other end."""
    ram = sw.Tool(shape=sw.obstacles.HalfSpace(point=-0.05, normal=1.0), motion=motion)
    return sw.Scene(bodies={"bar": bar(), "ram": ram}, contacts=(sw.Contact(between=("bar.left", "ram")),), loads=loads)


def pull(times: tuple[float, ...], factors: tuple[float, ...]) -> sw.Traction:
    return sw.Traction(on="bar.right", value=0.01, ramp=sw.bodies.Ramp(times=times, factors=factors))


def ends(scene: sw.Scene, span: float, until: float = 1.0, method: object = sw.FixedPoint()) -> tuple[float, ...]:
    settings = Settings(until=until, step=span, weight=sw.model.EndPeaks(), method=method, control=sw.StepControl())
    return slab_ends(sw.build(scene), settings, span)


@pytest.mark.parametrize(
    "support",
    [
        sw.bodies.Guided(on="left", travel=UP_AND_DOWN),
        sw.Driven(on="left", velocity=(0.0, 1.0, 0.0), times=(0.0, 0.5, 1.0)),
        sw.Driven(on="left", velocity=(0.0, 1.0, 0.0), times=(0.0, 0.5, 1.0), direction=(1.0,)),
    ],
    ids=["guided", "driven", "directed"],
)
@pytest.mark.parametrize(("slabs", "count"), [(1, 2), (2, 2), (3, 4), (7, 8)])
def test_a_velocity_up_and_down_moves_by_a_half_and_slabs_end_at_its_top(
    support: object, slabs: int, count: int
) -> None:
    steps = list(sw.march(sw.Scene(bodies={"bar": bar(supports=(support,))}), until=1.0, step=1.0 / slabs))
    assert steps[-1].after.displacement["bar"][0, 0] == pytest.approx(0.5, abs=1e-15)
    assert {0.5, 1.0} <= {s.slab.end for s in steps}
    np.testing.assert_allclose([s.slab.span for s in steps], np.full(count, 1.0 / count), rtol=1e-14)


def test_knots_are_bends_of_the_rate() -> None:
    found = {
        law: knots_of_pieces(law.pieces)
        for law in (
            UP_AND_DOWN,
            Sine(amplitude=0.1, frequency=3.0),
            SmoothSteps(times=(0.1, 0.5, 1.0), points=(0.0, 2.0, 1.0)),
            Haversine(height=0.4, duration=0.5, start=0.3),
            Spline(times=(0.2, 0.7, 1.4), points=(0.0, 0.5, 0.3)),
            Spline(times=(0.2, 0.7, 1.4), points=(0.0, 0.5, 0.3), monotone=True),
            Polyline(times=(0.0, 0.5, 1.0), values=(0.0, 1.0, 2.0)),
        )
    }
    assert list(found.values()) == [(0.5, 1.0), (), (), (0.3, 0.8), (0.2, 1.4), (0.2, 0.7, 1.4), (1.0,)]
    assert knots_of_table((0.0, 1.0, 2.0), ((0.0, 1.0), (0.0, 2.0), (1.0, 3.0))) == (0.0, 1.0, 2.0)
    assert knots_of_table((), ()) == knots_of_table((1.0,), (5.0,)) == ()


def test_ends_are_knots_of_all_laws() -> None:
    """Of a tool, of loads, of motors; none of central differences, and none where nothing bends."""
    motion = sw.bodies.Table(times=(0.0, 0.3, 0.7), displacements=(0.0, 0.02, 0.1))
    scene = pushed(motion, pull((0.0, 0.45), (0.0, 1.0)))
    assert ends(scene, 0.1) == (0.3, 0.45, 0.7, 1.0)
    assert ends(scene, 0.1, method=sw.Explicit()) == ()
    assert ends(pushed(sw.bodies.Translation(velocity=0.1)), 0.1) == ()
    crank = Rigid(mass=1.0, inertia=1.0, centre=(1.0, 0.0))
    motor = Motor(joint="axle", motion=Polyline(times=(0.0, 0.6), values=(0.0, 1.0)))
    axle = Hinge(between=("ground", "crank"), at=(0.0, 0.0))
    driven = Mechanism(bodies={"crank": crank}, joints={"axle": axle}, motors={"m": motor})
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)), material=sw.LinearElastic(E=1.0), density=1.0
    )
    assert ends(sw.Scene(bodies={"s": solid}, mechanism=driven), 0.1) == (0.6, 1.0)


def test_knots_of_curves_and_slivers_are_left_to_the_integral() -> None:
    """Tables finer than half a slab are curves; knots near another law's, the start or the end leave no short slab."""
    curve = sw.bodies.Table(times=OFTEN, displacements=tuple(np.sin(OFTEN).tolist()))
    assert ends(pushed(curve), 0.1) == ()
    assert ends(pushed(curve, pull((0.0, 0.55), (0.0, 1.0))), 0.1) == (0.55, 1.0)
    bent = sw.bodies.Table(times=(0.02, 0.3, 0.97), displacements=(0.0, 0.02, 0.1))
    assert ends(pushed(bent, pull((0.0, 0.31, 0.6), (0.0, 1.0, 0.0))), 0.1) == (0.3, 0.6, 1.0)


def test_slabs_divide_the_time_to_the_next_end_evenly() -> None:
    """Also after slabs of other lengths: none is shorter than half of the proposed one."""
    scene = pushed(sw.bodies.Table(times=(0.0, 0.3, 0.7), displacements=(0.0, 0.02, 0.1)))
    begun = next(sw.march(scene, until=1.0, step=0.125)).march_state
    at = ends(scene, 0.125)
    rng = np.random.default_rng(1)
    for time in (*rng.uniform(0.0, 0.99, 200), 0.3, 0.7, 0.3 - 1e-6, 0.7 + 1e-16):
        length = 0.125 * 0.5 ** rng.integers(0, 4)
        history = replace(begun.step_history, length=length)
        now = replace(begun, state=replace(begun.state, time=float(time)), step_history=history)
        found = slab_length(at, now)
        following = min(end for end in at if end - time > 1e-3 * length)
        assert found <= length * (1.0 + 1e-12)
        assert found > 0.5 * length or found == pytest.approx(following - time)
        count = (following - time) / found
        assert count == pytest.approx(round(count), rel=1e-9)


@pytest.mark.parametrize(("control", "first"), [(sw.StepControl(), 1), (EVERY, 0)], ids=["knots", "every"])
def test_slabs_between_knots_share_an_operator(control: sw.StepControl, first: int) -> None:
    """One factor for each of the three lengths; slabs end at the knots to the last digit."""
    scene = pushed(sw.bodies.Table(times=(0.0, 0.31, 0.7), displacements=(0.0, 0.02, 0.1)))
    steps = list(sw.march(scene, until=1.0, step=0.04, control=control))
    at = {s.slab.end for s in steps}
    assert ({0.31, 0.7, 1.0} <= at) == bool(first)
    assert len(steps) == 25 + first * 1
    assert steps[-1].report.factorisations == 1 + 2 * first
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-15


def oscillation(slabs: int, control: sw.StepControl) -> float:
    """Error of the end of a bar of one cell under a load that bends; the mass of the end is a half."""
    top = 0.437
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
        mass=sw.bodies.Lumped(),
    )
    load = pull((0.0, top, 1.0), (0.0, 1.0, 0.0))
    steps = list(sw.march(sw.Scene(bodies={"bar": solid}, loads=(load,)), until=1.0, step=1.0 / slabs, control=control))
    w, exact = np.sqrt(2.0), 0.0
    for slope, since in ((1.0 / top, 0.0), (-1.0 / top - 1.0 / (1.0 - top), top)):
        s = 1.0 - since
        exact += 0.01 * slope * (s - np.sin(w * s) / w)
    return abs(float(steps[-1].after.displacement["bar"][1, 0]) - exact)


def test_a_bend_of_a_load_at_the_end_of_a_slab_costs_no_order() -> None:
    """Second order with slabs of two lengths, and smaller errors than with equal slabs."""
    errors = [oscillation(n, sw.StepControl()) for n in (10, 20, 40)]
    assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 1.8
    for n, error in zip(
        (3, 6, 10, 20, 40), [*(oscillation(n, sw.StepControl()) for n in (3, 6)), *errors], strict=True
    ):
        assert error < oscillation(n, EVERY)


def test_a_march_goes_on_from_any_slab_with_the_same_bits() -> None:
    scene = pushed(sw.bodies.Table(times=(0.0, 0.31, 0.7), displacements=(0.0, 0.02, 0.1)))
    steps = list(sw.march(scene, until=1.0, step=0.1))
    for k, step in enumerate(steps[:-1]):
        rest = list(sw.march(scene, until=1.0, step=0.1, state=step.march_state))
        assert [s.slab for s in rest] == [s.slab for s in steps[k + 1 :]]
        assert np.array_equal(rest[-1].after.displacement["bar"], steps[-1].after.displacement["bar"])
