"""Slabs that fail at every length: tried again on new meshes, or on the old ones where they fail on new ones."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from forging import HEIGHT, KEPT, forged, places, press

import softway as sw
from softway.errors import NumericsError
from softway.marching.remeshing import changing_slabs
from softway.marching.remeshing.forming import forming_march
from softway.marching.slab.slab_step import Stepper
from softway.marching.slabs import slabs
from softway.marching.state.march_state import MarchState
from softway.meshes.remeshed.remesh import Remesh
from softway.model.model import Model

CELLS, REDUCTION, COUNT = (4, 3), 0.3, 12
FIRST = sw.build(press(CELLS, KEPT)).points
FREQUENT = Remesh(ratio=1.3, shortened=0.0)


def failing(monkeypatch: pytest.MonkeyPatch, fails: Callable[[Stepper, float], bool]) -> None:
    """Let slabs fail that end at some times on some meshes."""

    def some(stepper: Stepper, now: MarchState) -> Iterator[sw.Step]:
        for step in slabs(stepper, now):
            if fails(stepper, step.after.time):
                raise NumericsError("no time step was accepted", step.before.time)
            yield step

    monkeypatch.setattr(changing_slabs, "slabs", some)


def on_first(stepper: Stepper) -> bool:
    """Whether a mesh is that of the start."""
    return is_first(stepper.model)


def is_first(model: Model) -> bool:
    """Whether a model has the mesh of the start."""
    return np.array_equal(model.points, FIRST)


def late(time: float) -> bool:
    """Whether a slab ends in the second half."""
    return time > 0.55 * REDUCTION * HEIGHT


@pytest.mark.slow
def test_a_new_mesh_for_a_slab_that_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limits that no cell reaches ask for no mesh; the slab that fails does, once."""
    failing(monkeypatch, lambda stepper, time: on_first(stepper) and late(time))
    steps = forged(KEPT, REDUCTION, COUNT, CELLS)
    reasons = [one.exchanges["body"].reason for one in steps if one.exchanges]
    assert reasons == ["a slab that failed"]
    assert steps[-1].after.time == pytest.approx(REDUCTION * HEIGHT)
    assert not is_first(steps[-1].model)


@pytest.mark.slow
def test_the_old_mesh_for_a_slab_that_fails_on_a_new_one(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = forged(KEPT, REDUCTION, COUNT, CELLS)
    failing(monkeypatch, lambda stepper, time: not on_first(stepper))
    steps = forged(FREQUENT, REDUCTION, COUNT, CELLS)
    assert not any(one.exchanges for one in steps)
    assert np.array_equal(places(steps[-1]), places(kept[-1]))


@pytest.mark.parametrize("how", [KEPT, FREQUENT], ids=["kept", "frequent"])
def test_a_march_that_fails_on_every_mesh_ends(monkeypatch: pytest.MonkeyPatch, how: Remesh) -> None:
    failing(monkeypatch, lambda _, time: late(time))
    with pytest.raises(NumericsError, match="no time step was accepted"):
        forged(how, REDUCTION, COUNT, CELLS)


def test_cells_as_good_as_new_ones_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """A new mesh would be no other: the march ends with its failure."""
    tried: list[str] = []
    monkeypatch.setattr(forming_march, "replacement", lambda *given: tried.append(given[3]))
    failing(monkeypatch, lambda _, time: time > 0.01 * HEIGHT)
    with pytest.raises(NumericsError):
        forged(KEPT, REDUCTION, COUNT, CELLS)
    assert not tried
