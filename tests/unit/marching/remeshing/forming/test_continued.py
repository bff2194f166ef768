"""A march with new meshes that goes on from a stored state has the same bits, and its matter has no jumps."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from forging import HEIGHT, KEPT, changes, continues, forged, has_no_jumps, places, press, volume

import softway as sw
from softway.errors import InputError, NumericsError
from softway.marching.remeshing.forming import forming_march
from softway.marching.state.march_state import MarchState

HOW = sw.meshes.Remesh(ratio=1.3, shortened=0.0, every=2)
SLABS, REDUCTION = 16, 0.35
GIVEN: dict[str, Any] = {"until": REDUCTION * HEIGHT, "step": REDUCTION * HEIGHT / SLABS}
SCENE = press((6, 5), HOW)


@pytest.fixture(scope="module")
def whole() -> list[sw.Step]:
    return list(sw.march(SCENE, **GIVEN))


@pytest.mark.slow
@pytest.mark.parametrize("after", [-1, 0, 1, 2])
def test_the_same_bits(whole: list[sw.Step], after: int) -> None:
    """From the states before, at and after the second change."""
    assert len(changes(whole)) >= 3
    slabs = changes(whole)[1] + after
    rest = continues(SCENE, whole, slabs, **GIVEN)
    assert all(np.array_equal(places(one), places(other)) for one, other in zip(rest, whole[slabs:], strict=True))


def test_the_matter_has_no_jumps(whole: list[sw.Step]) -> None:
    """The matter of the nodes of the first mesh is in the same places on the meshes before and after a change."""
    has_no_jumps(whole, 1e-14)


@pytest.mark.slow
def test_the_matter_goes_as_on_the_mesh_that_stays(whole: list[sw.Step]) -> None:
    """Places of the matter of all nodes against those of the nodes of a mesh that stays, and where matter came from."""
    kept = forged(KEPT, REDUCTION, SLABS, (6, 5))
    mesh = whole[-1].model.remeshed["body"]
    gone = mesh.matter @ places(whole[-1]) - places(kept[-1])
    assert np.linalg.norm(gone, axis=1).max() < 0.02 * REDUCTION * HEIGHT
    first = whole[0].model.points
    back = mesh.matter @ mesh.origin - first
    assert np.linalg.norm(back, axis=1).max() < 0.02 * REDUCTION * HEIGHT
    assert mesh.density == pytest.approx(
        volume(kept[0]) / float(whole[-1].model.parts[0].internal.sampling.volume.sum()), rel=1e-4
    )


def test_another_step_goes_on_with_the_same_mesh(whole: list[sw.Step]) -> None:
    k = changes(whole)[0]
    other = {**GIVEN, "step": 0.5 * GIVEN["step"]}
    first = next(sw.march(SCENE, state=whole[k].march_state, **other))
    assert np.array_equal(first.model.points, whole[k].model.points) and not first.exchanges
    again = list(sw.march(whole[k].model, state=whole[k].after, **GIVEN))
    assert again[-1].after.time == pytest.approx(GIVEN["until"])
    assert np.array_equal(again[0].model.points, whole[k].model.points)


def test_states_of_other_meshes_are_refused(whole: list[sw.Step]) -> None:
    state = whole[-2].march_state
    with pytest.raises(InputError, match="remeshed"):
        sw.march(press((6, 5), None), state=state, **GIVEN)
    with pytest.raises(InputError, match="without remeshed"):
        next(sw.march(SCENE, state=replace(state, remeshed=None), **GIVEN))
    with pytest.raises(InputError, match=r"state\.remeshed\.body\.mesh: a mesh of another body"):
        sw.march(press((5, 6), HOW), state=state, **GIVEN)


DAMAGES: dict[str, dict[str, Any]] = {
    "origin": {"origin": np.zeros((3, 2))},
    "density": {"density": -1.0},
    "sizes": {"sizes": np.zeros(42)},
    "base": {"base": np.zeros((3, 2))},
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damaged_meshes_are_refused(whole: list[sw.Step], name: str) -> None:
    state = whole[-2].march_state
    assert state.remeshed is not None
    wrong = replace(state.remeshed.meshes["body"], **DAMAGES[name])
    for meshes in ({}, {"body": wrong}):
        damaged = replace(state, remeshed=replace(state.remeshed, meshes=meshes))
        with pytest.raises(InputError, match=r"state\.remeshed"):
            sw.march(SCENE, state=damaged, **GIVEN)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["no cells", "no equilibrium"])
def test_meshes_stay_where_none_fits(monkeypatch: pytest.MonkeyPatch, what: str) -> None:
    def refused(*_: object) -> tuple[MarchState, object]:
        raise NumericsError("no static equilibrium", 0.0)

    if what == "no cells":
        monkeypatch.setattr(forming_march, "replacement", lambda *_: None)
    else:
        monkeypatch.setattr(forming_march, "carried_on", refused)
    steps = forged(HOW, 0.15, 6, (4, 3))
    kept = forged(KEPT, 0.15, 6, (4, 3))
    assert not changes(steps)
    assert np.array_equal(places(steps[-1]), places(kept[-1]))
