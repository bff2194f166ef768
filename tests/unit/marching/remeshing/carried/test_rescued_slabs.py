"""Slabs that fail at every length on adapted meshes: tried again on finer meshes, or on the base meshes."""

from collections.abc import Callable, Iterator

import pytest
from adapting import adaptive_march
from passing import keeps_its_balances

import softway as sw
from softway.errors import NumericsError
from softway.marching.remeshing import changing_slabs
from softway.marching.slab.slab_step import Stepper
from softway.marching.slabs import slabs
from softway.marching.state.march_state import MarchState
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.generators.shapes import rectangle

MESH = rectangle((1.0, 0.5), (4, 2), cell="tri3")
QUIET = Adapt(levels=2, smooth=0.0, tolerance=1e9, buffer=1)
UNTIL, STEP, FAILS = 1.0, 0.05, 0.51


def block() -> sw.Scene:
    """A block that shears itself freely, without contact."""
    moves = sw.bodies.Affine(value=(0.1, 0.0), gradient=((0.05, 0.02), (-0.02, 0.0)))
    solid = sw.Solid(mesh=MESH, material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0, velocity=moves)
    return sw.Scene(bodies={"block": solid})


def through(step: sw.Step) -> bool:
    """Whether a slab contains the instant at which slabs fail."""
    return bool(step.before.time <= FAILS < step.after.time)


def marched(monkeypatch: pytest.MonkeyPatch, fails: Callable[[int], bool], how: Adapt = QUIET) -> list[sw.Step]:
    """The march, of which the slab through ``FAILS`` fails on meshes of some numbers of nodes."""

    def some(stepper: Stepper, now: MarchState) -> Iterator[sw.Step]:
        for step in slabs(stepper, now):
            if through(step) and fails(len(stepper.model.points)):
                raise NumericsError("no time step was accepted", step.before.time)
            yield step

    monkeypatch.setattr(changing_slabs, "slabs", some)
    return list(adaptive_march(block(), {"block": how}, until=UNTIL, step=STEP))


def test_a_finer_mesh_for_a_slab_that_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = marched(monkeypatch, lambda nodes: nodes == MESH.n_nodes)
    (rescued,) = [one for one in steps if through(one)]
    assert rescued.transfers and rescued.model.meshes["block"].n_cells == 4 * MESH.n_cells
    assert steps[-1].after.time == pytest.approx(UNTIL)
    assert keeps_its_balances(steps) >= 1


def test_the_base_mesh_where_finer_cells_are_not_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """All cells as fine as they may be; no finer ones are left."""
    fine = Adapt(levels=2, smooth=0.0, tolerance=1e-9, buffer=1)
    steps = marched(monkeypatch, lambda nodes: nodes > MESH.n_nodes, fine)
    (rescued,) = [one for one in steps if through(one)]
    assert rescued.model.meshes["block"].n_cells == MESH.n_cells
    assert steps[-1].after.time == pytest.approx(UNTIL)


def test_a_march_that_fails_on_every_mesh_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(NumericsError, match="no time step was accepted"):
        marched(monkeypatch, lambda nodes: True)
