"""Central differences with contact nodes in equilibrium: exact solutions, order, contact conditions, limits."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

import softway as sw
from softway.solve.methods.central_difference import Explicit

WALL = {"wall": sw.Tool(shape=sw.obstacles.HalfSpace(point=1.25, normal=-1.0))}


def thrown(cells: int, **options: object) -> sw.Solid:
    """The bar of unit length, mass, stiffness and speed."""
    given = {
        "material": sw.LinearElastic(E=1.0),
        "velocity": sw.bodies.Uniform(value=1.0),
        "mass": sw.bodies.Lumped(),
        **options,
    }
    return sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=cells), density=1.0, **given)


def impact(cells: int, step: float | str = "auto", method: object = Explicit(), until: float = 4.0) -> list[sw.Step]:
    scene = sw.Scene(bodies={"bar": thrown(cells), **WALL}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    return list(sw.march(scene, until=until, step=step, method=method))


def test_a_mode_swings_with_the_frequency_of_central_differences() -> None:
    """A fixed-free bar in its first lumped mode: sin(w' h/2) = w h/2, at every instant, to rounding."""
    cells, h = 10, 0.05
    frequency = 2.0 * cells * np.sin(0.25 * np.pi / cells)
    bar = thrown(cells, velocity=sw.bodies.Uniform(), supports=(sw.Fixed(on="left"),))
    nodes = np.linspace(0.0, 1.0, cells + 1)
    mode = 1e-3 * np.sin(0.5 * np.pi * nodes)
    model = sw.build(sw.Scene(bodies={"bar": bar}))
    first = next(sw.march(model, until=h, step=h, method=Explicit())).before
    state = sw.State(
        time=0.0, displacement={"bar": mode[:, None]}, velocity=first.velocity, acceleration=first.acceleration,
        closed=first.closed, pressure=first.pressure,
    )  # fmt: skip
    swing = 2.0 / h * np.arcsin(0.5 * h * frequency)
    for step in sw.march(model, until=100 * h, step=h, method=Explicit(), state=state):
        u = step.after.displacement["bar"][:, 0]
        np.testing.assert_allclose(u, mode * np.cos(swing * step.after.time), atol=1e-15)


def test_the_bar_on_the_wall() -> None:
    """Touch at .25, release at 2.25, force 1 in between, the speed turned round."""
    steps = impact(100)
    events = [e for s in steps for e in s.events]
    assert [e.kind for e in events][:1] == ["touch"]
    assert events[0].time == pytest.approx(0.25, abs=1e-12)
    assert [e.time for e in events if e.kind == "release"][-1] == pytest.approx(2.25, abs=0.03)
    force = [s.ledger.contacts["bar.right-wall"].force_n for s in steps if 0.5 < s.slab.start < 2.0]
    assert np.mean(force) == pytest.approx(1.0, abs=1e-3)
    assert steps[-1].ledger.momentum[0] == pytest.approx(-1.0, abs=0.01)
    assert min(s.certificate.min_gap for s in steps) >= -1e-15
    assert min(s.certificate.min_force for s in steps) >= 0.0
    assert max(s.certificate.momentum_error for s in steps) <= 1e-13
    assert max(abs(s.ledger.energy_error) for s in steps) <= 0.01 * 0.5


def test_the_energy_swings_with_the_square_of_the_slab() -> None:
    errors = [max(abs(s.ledger.energy_error) for s in impact(20, step=h, until=2.5)) for h in (0.02, 0.01, 0.005)]
    orders = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert (orders > 1.5).all()


def test_it_tends_to_the_energy_rule() -> None:
    """The same semi-discrete equations: the difference falls with the square of the slab."""
    apart = []
    for h in (0.02, 0.01):
        ends = [impact(10, step=h, method=m, until=1.0)[-1] for m in (Explicit(), sw.FixedPoint())]
        a, b = (e.after.displacement["bar"] for e in ends)
        apart.append(np.abs(a - b).max())
    assert apart[1] < 0.35 * apart[0]


@pytest.mark.parametrize("mass", [sw.bodies.Lumped(), sw.bodies.Consistent()], ids=["lumped", "consistent"])
def test_a_block_that_lands_on_a_ball(mass: sw.bodies.Lumped | sw.bodies.Consistent) -> None:
    """Curved obstacle, large deformation, both masses: no overlap, no tension, momentum and energy kept."""
    block = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3)), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -0.1)), mass=mass,
    )  # fmt: skip
    ball = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.5, 0.5, -2.01), radius=2.0))
    scene = sw.Scene(bodies={"block": block, "ball": ball}, contacts=(sw.Contact(between=("block.bottom", "ball")),))
    steps = list(sw.march(scene, until=3.0, method=Explicit(safety=0.5)))
    assert max(s.ledger.contacts["block.bottom-ball"].count for s in steps) > 4
    assert min(s.certificate.min_gap for s in steps) >= -1e-12
    assert min(s.certificate.min_force for s in steps) >= 0.0
    assert max(s.certificate.momentum_error for s in steps) <= 1e-10
    assert max(abs(s.ledger.energy_error) for s in steps) <= 0.01 * 0.005


