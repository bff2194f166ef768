"""Degrees of freedom of one's own: contact and the slab see nodes, whatever moves them."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import softway as sw
from softway.bodies.dof_map import CombinedDofs, NodalDofs
from softway.model.build import build, with_dofs
from softway.model.model import Model

SPEED, LENGTH, WALL = 0.1, 2.0, 2.05


def bar(start: float, end: float, cells: int) -> sw.Solid:
    """A bar that flies to the right."""
    return sw.Solid(
        mesh=sw.meshes.Interval(length=end - start, cells=cells, origin=start),
        material=sw.LinearElastic(E=1.0, nu=0.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=SPEED),
    )


def scene(*bars: sw.Solid, timing: object = sw.contact.Energy()) -> sw.Scene:
    """Bars, the last of which meets a wall."""
    names = [f"bar{k}" for k in range(len(bars))]
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=WALL, normal=-1.0))
    contact = sw.Contact(between=(f"{names[-1]}.right", "wall"), timing=timing)
    return sw.Scene(bodies=dict(zip(names, bars, strict=True)) | {"wall": wall}, contacts=(contact,))


GLUE = sp.csr_array((np.ones(26), (np.arange(26), np.r_[np.arange(13), np.arange(12, 25)])))
"""Velocities of the nodes of two half bars from those of a whole one."""


def glued(timing: object = sw.contact.Energy()) -> Model:
    """Two half bars with the right end of the first at the left end of the second."""
    return with_dofs(build(scene(bar(0.0, 1.0, 12), bar(1.0, LENGTH, 12), timing=timing)), CombinedDofs(GLUE, 1))


def whole() -> Model:
    """One bar with the mass matrix of the halves: contact takes the mass of its nodes from the body behind them."""
    model = build(scene(bar(0.0, LENGTH, 24)))
    return with_dofs(replace(model, mass=sp.csr_array(GLUE.T @ glued().mass @ GLUE)), model.dofs)


@pytest.mark.parametrize("method", [sw.FixedPoint(), sw.Newton()], ids=["fixed-point", "newton"])
def test_two_glued_halves_are_one_bar(method: sw.FixedPoint | sw.Newton) -> None:
    """The same impact to rounding, and the energy of the pair is kept."""
    one = list(sw.march(whole(), until=6.0, step=0.05, method=method))
    two = list(sw.march(glued(), until=6.0, step=0.05, method=method))
    assert max(abs(s.ledger.energy_error) for s in two) < 1e-12
    for ours, theirs in zip(two, one, strict=True):
        mine = np.concatenate([ours.after.displacement["bar0"], ours.after.displacement["bar1"][1:]])
        np.testing.assert_allclose(mine, theirs.after.displacement["bar0"], atol=1e-12)
    assert two[-1].ledger.momentum[0] == pytest.approx(one[-1].ledger.momentum[0], abs=1e-12)
    assert two[-1].ledger.momentum[0] < -0.9 * SPEED * LENGTH


def test_a_rigid_body_is_one_unknown() -> None:
    """A block that may only fall meets the table on a spring of finite elements: the energy is kept."""
    head = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.5), cells=(2, 1)),
        material=sw.LinearElastic(E=1.0, nu=0.0),
        density=4.0,
        place=sw.bodies.Placement(translation=(0.0, 1.0)),
        velocity=sw.bodies.Uniform(value=(0.0, -0.2)),
    )
    foot = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 4)),
        material=sw.NeoHookean(E=10.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -0.2)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("foot.bottom", "floor"))
    model = build(sw.Scene(bodies={"foot": foot, "head": head, "floor": floor}, contacts=(contact,)))
    foot_nodes, n = model.parts[0].mesh.n_nodes, model.shape[0]
    top = np.flatnonzero(np.isclose(model.points[:, 1], 1.0) & (np.arange(n) < foot_nodes))
    rigid = np.r_[top, np.arange(foot_nodes, n)]
    own = np.setdiff1d(np.arange(foot_nodes), top)
    J = sp.lil_array((2 * n, 2 * len(own) + 2))
    for k, node in enumerate(own):
        J[2 * node, 2 * k], J[2 * node + 1, 2 * k + 1] = 1.0, 1.0
    J[2 * rigid, -2] = 1.0
    J[2 * rigid + 1, -1] = 1.0
    steps = list(sw.march(with_dofs(model, CombinedDofs(sp.csr_array(J), 2)), until=3.0, step=0.02))
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12
    assert any(e.kind == "touch" for s in steps for e in s.events)
    assert steps[-1].ledger.momentum[1] > 0.0
    for s in steps:
        moved = s.after.displacement["head"]
        np.testing.assert_allclose(moved, np.broadcast_to(moved[0], moved.shape), atol=1e-13)
        here = s.after.displacement["foot"][top]
        np.testing.assert_allclose(here, np.broadcast_to(moved[0], here.shape), atol=1e-13)


@pytest.mark.parametrize(
    ("timing", "method"),
    [
        (sw.contact.Impulse(), sw.FixedPoint()),
        (sw.contact.Paper(), sw.FixedPoint()),
        (sw.contact.Energy(located=True), sw.FixedPoint()),
        (sw.contact.Energy(), sw.Explicit()),
    ],
    ids=["impulse", "paper", "located", "explicit"],
)
def test_rules_that_treat_nodes_one_by_one_refuse(timing: object, method: sw.FixedPoint | sw.Explicit) -> None:
    with pytest.raises(sw.InputError, match="move several components"):
        sw.march(glued(timing), until=1.0, step=0.05, method=method)


def test_maps_that_do_not_fit_are_refused() -> None:
    model = glued()
    with pytest.raises(sw.InputError, match="a map for nodes"):
        with_dofs(model, NodalDofs(np.ones((3, 1), bool)))
    with pytest.raises(sw.InputError, match="without inertia"):
        with_dofs(model, CombinedDofs(sp.csr_array(np.ones((26, 1))), 1))
    with pytest.raises(sw.InputError, match="the initial velocity"):
        with_dofs(model, NodalDofs(np.arange(26)[:, None] > 3))
