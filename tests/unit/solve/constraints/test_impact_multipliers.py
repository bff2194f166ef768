"""The reaction that keeps closed rows at rest, and the jump that stops them."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from softway.bodies.inertia.mass_matrix import Consistent, Lumped, MassRule
from softway.bodies.solid import Fixed, Solid, Tool
from softway.contact.contact import Contact
from softway.contact.contact_rows import ContactRows
from softway.contact.impact_rule import Impulse
from softway.laws.bulk import LinearElastic
from softway.meshes.generators.shapes import rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Sphere
from softway.solve.constraints.impact_multipliers import impact_multipliers
from softway.solve.constraints.impact_sequence import ImpactSequence, contact_order

masses = pytest.mark.parametrize("mass", [Consistent(), Lumped()], ids=["consistent", "lumped"])


@pytest.fixture(params=["free", "held"])
def model(request: pytest.FixtureRequest, block: Callable[..., Model]) -> Model:
    model = block(timing=Impulse(), supports=(Fixed(on="left"),) if request.param == "held" else ())
    load = np.random.default_rng(7).normal(size=model.shape)
    return replace(model, load=load, load_before=load)


def rows(model: Model) -> ContactRows:
    return model.rows(model.displacement)


def dense(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Mass of the free components, and contact rows."""
    keep = model.free.ravel()
    mass = sp.kron(model.mass, sp.eye_array(2)).toarray()[np.ix_(keep, keep)]
    return mass, rows(model).matrix(model.dofs).toarray()