def test_two_bars_swap_their_velocities() -> None:
    struck = thrown(50, velocity=sw.bodies.Uniform(), place=sw.bodies.Placement(translation=1.1))
    scene = sw.Scene(
        bodies={"one": thrown(50), "other": struck}, contacts=(sw.Contact(between=("one.right", "other.left")),)
    )
    *_, last = sw.march(scene, until=3.0, method=Explicit())
    mean = {name: float(v.mean()) for name, v in last.after.velocity.items()}
    assert mean["one"] == pytest.approx(0.0, abs=0.02) and mean["other"] == pytest.approx(1.0, abs=0.02)
    assert last.ledger.momentum[0] == pytest.approx(1.0, abs=1e-12)


def test_driven_supports_follow_their_motion() -> None:
    bar = thrown(10, velocity=sw.bodies.Uniform(), supports=(sw.Driven(on="left", velocity=0.5),))
    *_, last = sw.march(sw.Scene(bodies={"bar": bar}), until=1.0, method=Explicit())
    assert last.after.displacement["bar"][0, 0] == pytest.approx(0.5, rel=1e-12)
    assert last.ledger.energy_error == pytest.approx(0.0, abs=0.01 * last.ledger.work_external)


def test_the_slab_is_a_fraction_of_the_stability_limit() -> None:
    """Lumped bars of equal cells: the limit is the time in which a wave crosses a cell."""
    free = sw.Scene(bodies={"bar": thrown(10)})
    step = next(sw.march(free, until=10.0, method=Explicit(safety=0.5)))
    assert step.slab.span == pytest.approx(10.0 / np.ceil(10.0 / 0.05), rel=1e-9)
    with pytest.raises(sw.InputError, match="beyond the stability limit"):
        sw.march(free, until=10.0, step=0.105, method=Explicit())


def test_a_load_on_the_node_in_contact_goes_into_the_wall() -> None:
    """A bar at rest at the wall, pressed there by a traction on the end that touches: nothing is deformed or moves."""
    bar = thrown(10, velocity=sw.bodies.Uniform(), place=sw.bodies.Placement(translation=0.25))
    contact, load = sw.Contact(between=("bar.right", "wall")), sw.Traction(on="bar.right", value=0.01)
    scene = sw.Scene(bodies={"bar": bar, **WALL}, contacts=(contact,), loads=(load,))
    *_, last = sw.march(scene, until=1.0, method=Explicit())
    assert last.ledger.contacts["bar.right-wall"].force_n == pytest.approx(0.01, rel=1e-12)
    np.testing.assert_allclose(last.after.displacement["bar"], 0.0, atol=1e-15)


def test_the_velocity_of_nodes_without_inertia_is_the_mean_of_the_slab() -> None:
    """Of a block in flight that vibrates: they follow the others, by at least one correction a slab."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
        velocity=sw.bodies.Affine(gradient=((0.2, 0.1), (-0.1, -0.3))), mass=sw.bodies.Lumped(),
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -9.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"))
    model = sw.build(sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,)))
    for step in sw.march(model, until=0.5, method=Explicit()):
        moved = step.after.displacement["block"] - step.before.displacement["block"]
        mean = (moved / step.slab.span)[~model.massive]
        np.testing.assert_allclose(step.after.velocity["block"][~model.massive], mean, atol=1e-12)


def test_a_slab_beyond_the_stability_limit_of_crushed_cells_is_tried_again() -> None:
    """The limit at rest is too long for a bar between supports whose left half has less than a third of its length."""
    held = (sw.Fixed(on="left"), sw.Fixed(on="right"))
    model = sw.build(sw.Scene(bodies={"bar": thrown(10, material=sw.NeoHookean(E=1.0, nu=0.3), supports=held)}))
    rest = next(sw.march(model, until=0.01, method=Explicit())).before
    u = np.interp(np.linspace(0.0, 1.0, 11), (0.0, 0.5, 1.0), (0.0, -0.35, 0.0))
    u[1:5] += 1e-3 * np.array([1.0, -1.0, 1.0, -1.0])
    state = replace(rest, displacement={"bar": u[:, None]})
    steps = list(islice(sw.march(model, until=1.0, method=Explicit(), state=state), 10))
    assert any("beyond the stability limit" in reason for reason in steps[0].report.rejections)
    energy = steps[0].ledger.energy_kinetic + steps[0].ledger.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) < 0.1 * energy


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"weight": sw.model.Momentum()}, "time.weight"),
        ({"timing": sw.contact.Impulse()}, "solver"),
        ({"timing": sw.contact.Paper()}, "solver"),
        ({"timing": sw.contact.Energy(located=True)}, "solver"),
    ],
)
def test_what_does_not_go_with_it_is_refused(options: dict[str, object], where: str) -> None:
    contact = sw.Contact(between=("bar.right", "wall"), timing=options.pop("timing", sw.contact.Energy()))
    scene = sw.Scene(bodies={"bar": thrown(4), **WALL}, contacts=(contact,))
    with pytest.raises(sw.InputError) as caught:
        sw.march(scene, until=1.0, method=Explicit(), **options)
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("options", "where"), [({"safety": 0.0}, "safety"), ({"tolerance": 1.0}, "tolerance"), ({"limit": 0}, "limit")]
)
def test_impossible_values_are_refused(options: dict[str, float], where: str) -> None:
    with pytest.raises(sw.InputError, match=where):
        Explicit(**options)
