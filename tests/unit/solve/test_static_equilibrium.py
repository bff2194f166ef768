"""Static equilibrium with unilateral contact."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from softway.bodies.assembled.nodal_loads import dead_load
from softway.bodies.dof_map import NodalDofs
from softway.bodies.setup.loads import Gravity
from softway.bodies.solid import Fixed, Solid
from softway.contact.impact_rule import Impulse
from softway.errors import NumericsError
from softway.laws.bulk import NeoHookean, StVenantKirchhoff
from softway.meshes.generators.shapes import interval, rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.solve.static.proximal_equilibrium import proximal_equilibrium
from softway.solve.static.static_equilibrium import equilibrium


def pulled(model: Model, acceleration: float | tuple[float, ...]) -> np.ndarray:
    return dead_load(model.parts, model.weight, (Gravity(acceleration=acceleration),), "loads").at(0.0)


def test_a_bar_under_its_weight(bar: Callable[..., Model]) -> None:
    """u = g (x - x^2 / 2) at the nodes, exactly."""
    model = bar(5, held="left")
    rest = equilibrium(model, model.displacement, model.dofs, pulled(model, 0.2))
    u, force = rest.displacement, rest.pressure
    x = model.parts[0].mesh.points[:, 0]
    np.testing.assert_allclose(u[:, 0], 0.2 * (x - x**2 / 2), atol=1e-15)
    assert force.shape == (0,)


def test_a_wall_in_reach_takes_the_rest(bar: Callable[..., Model]) -> None:
    """u(1) = gap leaves the reaction g / 2 - gap."""
    model = bar(6, wall=1.04, timing=Impulse(), held="left")
    load = pulled(model, 0.2)
    rest = equilibrium(model, model.displacement, model.dofs, load)
    u, force = rest.displacement, rest.pressure
    assert u[-1, 0] == pytest.approx(0.04, abs=1e-15)
    assert force == pytest.approx([0.1 - 0.04], rel=1e-12)


def test_a_wall_out_of_reach_does_nothing(bar: Callable[..., Model]) -> None:
    model = bar(6, wall=1.11, timing=Impulse(), held="left")
    load = pulled(model, 0.2)
    rest = equilibrium(model, model.displacement, model.dofs, load)
    u, force = rest.displacement, rest.pressure
    assert u[-1, 0] == pytest.approx(0.1, rel=1e-13)
    assert force.tolist() == [0.0]


def test_large_deformation_against_a_wall(bar: Callable[..., Model]) -> None:
    model = bar(6, wall=1.04, timing=Impulse(), held="left", material=NeoHookean(E=1.0, nu=0.3))
    load = pulled(model, 0.6)
    rest = equilibrium(model, model.displacement, model.dofs, load)
    u, force = rest.displacement, rest.pressure
    residual = model.force(u) - load - model.rows(u).spread(force, model.shape)
    np.testing.assert_allclose(residual[1:], 0.0, atol=1e-14)
    assert u[-1, 0] == pytest.approx(0.04, abs=1e-14)
    assert force[0] > 0.0


def test_some_components_keep_their_value(block: Callable[..., Model]) -> None:
    model = block()
    rng = np.random.default_rng(0)
    u0 = 0.01 * rng.normal(size=model.shape) * model.massive[:, None] + [0.0, 0.1]
    unknown = np.zeros(model.shape, bool)
    unknown[~model.massive] = True
    u = equilibrium(model, u0, NodalDofs(unknown), model.load).displacement
    np.testing.assert_array_equal(u[model.massive], u0[model.massive])
    np.testing.assert_allclose(model.force(u)[~model.massive], 0.0, atol=1e-14)
    assert not np.shares_memory(u, u0)


def test_nothing_unknown_nothing_done(block: Callable[..., Model]) -> None:
    model = block()
    rest = equilibrium(model, model.displacement, NodalDofs(np.zeros(model.shape, bool)), model.load)
    u, force = rest.displacement, rest.pressure
    assert u is model.displacement
    assert not force.any()


def test_a_load_without_equilibrium_is_told() -> None:
    law = StVenantKirchhoff(E=1.0, nu=0.0)  # its greatest pressure is E 3^{-3/2}
    solid = Solid(mesh=rectangle((1.0, 1.0), (2, 2)), material=law, density=1.0, supports=(Fixed(on="bottom"),))
    model = build(Scene(bodies={"block": solid}))
    with pytest.raises(NumericsError, match="equilibrium"):
        equilibrium(model, model.displacement, model.dofs, pulled(model, (0.0, -2.0)))


def test_proximal_steps_find_the_equilibrium_at_a_wall(bar: Callable[..., Model]) -> None:
    model = bar(6, wall=1.04, timing=Impulse(), held="left", material=NeoHookean(E=1.0, nu=0.3))
    load = pulled(model, 0.6)
    rest = proximal_equilibrium(model, model.displacement, model.dofs, load)
    known = equilibrium(model, model.displacement, model.dofs, load)
    assert rest.displacement == pytest.approx(known.displacement, abs=1e-13)
    assert rest.pressure == pytest.approx(known.pressure, rel=1e-11)


@pytest.mark.parametrize("stretch", [0.5, 0.57])
def test_proximal_steps_leave_an_unstable_shape(bar: Callable[..., Model], stretch: float) -> None:
    """A bar that softens, crushed to where its tangent is not positive: back to its length, not through itself."""
    model = bar(3, held="left", material=StVenantKirchhoff(E=1.0, nu=0.0))
    crushed = (stretch - 1.0) * model.parts[0].mesh.points
    rest = proximal_equilibrium(model, crushed, model.dofs, np.zeros_like(crushed))
    assert rest.displacement == pytest.approx(0.0, abs=1e-13)


def test_proximal_steps_part_surfaces_and_stay_where_contact_holds(bar: Callable[..., Model]) -> None:
    """A bar that a wall crushes to half pushes with (r - r^3) / 2 = 3/16; its tangent there, (3 r^2 - 1) / 2, is
    negative, and the wall holds it.
    """
    model = bar(1, wall=0.5, held="left", material=StVenantKirchhoff(E=1.0, nu=0.0))
    rest = proximal_equilibrium(model, model.displacement, model.dofs, np.zeros(model.shape))
    assert rest.displacement.ravel() == pytest.approx([0.0, -0.5], abs=1e-13)
    assert rest.pressure == pytest.approx([3.0 / 16.0], rel=1e-11)


def test_no_proximal_step_turns_a_cell_inside_out(bar: Callable[..., Model]) -> None:
    """The first step of Newton's method is five lengths of the small cell, the bound of a step two."""
    mesh = interval(1.0, 2)
    mesh = replace(mesh, points=np.array([[0.0], [0.01], [1.0]]))
    model = bar(mesh=mesh, held="left", material=NeoHookean(E=1.0, nu=0.0))
    load = np.array([[0.0], [-5.0], [0.0]])
    rest = proximal_equilibrium(model, model.displacement, model.dofs, load)
    assert (model.force(rest.displacement) - load)[1:] == pytest.approx(0.0, abs=1e-11)
    assert -0.01 < rest.displacement[1, 0] < -0.008
    with pytest.raises(NumericsError, match="inside out"):
        equilibrium(model, model.displacement, model.dofs, load)
