"""A march on adapted meshes that goes on from a stored state has the same bits."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from adapting import adapting

import softway as sw
from softway.errors import InputError, NoConvergence, NumericsError
from softway.marching.attempts import accept
from softway.marching.attempts.audited_slab import AcceptedSlab
from softway.marching.attempts.dashpot_slab import SHORT
from softway.marching.march import march
from softway.marching.remeshing import adaptive_march
from softway.marching.state.march_state import MarchState
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.generators.shapes import disc
from softway.record.storage.serialisation import packed, unpacked

BALL = sw.Solid(
    mesh=disc(0.5, 4, cell="tri3"),
    material=sw.NeoHookean(E=1.0, nu=0.3),
    density=1.0,
    velocity=sw.bodies.Uniform(value=(0.0, -0.1)),
)
FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.505), normal=(0.0, 1.0)))
PLAIN = sw.Scene(bodies={"ball": BALL, "floor": FLOOR}, contacts=(sw.Contact(between=("ball.boundary", "floor")),))
SCENE = adapting(PLAIN, {"ball": Adapt(levels=4, tolerance=3.0, every=3, contact_cells=2, buffer=1)})
END, STEP = 0.9, 0.05


@pytest.fixture(scope="module")
def whole() -> list[sw.Step]:
    return list(march(SCENE, until=END, step=STEP))


@pytest.mark.parametrize("slabs", [2, 3, 5, 6, 9])
def test_the_same_bits(whole: list[sw.Step], slabs: int) -> None:
    state = unpacked(*packed(whole[slabs - 1].march_state))
    rest = list(march(SCENE, until=END, step=STEP, state=state))
    assert sum(bool(step.transfers) for step in whole) > 2
    assert len(rest) == len(whole) - slabs
    for one, other in zip(rest, whole[slabs:], strict=True):
        assert packed(one.march_state)[0] == packed(other.march_state)[0]
        assert np.array_equal(one.after.velocity["ball"], other.after.velocity["ball"])
        assert np.array_equal(one.after.displacement["ball"], other.after.displacement["ball"])
        assert one.ledger.energy_error == pytest.approx(other.ledger.energy_error, abs=0.0)
        assert set(one.transfers) == set(other.transfers)


def test_another_step_goes_on_with_the_same_meshes(whole: list[sw.Step]) -> None:
    first = next(march(SCENE, until=END, step=0.5 * STEP, state=whole[4].march_state))
    assert first.model.adapted["ball"].mesh.n_nodes == whole[4].model.adapted["ball"].mesh.n_nodes
    assert first.before.time == pytest.approx(whole[4].after.time)


def test_a_state_of_bodies_starts_on_the_meshes_of_its_model(whole: list[sw.Step]) -> None:
    steps = list(march(whole[4].model, until=END, step=STEP, state=whole[4].after))
    assert steps[-1].after.time == pytest.approx(END)
    assert abs(steps[-1].ledger.energy_error) < 1e-12


def test_states_of_other_meshes_are_refused(whole: list[sw.Step]) -> None:
    with pytest.raises(InputError, match="adapted"):
        march(PLAIN, until=END, step=STEP, state=whole[4].march_state)
    state = whole[4].march_state
    assert state.adapted is not None
    for leaves in ({}, {"ball": replace(state.adapted.leaves["ball"], level=np.zeros(3, dtype=np.int64))}):
        with pytest.raises(InputError, match=r"leaves|adapted"):
            march(SCENE, until=END, step=STEP, state=replace(state, adapted=replace(state.adapted, leaves=leaves)))


def test_meshes_stay_where_massless_nodes_find_no_equilibrium(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tries become more seldom: after 3 slabs, then at the multiples of 6 and of 12."""
    tried = list[int]()

    def refused(on: object, new: object, now: MarchState) -> None:
        tried.append(now.slabs)
        raise NumericsError("no static equilibrium", 0.0)

    monkeypatch.setattr(adaptive_march, "carried_over", refused)
    steps = list(march(SCENE, until=END, step=STEP))
    assert steps[-1].after.time == pytest.approx(END)
    assert tried == [3, 6, 12]
    again = list(march(SCENE, until=END, step=STEP, state=unpacked(*packed(steps[7].march_state))))
    assert packed(again[-1].march_state)[0] == packed(steps[-1].march_state)[0]
    assert not any(step.transfers for step in steps)
    assert {step.model for step in steps} == {steps[0].model}


def test_a_slab_that_fails_on_new_meshes_goes_back_to_the_old_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before its shortest lengths, and without dashpots."""
    solved, tried = accept.audited_slab, list[float]()

    def failing(*given: Any) -> AcceptedSlab:
        _, march_state, slab, _, attempt = given
        if not march_state.meshes_changed:
            return solved(*given)
        assert attempt.dashpots is None
        tried.append(slab.span)
        raise NoConvergence("no equilibrium")

    monkeypatch.setattr(accept, "audited_slab", failing)
    steps = list(march(SCENE, until=END, step=STEP))
    assert steps[-1].after.time == pytest.approx(END)
    assert {step.model for step in steps} == {steps[0].model}
    assert SHORT * STEP < min(tried) < 2.0 * SHORT * STEP
    assert not any(step.march_state.step_history.dashpots for step in steps)
