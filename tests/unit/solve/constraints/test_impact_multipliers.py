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
from softway.solve.constraints.impact_multipliers import impact_multipliers

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
    jump, impulse = impact_multipliers(model).jump(rows(model), approach, closed)
    mass, G = dense(model)
    np.testing.assert_allclose(mass @ jump[model.free], G.T @ impulse, atol=1e-14)
    np.testing.assert_allclose(rows(model).normal_component(v + jump)[closed], 0.0, atol=1e-13)
    assert not jump[~model.free].any()
    lost = model.kinetic(v).sum() - model.kinetic(v + jump).sum()
    assert lost == pytest.approx(-0.5 * impulse @ approach, rel=1e-12)


def test_nothing_closed_nothing_done(model: Model) -> None:
    none = np.zeros(len(model.contacts.node), bool)
    assert not impact_multipliers(model).multiplier(rows(model), np.ones(model.shape), none).any()
    jump, impulse = impact_multipliers(model).jump(rows(model), np.zeros(len(none)), none)
    assert not jump.any()
    assert not impulse.any()


@masses
@pytest.mark.parametrize("cells", [2, 3, 10])
def test_a_bar_thrown_at_a_wall_loses_a_known_share(bar: Callable[..., Model], mass: MassRule, cells: int) -> None:
    """Lumped: 1 / (2 N) of the energy; consistent: 1/7 for N = 2, and 0.289 / N for many cells."""
    model = bar(cells, wall=1.0, timing=Impulse(), mass=mass)
    v = np.ones(model.shape)
    approach = rows(model).normal_component(v)
    _, impulse = impact_multipliers(model).jump(rows(model), approach, np.array([True]))
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
    jump, _ = impact_multipliers(model).jump(rows(model), np.where(low, rows(model).normal_component(v), 0.0), low)
    np.testing.assert_allclose(rows(model).normal_component(v + jump)[low], 0.0, atol=1e-13)
