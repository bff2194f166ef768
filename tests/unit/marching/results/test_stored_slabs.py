"""Compiled slabs of stored energies are those of the solver for all models, to the tolerance of the iteration."""

from importlib import import_module
from itertools import islice

import numpy as np
import pytest

import softway as sw
from softway.heat.coupled.build import build
from softway.marching.results.step import Step
from softway.marching.slab.slab_batch import BatchStates
from softway.model.model import Model
from softway.solve.linear.backends.pardiso import Pardiso
from softway.solve.operators.factored import suited

SLABS = import_module("softway.marching.slabs")
SOFT = sw.NeoHookean(E=1e3, nu=0.3)
DOWN = sw.Gravity(acceleration=(0.0, -9.81))


def floor(*point: float) -> sw.Tool:
    """A floor at rest through a point."""
    return sw.Tool(shape=sw.obstacles.HalfSpace(point=point, normal=(*[0.0] * (len(point) - 1), 1.0)))


def met(*pairs: tuple[str, str]) -> tuple[sw.Contact, ...]:
    """Contacts without friction."""
    return tuple(sw.Contact(between=pair) for pair in pairs)


def spinning() -> sw.Scene:
    """A disc that spins and strikes a floor: its operator turns with it, and is renewed."""
    spin = sw.bodies.Affine(value=(0.5, -0.5), gradient=((0.0, -4.0), (4.0, 0.0)))
    disc = sw.Solid(mesh=sw.meshes.Disc(radius=1.0, cells=8), material=SOFT, density=1.0, velocity=spin)
    contacts = met(("disc.boundary", "floor"))
    return sw.Scene(bodies={"disc": disc, "floor": floor(0.0, -1.1)}, contacts=contacts, loads=(DOWN,))


def bending() -> sw.Scene:
    """A held beam that bends far and comes to a floor."""
    beam = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(4.0, 0.5), cells=(16, 2)),
        material=sw.laws.StVenantKirchhoff(E=2e3, nu=0.3),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    contacts = met(("beam.bottom", "floor"))
    return sw.Scene(bodies={"beam": beam, "floor": floor(0.0, -1.0)}, contacts=contacts, loads=(DOWN,))


def cube() -> sw.Scene:
    """A cube that falls on a floor."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3)),
        material=SOFT,
        density=1.0,
        velocity=sw.bodies.Affine(value=(0.3, 0.1, -1.0), gradient=((0, 0, -1.0), (0, 0, 0), (1.0, 0, 0))),
    )
    contacts = met(("cube.surface", "floor"))
    return sw.Scene(bodies={"cube": body, "floor": floor(0.0, 0.0, -0.02)}, contacts=contacts)


def dropped() -> sw.Scene:
    """A cube whose band would be too large, which falls flat and is compressed a little more on one side."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(7, 7, 7)),
        material=SOFT,
        density=1.0,
        velocity=sw.bodies.Affine(value=(0.0, 0.0, -1.0), gradient=((0, 0, 0), (0, 0, 0), (0.1, 0, -0.5))),
    )
    contacts = met(("cube.bottom", "floor"))
    return sw.Scene(bodies={"cube": body, "floor": floor(0.0, 0.0, -0.02)}, contacts=contacts)


def several() -> sw.Scene:
    """A soft disc and one of a linear law, which fall on one floor."""

    def disc(law: sw.NeoHookean | sw.LinearElastic, speed: float, place: float) -> sw.Solid:
        return sw.Solid(
            mesh=sw.meshes.Disc(radius=1.0, cells=6),
            material=law,
            density=1.0,
            velocity=sw.bodies.Uniform(value=(0.0, -speed)),
            place=sw.bodies.Placement(translation=(place, 0.0)),
        )

    bodies = {"soft": disc(SOFT, 1.0, 0.0), "stiff": disc(sw.LinearElastic(E=4e3, nu=0.3), 0.7, 3.0)}
    contacts = met(("soft.boundary", "floor"), ("stiff.boundary", "floor"))
    return sw.Scene(bodies={**bodies, "floor": floor(0.0, -1.01)}, contacts=contacts, loads=(DOWN,))


