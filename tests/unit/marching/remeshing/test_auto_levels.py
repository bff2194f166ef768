"""Levels that ``auto`` chooses: two halvings where they are few, one where the whole body rings or falls fast."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.setup.initial_fields import Field
from softway.marching.remeshing.adapted_scene import adapted_scene
from softway.marching.remeshing.touching import closing
from softway.marching.start.preparation import prepare
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import StepControl
from softway.meshes.adaptive.adapt import FEW, MOST, Adapt, Adapting
from softway.model.time_weight import EndPeaks

CELLS = 23
SETTINGS = Settings(until=1.0, step=0.05, weight=EndPeaks(), method=sw.FixedPoint(), control=StepControl())


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
    assert MOST * CELLS**2 < 16 * CELLS**2 and FEW[2] < (CELLS + 1) ** 2 * 16
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


def rubber(speed: float, adapt: Adapting = "auto") -> sw.Scene:
    """Block of 8 x 8 cells that touches a floor, which it leaves at once."""
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(8, 8)),
        material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
        velocity=sw.bodies.Uniform(value=(0.1, -speed)), adapt=adapt,
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1e-3), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),))


def test_the_way_to_a_contact_is_that_of_a_requested_slab() -> None:
    """Relative to a quarter of an edge, which surfaces may approach in a slab, and to an edge of small strain."""
    scene = rubber(0.2)
    hard = replace(scene.bodies["block"], material=sw.LinearElastic(E=1.0, nu=0.3))
    for one, allowed in ((scene, 0.25), (replace(scene, bodies={**scene.bodies, "block": hard}), 1.0)):
        model = adapted_scene(sw.build(one)).model
        ways = closing(model, prepare(model, SETTINGS).march_state)
        bottom = model.parts[0].mesh.nodes("bottom")
        assert ways[bottom] == pytest.approx(0.2 * 0.05 / allowed, rel=1e-12)
        assert np.delete(ways, bottom).max() == 0.0


@pytest.mark.parametrize(("speed", "halvings"), [(0.05, 2), (0.1, 1), (0.4, 0)])
def test_cells_are_no_smaller_than_requested_slabs_bring_to_touch(speed: float, halvings: int) -> None:
    """Cells of half or a quarter of the edges would take two or four slabs for one."""
    step = 0.15
    first, *others = sw.march(rubber(speed), until=0.6, step=step)
    assert first.model.adapted["block"].leaves.level.max() == 2 * halvings
    slabs = 1 + len(others), len(list(sw.march(rubber(speed, None), until=0.6, step=step)))
    assert slabs[0] <= 2 * slabs[1]
    assert abs(others[-1].ledger.energy_error) < 1e-10 * first.ledger.energy_kinetic


@pytest.mark.slow
def test_cells_at_a_contact_stay_fine_whatever_the_speed_of_its_surfaces() -> None:
    """The sides of a disc that is crushed come down faster than requested slabs take: coarser ones change its force."""
    disc = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, centre=(0.0, 1.04), cells=8),
        material=sw.NeoHookean(E=1.0, nu=0.35), density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0735, -0.294)), adapt="auto",
    )  # fmt: skip
    below = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(2.5, 1.7), cells=(9, 6), origin=(-1.25, -1.7)),
        material=sw.NeoHookean(E=3.0, nu=0.3), density=1.0, supports=(sw.bodies.Fixed(on="bottom"),),
    )  # fmt: skip
    bodies = {"disc": disc, "below": below}
    scene = sw.Scene(bodies=bodies, contacts=(sw.Contact(between=("disc", "below"), friction=sw.laws.Coulomb(mu=0.2)),))
    steps = list(sw.march(scene, until=1.6))
    closed = [step for step in steps if next(iter(step.ledger.contacts.values())).force_n > 0.0]
    fast = [closing(step.model, step.march_state).max() for step in closed]
    finest = Adapt().finest(steps[0].model.adapted["disc"].base)
    assert max(fast) > 2.0 * finest
    assert {int(step.model.adapted["disc"].leaves.level.max()) for step in closed} == {4}
    assert sum(bool(step.transfers) for step in closed) > 3
    assert abs(steps[-1].ledger.remeshing) < 1e-12 * steps[0].ledger.energy_kinetic


@pytest.mark.parametrize(("cells", "halvings"), [((3, 2, 3), 1), ((1, 1, 1), 2)])
def test_small_meshes_in_space_have_a_thousand_nodes(cells: tuple[int, int, int], halvings: int) -> None:
    """Eight times the cells, or two halvings where that many nodes suffice."""
    mesh = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=cells).build()
    assert 8**halvings * mesh.n_cells <= Adapt().most(mesh)
    assert halvings == 2 or 64 * mesh.n_cells > Adapt().most(mesh)
