"""Contact nodes with inertia on meshes that change: closed rows stay closed, and everything passes over."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from adapting import adaptive_march
from passing import begins_as_it_ended

import softway as sw
from softway.contact.impact_rule import ImpactRule
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.refinement import refined
from softway.meshes.adaptive.surfaces.surface import ROUND, rounded
from softway.meshes.generators.shapes import disc, rectangle
from softway.meshes.mesh import Mesh

LAW = sw.LinearElastic(E=1.0, nu=0.3)
COARSE = Adapt(levels=4, tolerance=2.0, contact_cells=2, buffer=1)


def on_a_floor(mesh: Mesh, rule: ImpactRule, mu: float = 0.0) -> sw.Scene:
    """A body that falls on a floor, and along it."""
    low = float(mesh.points[:, 1].min())
    velocity = sw.bodies.Uniform(value=(0.05 if mu else 0.0, -0.1))
    body = sw.Solid(mesh=mesh, material=LAW, density=1.0, velocity=velocity)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, low - 0.005), normal=(0.0, 1.0)))
    friction = sw.laws.Coulomb(mu=mu) if mu else sw.laws.Frictionless()
    contact = sw.Contact(between=("body.boundary", "floor"), timing=rule, friction=friction)
    return sw.Scene(bodies={"body": body, "floor": floor}, contacts=(contact,))


def stays_closed(steps: Sequence[sw.Step], speed: float) -> int:
    """Number of changes in contact, through each of which closed rows stay closed, and forces nearly the same."""
    count = 0
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        begins_as_it_ended(last, taken)
        before, after = (np.concatenate(list(state.closed.values())) for state in (last.after, taken.before))
        if not (taken.transfers and before.any()):
            continue
        count += 1
        model, start = taken.model, taken.before
        u, v = (model.join(field) for field in (start.displacement, start.velocity))
        rows = model.rows(u, start.time)
        assert after.sum() == before.sum()  # fine cells stay where something is closed
        assert abs(rows.gap(u)[after]).max() < 1e-14
        assert rows.gap(u)[rows.near].min() > -1e-14
        assert abs(rows.normal_component(v)[after]).max() < speed
        forces = [sum(p.sum() for p in state.pressure.values()) for state in (last.after, taken.before)]
        assert forces[1] == pytest.approx(forces[0], rel=0.05)
    return count


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["tri3", "quad4", "tri6"])
@pytest.mark.parametrize("rule", [sw.contact.Impulse(), sw.contact.Paper()], ids=["impulse", "paper"])
def test_a_disc_on_a_floor(cell: str, rule: ImpactRule) -> None:
    adapt = {"body": Adapt(levels=4, tolerance=4.0, every=6, contact_cells=1, buffer=1)}
    steps = list(adaptive_march(on_a_floor(disc(0.5, 4, cell=cell), rule), adapt, until=2.4, step=0.06))
    assert stays_closed(steps, 1e-14) >= 4
    assert abs(steps[-1].ledger.remeshing) < 1e-15


def test_friction_passes_over() -> None:
    scene = on_a_floor(disc(0.5, 4, cell="tri3"), sw.contact.Impulse(), mu=0.3)
    body = scene.bodies["body"]
    fine = replace(body, mesh=refined(rounded(body.mesh, ROUND), np.full(body.mesh.n_cells, 4)).mesh)
    steps = list(adaptive_march(scene, {"body": COARSE}, until=1.6, step=0.05))
    *_, exact = sw.march(replace(scene, bodies={**scene.bodies, "body": fine}), until=1.6, step=0.05)
    assert stays_closed(steps, 1e-14) >= 3
    for taken in steps:
        pull, push = (next(iter(force.values())) for force in (taken.before.traction, taken.before.pressure))
        assert (np.linalg.norm(pull, axis=1) <= 0.3 * push + 1e-15).all()
    last = steps[-1].ledger
    assert last.momentum[:2] == pytest.approx(exact.ledger.momentum[:2], rel=0.015)
    assert last.spin[2] == pytest.approx(exact.ledger.spin[2], rel=0.01)
    assert last.dissipation == pytest.approx(exact.ledger.dissipation, rel=0.01)


def test_two_solids_that_touch_keep_their_momenta() -> None:
    ball = sw.Solid(
        mesh=disc(0.5, 4, cell="tri3"), material=LAW, density=1.0, velocity=sw.bodies.Uniform(value=(0.0, -0.1))
    )
    block = sw.Solid(mesh=rectangle((1.0, 0.5), (6, 3), cell="tri3", origin=(-0.5, -1.005)), material=LAW, density=2.0)
    contact = sw.Contact(between=("ball.boundary", "block.top"), timing=sw.contact.Impulse())
    scene = sw.Scene(bodies={"ball": ball, "block": block}, contacts=(contact,))
    steps = list(adaptive_march(scene, {"ball": COARSE, "block": COARSE}, until=1.0, step=0.05))
    assert stays_closed(steps, 1e-8) >= 3
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        for name, part in zip(("ball", "block"), taken.model.parts, strict=True):
            old, own = next(p for p in last.model.parts if p.name == name).nodes, part.nodes
            momenta = [
                (model.mass[nodes][:, nodes] @ state.velocity[name]).sum(axis=0)
                for model, nodes, state in ((last.model, old, last.after), (taken.model, own, taken.before))
            ]
            assert momenta[1] == pytest.approx(momenta[0], abs=1e-13)


@pytest.mark.slow
def test_a_bar_at_a_wall_is_as_on_the_finest_mesh() -> None:
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=10), material=sw.LinearElastic(E=1.0, nu=0.0), density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.3, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), timing=sw.contact.Impulse())
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,))
    fine = replace(scene, bodies={"bar": replace(bar, mesh=sw.meshes.Interval(length=1.0, cells=80)), "wall": wall})
    step = 0.1 / 8 / np.sqrt(2.0)
    adapted = list(adaptive_march(scene, {"bar": Adapt(levels=3)}, until=2.8, step=step))
    uniform = list(sw.march(fine, until=2.8, step=step))
    for last, taken in zip(adapted[:-1], adapted[1:], strict=True):
        begins_as_it_ended(last, taken)
    assert sum(bool(taken.transfers) for taken in adapted) > 10
    quiet = [k for k in range(1, len(adapted)) if not adapted[k].events]
    errors = np.array([taken.ledger.energy_error for taken in adapted])
    assert max(abs(errors[k] - errors[k - 1]) for k in quiet) < 1e-13  # a slab with a touch has an error of the rule
    assert abs(errors).max() == pytest.approx(max(abs(taken.ledger.energy_error) for taken in uniform), rel=1e-9)
    assert abs(adapted[-1].ledger.remeshing) < 1e-14
    forces = [np.array([s.ledger.contacts["bar.right-wall"].force_n for s in some]) for some in (adapted, uniform)]
    assert np.linalg.norm(forces[0] - forces[1]) < 0.002 * np.linalg.norm(forces[1])
    times = [[event.time for s in some for event in s.events] for some in (adapted, uniform)]
    assert times[0] == pytest.approx(times[1], abs=0.01 * step)