CASES = {
    "spinning": (spinning(), 0.002, 200, 0.8),
    "bending": (bending(), 0.002, 260, 0.8),
    "cube": (cube(), 0.002, 160, 0.6),
    "several": (several(), 0.002, 120, 0.8),
    "dropped": (dropped(), 0.001, 160, 0.8 if isinstance(suited(2000, "single"), Pardiso) else 0.0),
}
"""Scenes with the length of their slabs, the number of them, and the least part of them that is compiled."""


def marched(model: Model, step: float, count: int, **more: object) -> list[Step]:
    """First steps of a march."""
    return list(islice(sw.march(model, until=2e3 * step, step=step, **more), count))


def compiled(steps: list[Step]) -> list[Step]:
    """Compiled slabs."""
    return [step for step in steps if isinstance(step.states, BatchStates)]


@pytest.mark.parametrize("name", CASES)
def test_both_ways_agree(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, step, count, part = CASES[name]
    model = build(scene)
    fast = marched(model, step, count)
    monkeypatch.setattr(SLABS, "stored_model", lambda *of: None)
    slow = marched(model, step, count)
    assert len(compiled(fast)) >= part * count and not compiled(slow)
    assert {e.kind for s in slow for e in s.events} == {"touch", "release"}
    differ = sum(one.report.iterations != other.report.iterations for one, other in zip(fast, slow, strict=True))
    assert differ <= 2  # where the last change is rounding
    energy = max(s.ledger.energy_kinetic + s.ledger.energy_strain for s in slow)
    speed = max(np.abs(s.march_state.state.start.velocity).max() for s in slow)
    for one, other in zip(fast, slow, strict=True):
        assert one.slab == other.slab
        assert one.report.iterations == pytest.approx(other.report.iterations, abs=1)
        assert (one.report.factorisations, one.report.pairs) == (other.report.factorisations, other.report.pairs)
        assert one.march_state.memory.stale == other.march_state.memory.stale
        assert one.report.contraction == pytest.approx(other.report.contraction, rel=0.1)  # the last change is rounding
        assert [(e.kind, e.node) for e in one.events] == [(e.kind, e.node) for e in other.events]
        for body, u in other.after.displacement.items():
            assert one.report.scalars[body] == pytest.approx(other.report.scalars[body], abs=1e-8)
            np.testing.assert_allclose(one.after.displacement[body], u, rtol=0, atol=1e-11 * speed * step)
            np.testing.assert_allclose(one.after.velocity[body], other.after.velocity[body], rtol=0, atol=1e-9 * speed)
        agrees(one, other, energy, step)


def agrees(one: Step, other: Step, energy: float, step: float) -> None:
    """Ledgers and certificates of two slabs are the same."""
    push = energy / step
    for name in ("energy_kinetic", "energy_strain", "work_external", "dissipation", "energy_error"):
        assert getattr(one.ledger, name) == pytest.approx(getattr(other.ledger, name), abs=1e-11 * energy)
    np.testing.assert_allclose(one.ledger.momentum, other.ledger.momentum, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(one.ledger.spin, other.ledger.spin, rtol=1e-10, atol=1e-10)
    for body, force in other.reactions.items():
        np.testing.assert_allclose(one.reactions[body], force, rtol=0, atol=1e-11 * push)
    for label, found in other.ledger.contacts.items():
        mine = one.ledger.contacts[label]
        assert mine.count == found.count and mine.min_gap == pytest.approx(found.min_gap, abs=1e-12)
        assert mine.force_n == pytest.approx(found.force_n, rel=1e-9, abs=1e-11 * push)
        assert mine.power_residual == pytest.approx(found.power_residual, abs=1e-12 * energy)
    assert one.certificate.min_gap == pytest.approx(other.certificate.min_gap, abs=1e-12)
    assert one.certificate.shape == pytest.approx(other.certificate.shape, abs=1e-11)
    assert one.certificate.momentum_error == pytest.approx(other.certificate.momentum_error, abs=1e-11 * push * step)
    assert one.certificate.energy_error == pytest.approx(other.certificate.energy_error, abs=1e-11 * energy)


@pytest.mark.parametrize("name", ["spinning", "bending"])
def test_operators_turn_in_compiled_slabs(name: str) -> None:
    """Beyond the rotation up to which closed rows keep constant directions, and where none has a direction."""
    scene, step, count, _ = CASES[name]
    steps = compiled(marched(build(scene), step, count))
    assert any(s.march_state.memory.mixed for s in steps)
    assert max(abs(s.report.scalars[next(iter(s.report.scalars))]) for s in steps) > 0.01


def test_the_energy_closes_to_rounding_with_scalars() -> None:
    """Over two hundred slabs of which each has a scalar; the limit is that of the tolerance, 1e-11 a slab."""
    scene, step, count, _ = CASES["several"]
    steps = marched(build(scene), step, count)
    energy = steps[0].ledger.energy_kinetic
    assert sum(s.report.scalars["soft"] != 0.0 for s in compiled(steps)) > 0.6 * count
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12 * count * energy


@pytest.mark.parametrize(("name", "renewed"), [("cube", True), ("spinning", False), ("dropped", False)])
def test_a_march_from_any_slab_has_the_same_bits(name: str, renewed: bool) -> None:
    """Also in the middle of a compiled call, with an operator that is worn and one that turns."""
    scene, step, count, _ = CASES[name]
    model = build(scene)
    whole = marched(model, step, count)
    (body,) = whole[0].after.displacement
    new = [k for k, s in enumerate(whole[:-4]) if s.report.factorisations > 1][:1]
    assert bool(new) == renewed
    for k in (*(j + i for j in new for i in (-2, -1, 0, 3)), 20, 70, 101):
        again = list(islice(sw.march(model, until=2e3 * step, step=step, state=whole[k].march_state), 15))
        for one, other in zip(again, whole[k + 1 :], strict=False):
            assert isinstance(one.states, BatchStates) == isinstance(other.states, BatchStates)
            assert one.slab == other.slab and one.ledger.energy_error == other.ledger.energy_error  # the same bits
            assert (one.after.displacement[body] == other.after.displacement[body]).all()
            assert (one.after.velocity[body] == other.after.velocity[body]).all()


@pytest.mark.parametrize("what", ["friction", "depth", "short", "stress", "operator", "Newton"])
def test_marches_that_are_compiled(what: str) -> None:
    """Without mixing; not with friction, in plane stress, with another operator or method, or in short marches."""
    method: sw.FixedPoint | sw.Newton = sw.FixedPoint()
    if what == "Newton":
        method = sw.Newton()
    if what in ("depth", "operator"):
        method = sw.FixedPoint(depth=0) if what == "depth" else sw.FixedPoint(operator=sw.solve.MatrixFree())
    section = sw.bodies.PlaneStress() if what == "stress" else None
    body = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=4),
        material=SOFT,
        density=1.0,
        section=section,
        velocity=sw.bodies.Affine(value=(0.0, -1.0), gradient=((0.2, 0.0), (0.0, -0.2))),
    )
    contact = sw.Contact(between=("disc.boundary", "floor"))
    if what == "friction":
        contact = sw.Contact(between=("disc.boundary", "floor"), friction=sw.Coulomb(mu=0.3))
    scene = sw.Scene(bodies={"disc": body, "floor": floor(0.0, -1.5)}, contacts=(contact,))
    until = 0.998 if what == "short" else 1.0  # of 998 slabs
    steps = list(islice(sw.march(scene, until=until, step=0.001, method=method), 12))
    assert len(compiled(steps)) == (11 if what == "depth" else 0)