def stopped(model: Model, approach: np.ndarray, closed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Jump (n, d) and impulses (m,) of the closed rows."""
    sequence = ImpactSequence(impact_multipliers(model), rows(model), np.flatnonzero(closed))
    impulse, _ = sequence.stopped(approach, closed)
    (jump,) = sequence.fields([impulse])
    return jump, impulse


def reachable(model: Model) -> np.ndarray:
    return np.abs(rows(model).matrix(model.dofs)).sum(axis=1) > 0.0


def test_the_multiplier_leaves_no_acceleration_into_the_obstacle(model: Model) -> None:
    rng = np.random.default_rng(0)
    force = rng.normal(size=model.shape)
    closed = reachable(model) & (rng.random(len(model.contacts.node)) < 0.7)
    found = impact_multipliers(model).multiplier(rows(model), force, closed)
    mass, G = dense(model)
    acceleration = np.linalg.solve(mass, (model.load - force)[model.free] + G.T @ found)
    np.testing.assert_allclose((G @ acceleration)[closed], 0.0, atol=1e-12)
    assert closed.any()
    assert not found[~closed].any()


def test_a_jump_balances_momentum_and_loses_half_the_impulse_times_the_speed(model: Model) -> None:
    rng = np.random.default_rng(1)
    v = rng.normal(size=model.shape) * model.free
    closed = reachable(model)
    approach = np.where(closed, rows(model).normal_component(v), 0.0)
    jump, impulse = stopped(model, approach, closed)
    mass, G = dense(model)
    np.testing.assert_allclose(mass @ jump[model.free], G.T @ impulse, atol=1e-14)
    np.testing.assert_allclose(rows(model).normal_component(v + jump)[closed], 0.0, atol=1e-13)
    assert not jump[~model.free].any()
    lost = model.kinetic(v).sum() - model.kinetic(v + jump).sum()
    assert lost == pytest.approx(-0.5 * impulse @ approach, rel=1e-12)


@pytest.mark.parametrize(
    "obstacle", [HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), Sphere(centre=(0.5, -3.0), radius=3.0)]
)
def test_rows_that_come_one_after_another_are_stopped_as_each_set_alone(obstacle: HalfSpace | Sphere) -> None:
    """Impulses, changes of the later rows, jumps and reactions of nested sets, with a row that leaves in between."""
    solid = Solid(mesh=rectangle((1.0, 1.0), (4, 2)), material=LinearElastic(E=1.0), density=1.0)
    contact = Contact(between=("block.bottom", "floor"), timing=Impulse())
    model = build(Scene(bodies={"block": solid, "floor": Tool(shape=obstacle)}, contacts=(contact,)))
    rng, inertia, found = np.random.default_rng(5), impact_multipliers(model), rows(model)
    touch = np.array([0.4, np.nan, 0.2, 0.6, 0.8])
    begun = np.array([False, True, False, False, False])
    order = contact_order(touch, begun)
    assert order.tolist() == [1, 2, 0, 3, 4]
    sequence, approach = ImpactSequence(inertia, found, order), rng.normal(size=5)
    force = rng.normal(size=model.shape)
    mass, G = dense(model)
    for closed in ([1, 2], [1, 2, 0], [2, 0, 3], [2, 0, 3, 4]):
        there = np.isin(np.arange(5), closed)
        some = G[there]
        compliance = np.linalg.inv(some @ np.linalg.solve(mass, some.T))
        impulse, change = sequence.stopped(np.where(there, approach, 0.0), there)
        np.testing.assert_allclose(impulse[there], -compliance @ approach[there], rtol=1e-10)
        jump = np.linalg.solve(mass, G.T @ impulse).reshape(model.shape)
        np.testing.assert_allclose(sequence.fields([impulse, 2.0 * impulse]), [jump, 2.0 * jump], atol=1e-11)
        later = there | (touch >= 0.6)
        np.testing.assert_allclose(change[later], found.normal_component(jump)[later], atol=1e-11)
        pull = inertia.multiplier(found, force, there)
        np.testing.assert_allclose(sequence.reactions(force, there), pull, atol=1e-11)


def test_nothing_closed_nothing_done(model: Model) -> None:
    none = np.zeros(len(model.contacts.node), bool)
    assert not impact_multipliers(model).multiplier(rows(model), np.ones(model.shape), none).any()
    jump, impulse = stopped(model, np.zeros(len(none)), none)
    assert not jump.any()
    assert not impulse.any()


@masses
@pytest.mark.parametrize("cells", [2, 3, 10])
def test_a_bar_thrown_at_a_wall_loses_a_known_share(bar: Callable[..., Model], mass: MassRule, cells: int) -> None:
    """Lumped: 1 / (2 N) of the energy; consistent: 1/7 for N = 2, and 0.289 / N for many cells."""
    model = bar(cells, wall=1.0, timing=Impulse(), mass=mass)
    v = np.ones(model.shape)
    approach = rows(model).normal_component(v)
    _, impulse = stopped(model, approach, np.array([True]))
    share = -0.5 * float(impulse @ approach) / model.kinetic(v).sum()
    if isinstance(mass, Lumped):
        assert share == pytest.approx(1.0 / (2.0 * cells), rel=1e-12)
    elif cells == 2:
        assert share == pytest.approx(1.0 / 7.0, rel=1e-12)
    else:  # end of a chain of 1/6 [2 4 ... 4 2], per length of a cell, bordered by 1: root of x^2 + 4 x + 1
        assert share == pytest.approx(1.0 / (2.0 * np.sqrt(3.0) * cells), rel=2e-2)


def test_rows_without_a_free_component_carry_nothing(block: Callable[..., Model]) -> None:
    model = block(timing=Impulse(), supports=(Fixed(on="left"),))
    every = np.ones(len(model.contacts.node), bool)
    found = impact_multipliers(model).multiplier(rows(model), np.ones(model.shape), every)
    assert np.isfinite(found).all()
    assert not found[~reachable(model)].any()


def test_repeated_rows_share_the_reaction() -> None:
    solid = Solid(mesh=rectangle((1.0, 1.0), (2, 2)), material=LinearElastic(E=1.0), density=1.0)
    floor = Tool(shape=HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contacts = tuple(Contact(between=(f"block.{tag}", "floor"), timing=Impulse()) for tag in ("bottom", "surface"))
    model = build(Scene(bodies={"block": solid, "floor": floor}, contacts=contacts))
    v = np.tile([0.0, -1.0], (model.shape[0], 1))
    low = rows(model).offset < 1e-12
    jump, _ = stopped(model, np.where(low, rows(model).normal_component(v), 0.0), low)
    np.testing.assert_allclose(rows(model).normal_component(v + jump)[low], 0.0, atol=1e-13)
