"""Dashpots between massless nodes and the nodes of their cells, against their definition."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.assembled.dashpots import Dashpots
from softway.model.build import build
from softway.model.model import Model
from softway.solve.linear.pattern import Pattern, sum_within

SPAN, TIME = 0.3, 2.0


def block(dim: int) -> Model:
    """A block whose bottom may touch a floor: its nodes have no mass."""
    shape = (
        sw.meshes.Rectangle(size=(1.0, 1.5), cells=(2, 3))
        if dim == 2
        else sw.meshes.Box(size=(1.0, 1.5, 1.2), cells=(1, 2, 2))
    )
    solid = sw.Solid(mesh=shape, material=sw.NeoHookean(E=3.0, nu=0.3), density=1.0)
    up = np.eye(dim)[-1]
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=tuple(0.0 * up), normal=tuple(up)))
    contact = sw.Contact(between=("block.bottom", "floor"))
    return build(sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(contact,)))


@pytest.fixture(params=[2, 3], ids=["plane", "space"])
def made(request) -> tuple[Model, Array, Dashpots]:
    model = block(request.param)
    u = 0.05 * np.random.default_rng(7).standard_normal(model.shape)
    return model, u, Dashpots.of(model.parts, model.massive, model.points + u, model.tangent_blocks(u), TIME)


def test_forces_have_no_resultant_and_no_moment_and_oppose_the_motion(made: tuple[Model, Array, Dashpots]) -> None:
    model, u, dashpots = made
    x, moved = model.points + u, np.random.default_rng(8).standard_normal(model.shape)
    force = dashpots.force(moved, SPAN)
    scale = np.abs(force).sum()
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-14 * scale)
    d = x.shape[1]
    for a in range(d):
        for b in range(a):
            assert abs((x[:, a] * force[:, b] - x[:, b] * force[:, a]).sum()) < 1e-14 * scale
    assert (force * moved).sum() > 0.0


def test_rigid_motions_are_free(made: tuple[Model, Array, Dashpots]) -> None:
    model, u, dashpots = made
    x, d = model.points + u, u.shape[1]
    turn = np.random.default_rng(9).standard_normal((d, d))
    moved = x @ (turn - turn.T) + np.ones(d)
    np.testing.assert_allclose(dashpots.force(moved, SPAN), 0.0, atol=1e-13 * dashpots.damping.max())


def test_massive_nodes_that_share_no_cell_with_a_massless_one_feel_nothing(made: tuple[Model, Array, Dashpots]) -> None:
    model, _, dashpots = made
    cells = np.concatenate([c.reshape(len(c), -1) for c in model.parts[0].mesh.blocks.values()])
    near = np.unique(cells[~model.massive[cells].all(axis=1)])
    moved = np.zeros(model.shape)
    away = np.setdiff1d(np.arange(len(moved)), near)
    moved[away] = 1.0
    assert len(away) and not dashpots.force(moved, SPAN).any()


def test_a_massless_node_that_moves_alone_is_resisted_as_by_its_stiffness(made: tuple[Model, Array, Dashpots]) -> None:
    """The mean over all directions; lines to other massless nodes have the mean of two shares."""
    model, u, dashpots = made
    blocks, resisted, wanted = model.tangent_blocks(u), [], []
    for node in np.flatnonzero(~model.massive):
        moved = np.zeros((*model.shape, u.shape[1]))
        for a in range(u.shape[1]):
            moved[node, a, a] = 1.0
        pulls = [dashpots.force(moved[:, :, a], TIME)[node, a] for a in range(u.shape[1])]
        resisted.append(sum(pulls))
        wanted.append(u.shape[1] * np.linalg.norm(blocks[node]))
    assert 0.8 < sum(resisted) / sum(wanted) < 1.2
    assert min(np.array(resisted) / np.array(wanted)) > 0.5


def test_the_stiffness_is_the_derivative_and_within_the_pattern(made: tuple[Model, Array, Dashpots]) -> None:
    model, u, dashpots = made
    J = model.dofs.jacobian
    stiffness, moved = dashpots.stiffness(J, SPAN), np.random.default_rng(10).standard_normal(J.shape[1])
    force = J.T @ dashpots.force((J @ moved).reshape(u.shape), SPAN).ravel()
    np.testing.assert_allclose(stiffness @ moved, force, atol=1e-13 * np.abs(force).max())
    matrix = model.inertia_and_stiffness(u, 0.1)
    both = sum_within(matrix, stiffness)
    Pattern.of(matrix).require(both)
    np.testing.assert_allclose(both.toarray(), (matrix + stiffness).toarray(), atol=1e-13 * np.abs(both.data).max())


def test_a_sum_with_entries_outside_of_the_pattern_has_both(made: tuple[Model, Array, Dashpots]) -> None:
    model, u, dashpots = made
    matrix = model.inertia_and_stiffness(u, 0.1)
    stiffness = dashpots.stiffness(model.dofs.jacobian, SPAN)
    both = sum_within(stiffness, matrix)
    np.testing.assert_allclose(both.toarray(), (matrix + stiffness).toarray(), atol=1e-13 * np.abs(both.data).max())
