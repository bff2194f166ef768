"""Nodes without inertia in central differences: near a touch in equilibrium, elsewhere one correction behind it."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.scenes.cube import END, ENERGY, drop
from softway.bodies.assembled.contact_layer import layer
from softway.marching.explicit import contact_equilibrium
from softway.marching.rules.central_difference import central_difference

RADIUS, SPEED = 0.02, 20.0


def thrown(cells: int = 4, speed: float = SPEED, spin: float = 0.0, gap: float = 1e-4) -> sw.Scene:
    """A ball of quadratic tetrahedra that is thrown at a floor, which any place of its surface may touch."""
    ball = sw.Solid(
        mesh=sw.meshes.Ball(radius=RADIUS, cells=cells, cell="tet10"),
        material=sw.NeoHookean(E=1e8, nu=0.4),
        density=1150.0,
        velocity=sw.bodies.Affine(
            value=(1.0, 0.0, -speed), gradient=((0.0, -spin, 0.0), (spin, 0.0, 0.0), (0.0, 0.0, 0.0))
        ),
        mass=sw.bodies.Lumped(),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -RADIUS - gap), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"ball": ball, "floor": floor}, contacts=(sw.Contact(between=("ball.surface", "floor")),))


@pytest.fixture(scope="module")
def bounce() -> list[sw.Step]:
    return list(sw.march(thrown(), until=1e-3, method=sw.Explicit()))


def test_a_ball_bounces_with_its_energy_and_momentum(bounce: list[sw.Step]) -> None:
    """Energy within the swing of central differences, momentum of the push to rounding, sideways untouched."""
    start = bounce[0].ledger
    energy = start.energy_kinetic + start.energy_strain
    assert max(abs(s.ledger.energy_error) for s in bounce) <= 1e-3 * energy
    assert bounce[-1].ledger.momentum[2] > 0.0 and bounce[-1].ledger.contacts["ball.surface-floor"].force_n == 0.0
    assert max(s.certificate.momentum_error for s in bounce) <= 1e-12 * abs(start.momentum[2])
    assert bounce[-1].ledger.momentum[0] == pytest.approx(start.momentum[0], rel=1e-12)
    assert min(s.certificate.min_gap for s in bounce) >= -1e-12 * RADIUS
    assert min(s.certificate.min_force for s in bounce) >= 0.0


@pytest.mark.slow
def test_only_nodes_near_the_touch_are_in_equilibrium_of_their_own() -> None:
    """A small part of the surface of a fine ball as it touches; none before."""
    model = sw.build(thrown(10, gap=5e-3))
    steps = []
    for step in sw.march(model, until=1e-3, method=sw.Explicit()):
        steps.append(step)
        if step.ledger.contacts["ball.surface-floor"].count:
            break
    near = steps[-1].march_state.memory.near
    assert steps[0].march_state.memory.near is None and near is not None
    assert 0 < len(near.nodes) < len(model.touchable) // 3


def test_factors_are_few_though_cells_are_crushed(bounce: list[sw.Step]) -> None:
    """Slabs get shorter as cells do; the stiffness does not ask how long they are."""
    spans = {s.slab.span for s in bounce}
    assert len(spans) > len(bounce) // 4
    assert bounce[-1].report.factorisations <= len(bounce) // 10


def test_a_cube_that_is_crushed_takes_few_factors() -> None:
    """The peers' cube: 84 factors in its 104 slabs where each length of a slab asked for one."""
    *_, last = sw.march(drop(9, "tet4", sw.bodies.Lumped()), until=END, method=sw.Explicit())
    assert last.report.factorisations <= 10
    assert abs(last.ledger.energy_error) <= 0.01 * ENERGY


def test_a_spinning_ball_in_flight_keeps_what_it_has() -> None:
    """No touch, half a turn: the frozen stiffness wears, energy and both momenta stay."""
    model = sw.build(thrown(2, speed=0.0, spin=3e3, gap=1.0))
    steps = list(sw.march(model, until=1e-3, method=sw.Explicit(safety=0.4)))
    first, last = steps[0].ledger, steps[-1].ledger
    assert steps[-1].march_state.memory.near is None
    assert abs(last.energy_error) <= 1e-3 * (first.energy_kinetic + first.energy_strain)
    assert last.spin[2] == pytest.approx(first.spin[2], rel=1e-4)
    assert last.momentum[0] == pytest.approx(first.momentum[0], rel=1e-12)


@pytest.mark.slow
def test_one_correction_is_as_good_as_equilibrium(monkeypatch: pytest.MonkeyPatch, bounce: list[sw.Step]) -> None:
    """The ball that leaves is the same as where all nodes without inertia count as near the touch."""
    near = contact_equilibrium.touched_nodes

    def everywhere(system, still, u1, active):
        found = near(system, still, u1, active)
        return None if found is None else (still.nodes, still.nodes)

    monkeypatch.setattr(contact_equilibrium, "touched_nodes", everywhere)
    *_, whole = sw.march(thrown(), until=1e-3, method=sw.Explicit(tolerance=1e-9))
    one, other = (s.ledger.momentum[2] for s in (bounce[-1], whole))
    assert one == pytest.approx(other, rel=1e-4)


def test_the_stiffness_of_a_layer_is_that_of_the_body() -> None:
    model = sw.build(thrown(2))
    still = central_difference(model, sw.Explicit(), sw.model.EndPeaks()).still
    u = 1e-3 * np.random.default_rng(1).normal(size=model.shape)
    where = np.flatnonzero(still.light)
    whole = model.tangent(u)[where][:, where].toarray()
    np.testing.assert_allclose(still.layer.tangent(u, still.light).toarray(), whole, atol=1e-12 * np.abs(whole).max())


def test_a_layer_alone_has_the_same_forces() -> None:
    model = sw.build(thrown(2))
    part = layer(model.parts, np.arange(model.shape[0]) == model.touchable[0])
    u = 1e-3 * np.random.default_rng(2).normal(size=model.shape)
    nodes, own = part.alone()
    np.testing.assert_array_equal(own.force(u[nodes]), part.force(u)[nodes])
    around = part.around(np.arange(model.shape[0]) == model.touchable[0])
    np.testing.assert_array_equal(np.flatnonzero(around), np.sort(nodes))


def test_a_failed_slab_drops_the_nodes_near_the_touch(bounce: list[sw.Step]) -> None:
    memory = replace(bounce[50].march_state.memory, stale=False).failed()
    assert memory.stale and memory.skin is None and memory.near is None
