"""Levels that ``auto`` chooses: two halvings where they are few, one where the whole body rings."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.setup.initial_fields import Field
from softway.meshes.adaptive.adapt import FEW, MOST, Adapt, Adapting

CELLS = 23


def ringing(x: Array) -> Array:
    """Velocities that change from node to node."""
    return 1e-2 * np.random.default_rng(1).normal(size=x.shape)


def block(adapt: Adapting, velocity: Field) -> sw.Scene:
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(CELLS, CELLS), origin=(0.0, 0.01)),
        material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0, velocity=velocity, adapt=adapt,
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.5, -1.0), radius=1.0))
    return sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),))


@pytest.mark.slow
def test_a_body_that_rings_has_its_edges_halved_once() -> None:
    """All of 23 x 23 squares in sixteen parts would be more than eight times as many."""
    steps = list(sw.march(block("auto", ringing), until=0.1, step=0.01))
    meshes = [step.model.adapted["block"] for step in steps]
    assert {int(mesh.leaves.level.max()) for mesh in meshes} == {2}
    assert MOST * CELLS**2 < 16 * CELLS**2 and (CELLS + 1) ** 2 * 16 > FEW
    assert max(mesh.mesh.n_cells for mesh in meshes) == 4 * CELLS**2
    assert abs(steps[-1].ledger.energy_error) < 1e-12 * steps[0].ledger.energy_kinetic


@pytest.mark.slow
def test_a_contact_in_a_body_at_rest_has_its_edges_halved_twice() -> None:
    """And levels that are given are not changed."""
    falling = sw.bodies.Uniform(value=(0.0, -0.1))
    *_, last = sw.march(block("auto", falling), until=0.16, step=0.01)
    mesh = last.model.adapted["block"]
    assert mesh.leaves.level.max() == 4 and mesh.mesh.n_cells < MOST * CELLS**2
    assert Adapt(levels=4).most(mesh.base) == np.inf
