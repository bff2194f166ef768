"""Compiled slabs are those of the solver for all models: same states, audits, events and numbers of iterations."""

from dataclasses import replace
from importlib import import_module
from itertools import islice

import numpy as np
import pytest

import softway as sw
from softway.errors import Cancelled
from softway.heat.coupled.build import build
from softway.marching.results.step import Step
from softway.marching.slab.slab_batch import BatchStates
from softway.model.model import Model

SLABS = import_module("softway.marching.slabs")


def bars(cells: int) -> sw.Scene:
    """Bars that hit a wall."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.25, normal=-1.0))
    return sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))


def disc() -> sw.Scene:
    """A disc that falls on a floor and turns."""
    body = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=4),
        material=sw.LinearElastic(E=1e3, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.2, -1.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.02), normal=(0.0, 1.0)))
    return sw.Scene(
        bodies={"disc": body, "floor": floor},
        contacts=(sw.Contact(between=("disc.boundary", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, -9.81)),),
    )


def held() -> sw.Scene:
    """A block that is held on one side, hangs down and strikes a floor."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(2.0, 0.5, 0.5), cells=(4, 1, 1)),
        material=sw.LinearElastic(E=1e4, nu=0.3),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.01), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(
        bodies={"block": body, "floor": floor},
        contacts=(sw.Contact(between=("block.bottom", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, 0.0, -9.81)),),
    )


def row_of_bars(between: tuple[str, ...] | str = ()) -> sw.Scene:
    """A bar flies against a second one, which strikes a wall."""
    given = {"one": (0.0, 1.0, 1.0, 1.0), "two": (1.3, 0.6, 0.0, 4.0)}  # place, length, velocity and stiffness
    bodies: dict[str, sw.Solid | sw.Tool] = {
        name: sw.Solid(
            mesh=sw.meshes.Interval(length=length, cells=10, origin=place),
            material=sw.LinearElastic(E=stiff),
            density=1.0,
            velocity=sw.bodies.Uniform(value=speed),
        )
        for name, (place, length, speed, stiff) in given.items()
    }
    bodies["wall"] = sw.Tool(shape=sw.obstacles.HalfSpace(point=2.2, normal=-1.0))
    pairs = [("one.right", "two.left"), ("two.right", "wall")]
    contacts = [sw.Contact(between=pair) for pair in pairs]
    return sw.Scene(bodies=bodies, contacts=(sw.Contact(between="all"),) if between == "all" else contacts)


def neighbours() -> sw.Scene:
    """Two blocks that fall on a floor side by side; the second one, quicker, comes up with the first."""

    def block(left: float, speed: float) -> sw.Solid:
        return sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4), origin=(left, 0.0)),
            material=sw.LinearElastic(E=1e3, nu=0.3),
            density=1.0,
            velocity=sw.bodies.Uniform(value=(speed, -1.0)),
        )

    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.05), normal=(0.0, 1.0)))
    return sw.Scene(
        bodies={"one": block(1.6, 0.1), "two": block(0.0, 1.5), "floor": floor},
        contacts=(sw.Contact(between=("one", "two", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, -9.81)),),
    )


def moving(scene: sw.Scene, name: str, motion: sw.bodies.Translation | sw.bodies.Table) -> sw.Scene:
    """The scene with a tool in motion."""
    return replace(scene, bodies={**scene.bodies, name: replace(scene.bodies[name], motion=motion)})


def rising() -> sw.Scene:
    """The floor of the disc rises and falls, with knots that are no ends of slabs of the given length."""
    heights = ((0.0, 0.0), (0.0, 0.02), (0.1, 0.05), (0.1, -0.03))
    return moving(disc(), "floor", sw.bodies.Table(times=(0.0, 0.1, 0.3037, 0.6), displacements=heights))


def loaded() -> sw.Scene:
    """The weight of the disc grows, and reverses."""
    ramp = sw.bodies.Ramp(times=(0.0, 0.2, 0.4), factors=(0.0, 1.0, -0.5))
    return replace(disc(), loads=(sw.Gravity(acceleration=(0.0, -9.81), ramp=ramp),))


def shaken() -> sw.Scene:
    """The held side of the block moves up and down; velocities bend inside slabs, and at their ends."""
    scene, times = held(), np.arange(0.0, 1.0, 0.0013)
    shake = sw.Driven(on="left", components="z", velocity=tuple(0.02 * np.sin(40.0 * times)), times=tuple(times))
    body = replace(scene.bodies["block"], supports=(shake, sw.Fixed(on="left", components="xy")))
    contact = sw.Contact(between=("block.right", "floor"))
    return replace(scene, bodies={**scene.bodies, "block": body}, contacts=(contact,))


def rubbing(friction: sw.laws.Coulomb | sw.laws.StaticKinetic, pull: float, speed: float) -> sw.Scene:
    """A block that falls on a rough floor, under its weight and a ``pull`` to the right [m/s^2]."""
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.5), cells=(4, 3)),
        material=sw.LinearElastic(E=1e3, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(speed, -0.1)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.002), normal=(0.0, 1.0)))
    return sw.Scene(
        bodies={"block": body, "floor": floor},
        contacts=(sw.Contact(between=("block.bottom", "floor"), friction=friction),),
        loads=(sw.Gravity(acceleration=(pull, -9.81)),),
    )


CASES = {
    "two bars": (bars(2), 0.05, 200),
    "many bars": (bars(40), 0.0125, 240),
    "disc": (disc(), 0.004, 160),
    "held": (held(), 0.004, 160),
    "bar on bar": (row_of_bars(), 0.02, 260),
    "all bars": (row_of_bars("all"), 0.02, 240),  # closed rows of both ends depend on each other
    "bars and moving wall": (moving(row_of_bars(), "wall", sw.bodies.Translation(velocity=-0.3)), 0.02, 160),
    "moving floor": (rising(), 0.004, 160),
    "loaded": (loaded(), 0.004, 160),
    "shaken": (shaken(), 0.004, 160),
    "sticks": (rubbing(sw.Coulomb(mu=0.8), 1.0, 0.0), 0.001, 120),
    "slips": (rubbing(sw.laws.StaticKinetic(mu_s=0.4, mu_k=0.2), 6.0, 0.2), 0.001, 120),
    "on a belt": (
        moving(rubbing(sw.Coulomb(mu=0.3), 0.0, 0.0), "floor", sw.bodies.Translation(velocity=(0.5, 0.02))),
        0.001,
        120,
    ),
    "side by side": (neighbours(), 0.004, 100),  # up to the contact of both
}


def marched(model: Model, step: float, count: int, **more: object) -> list[Step]:
    """First steps of a march."""
    return list(islice(sw.march(model, until=1e3 * step, step=step, **more), count))


def compiled(steps: list[Step]) -> int:
    """Number of compiled slabs."""
    return sum(isinstance(step.states, BatchStates) for step in steps)


@pytest.mark.parametrize("name", CASES)
def test_both_ways_agree(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Impacts, contacts and releases, to the rounding of positions by the stiffness."""
    scene, step, count = CASES[name]
    model = build(scene)
    fast = marched(model, step, count)
    monkeypatch.setattr(SLABS, "compiled_model", lambda *of: None)
    slow = marched(model, step, count)
    assert compiled(fast) > (0.25 if name == "all bars" else 0.5) * count and compiled(slow) == 0
    assert {e.kind for s in slow for e in s.events} >= {"touch", "release"}
    energy = max(s.ledger.energy_kinetic + s.ledger.energy_strain for s in slow)
    push = max(np.abs(s.march_state.state.start.force).max() for s in slow)
    rough = any(s.ledger.dissipation > 0.0 for s in slow)  # instants of stick and slip follow from rounded forces
    near = (1e-8 if rough else 1e-11) * step
    for one, other in zip(fast, slow, strict=True):
        assert one.slab.end == (pytest.approx(other.slab.end, rel=0, abs=near) if rough else other.slab.end)
        assert one.report.iterations == other.report.iterations
        assert (one.report.pairs, one.report.factorisations) == (other.report.pairs, other.report.factorisations)
        assert [(e.kind, e.node, e.bodies) for e in one.events] == [(e.kind, e.node, e.bodies) for e in other.events]
        np.testing.assert_allclose([e.time for e in one.events], [e.time for e in other.events], rtol=0, atol=near)
        for name, u in other.after.displacement.items():
            np.testing.assert_allclose(one.after.displacement[name], u, rtol=0, atol=1e-12)
            np.testing.assert_allclose(one.after.velocity[name], other.after.velocity[name], rtol=0, atol=1e-11)
            np.testing.assert_allclose(one.reactions[name], other.reactions[name], rtol=0, atol=1e-10 * push)
        agrees(one, other, (10.0 if rough else 1.0) * energy)
        assert one.march_state.memory.taken == other.march_state.memory.taken


def agrees(one: Step, other: Step, energy: float) -> None:
    """Ledgers and certificates of two slabs are the same."""
    for name in ("energy_kinetic", "energy_strain", "work_external", "dissipation", "energy_error"):
        assert getattr(one.ledger, name) == pytest.approx(getattr(other.ledger, name), abs=1e-12 * energy)
    np.testing.assert_allclose(one.ledger.momentum, other.ledger.momentum, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(one.ledger.spin, other.ledger.spin, rtol=1e-11, atol=1e-11)
    for label, found in other.ledger.contacts.items():
        mine = one.ledger.contacts[label]
        assert mine.count == found.count and mine.min_gap == pytest.approx(found.min_gap, abs=1e-12)
        assert mine.force_n == pytest.approx(found.force_n, rel=1e-10, abs=1e-10)
        assert mine.force_t == pytest.approx(found.force_t, rel=1e-10, abs=1e-10)
        assert mine.power_residual == pytest.approx(found.power_residual, abs=1e-12 * energy)
    assert one.certificate.min_gap == pytest.approx(other.certificate.min_gap, abs=1e-12)
    assert one.certificate.momentum_error == pytest.approx(other.certificate.momentum_error, abs=1e-11)
    assert one.certificate.energy_error == pytest.approx(other.certificate.energy_error, abs=1e-12 * energy)


@pytest.mark.parametrize(
    "name", ["two bars", "bar on bar", "bars and moving wall", "moving floor", "shaken", "slips", "on a belt"]
)
def test_a_march_from_any_slab_has_the_same_bits(name: str) -> None:
    """Also in the middle of a compiled call, and just before and after a touch."""
    scene, step, _ = CASES[name]
    model = build(scene)
    whole = marched(model, step, 80)
    touch = next(k for k, s in enumerate(whole) if s.events)
    for k in (touch - 3, touch - 1, touch, touch + 2, touch + 20):
        again = list(islice(sw.march(model, until=1e3 * step, step=step, state=whole[k].march_state), 15))
        for one, other in zip(again, whole[k + 1 :], strict=False):
            assert one.slab == other.slab and one.ledger.energy_error == other.ledger.energy_error  # the same bits
            for name, u in other.after.displacement.items():
                assert (one.after.displacement[name] == u).all()
                assert (one.after.velocity[name] == other.after.velocity[name]).all()


def test_states_follow_each_other() -> None:
    steps = marched(build(bars(2)), 0.05, 30)
    for one, other in zip(steps, steps[1:], strict=False):
        assert other.before is one.after
        assert not one.after.displacement["bar"].flags.writeable


def test_a_march_can_be_cancelled_between_compiled_slabs() -> None:
    seen: list[Step] = []
    steps = sw.march(bars(2), until=50.0, step=0.05, cancel=lambda: len(seen) >= 6)
    with pytest.raises(Cancelled):
        seen.extend(steps)
    assert len(seen) == 6


@pytest.mark.parametrize("what", ["friction", "averaged", "short", "tolerance"])
def test_other_marches_are_not_compiled(what: str) -> None:
    scene, until, more = disc(), 4.0, {}
    body, floor = scene.bodies["disc"], scene.bodies["floor"]
    if what == "averaged":
        law = sw.NeoHookean(E=1e3, nu=0.3)
        body = sw.Solid(mesh=body.mesh, material=law, density=1.0, velocity=body.velocity, dilatation="mean")
    friction = sw.laws.Tresca(shear=1.0) if what == "friction" else None
    contact = sw.Contact(between=("disc.boundary", "floor"), **({"friction": friction} if friction else {}))
    if what == "short":
        until = 0.796  # of 199 slabs
    if what == "tolerance":
        more = {"tolerance": 1e-3}
    scene = sw.Scene(bodies={"disc": body, "floor": floor}, contacts=(contact,))
    assert compiled(list(islice(sw.march(scene, until=until, step=0.004, **more), 8))) == 0
