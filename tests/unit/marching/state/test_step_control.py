"""How far bodies may approach each other in a slab, and when slabs grow again."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

import softway as sw
from softway.bodies.assembled.vector_space import LocalSpace
from softway.contact.contact_set import SlabContacts
from softway.errors import TooFast
from softway.marching.state.step_control import SLOW, may_grow, require_slow
from softway.model.build import build

SOFT, LINEAR = sw.NeoHookean(E=1.0, nu=0.3), sw.LinearElastic(E=1.0, nu=0.3)


def too_fast(law: object, depth: float, cells: int = 5, approach: float = 0.25) -> bool:
    """Whether a block that would end the first slab so deep in the floor has to go on by shorter ones."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(cells, cells)), material=law, density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -1.0)), place=sw.bodies.Placement(bottom=0.1),
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    scene = sw.Scene(bodies={"block": block, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),))
    step = 0.1 + depth
    told = next(iter(sw.march(scene, until=step, step=step, control=sw.StepControl(approach=approach)))).report
    return any("beyond the touch" in reason for reason in told.rejections)


@pytest.mark.parametrize(("cells", "edge"), [(5, 0.2), (10, 0.1)])
@pytest.mark.parametrize("approach", [0.25, 0.1])
def test_the_approach_is_counted_in_edges(cells: int, edge: float, approach: float) -> None:
    assert not too_fast(SOFT, 0.9 * approach * edge, cells, approach)
    assert too_fast(SOFT, 1.1 * approach * edge, cells, approach)


def test_bodies_of_small_strain_may_approach_by_a_whole_edge() -> None:
    """Their cells cannot be crushed; more only where more is asked for."""
    assert not too_fast(LINEAR, 0.9 * 0.2)
    assert too_fast(LINEAR, 1.1 * 0.2)
    assert not too_fast(LINEAR, 1.1 * 0.2, approach=1.2)


def test_a_rejection_names_the_contact_that_closes_too_fast() -> None:
    """A block between a roof that is far away, declared first, and a floor that is near."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), material=SOFT, density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -1.0)), place=sw.bodies.Placement(bottom=0.1),
    )  # fmt: skip
    tools = {
        "roof": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 9.0), normal=(0.0, -1.0))),
        "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0))),
    }
    contacts = (sw.Contact(between=("block.top", "roof")), sw.Contact(between=("block.bottom", "floor")))
    scene = sw.Scene(bodies={"block": block, **tools}, contacts=contacts)
    told = next(iter(sw.march(scene, until=0.5, step=0.5))).report.rejections
    assert "in block.bottom-floor a node approaches by 0.8 edges" in told[0]


@pytest.mark.parametrize(
    ("start", "end", "push", "told"),
    [
        (0.3, 0.5, 0.0, ""),
        (0.3, 0.6, 0.0, "0.3 edges"),
        (-0.1, 0.5, 0.0, "0.5 edges"),
        (0.0, 0.0, 0.2, ""),
        (0.0, 0.0, 0.3, "0.3 edges"),
        (0.3, 0.3, 0.2, ""),
        (0.3, 0.4, 0.2, "0.3 edges"),
    ],
)
def test_an_overlap_at_the_start_does_not_count(start: float, end: float, push: float, told: str) -> None:
    """Mean gaps leave nodes inside their opponent; no shorter slab would take them out.

    Depths and the ``push`` of the floor in the slab are in edges.
    """
    block = sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(5, 5)), material=SOFT, density=1.0)
    shape = sw.obstacles.HalfSpace(point=(0.0, -0.1), normal=(0.0, 1.0))
    floor = sw.Tool(shape=shape, motion=sw.bodies.Translation(velocity=(0.0, 0.2 * push)))
    model = build(
        sw.Scene(bodies={"block": block, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),))
    )
    first, last = (np.full(model.shape, 1.0) * [0.0, -0.1 - 0.2 * depth] for depth in (start, end))
    pairs = model.contacts.meet(first, last, 0.0, 1.0)
    with pytest.raises(TooFast, match=told) if told else nullcontext():
        require_slow(model, pairs, first, last, 0.25)


def stacked() -> sw.Scene:
    """Two blocks with a gap between them, on meshes that do not match."""
    blocks = {
        name: sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(n, n), origin=(0.0, y)), material=SOFT, density=1.0
        )
        for name, n, y in (("low", 5, 0.0), ("high", 4, 1.01))
    }
    return sw.Scene(bodies=blocks, contacts=(sw.Contact(between=("low.top", "high.bottom")),))


@pytest.mark.parametrize(("part", "seen"), [(0.99, True), (1.01, False)])
def test_overlaps_of_solids_that_creep_are_not_searched(
    part: float, seen: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = build(stacked())
    motion = part * 0.25 * float(model.edge.min()) / (SLOW * np.sqrt(2.0))
    start = np.zeros(model.shape)
    pairs = model.contacts.meet(start, start + motion, 0.0, 1.0)
    asked, plain = [], SlabContacts.overlap_rows
    monkeypatch.setattr(
        SlabContacts, "overlap_rows", lambda self, u, of_tools=False: asked.append(of_tools) or plain(self, u, of_tools)
    )
    require_slow(model, pairs, start, start + motion, 0.25)
    assert asked == [seen]


def test_a_gap_changes_by_less_than_its_bound() -> None:
    """Random motions of all nodes, two blocks at a distance of a twentieth of their edges."""
    model, rng = build(stacked()), np.random.default_rng(2)
    start = np.zeros(model.shape)
    for size in (1e-4, 1e-3, 1e-2):
        motion = size * rng.uniform(-1.0, 1.0, model.shape)
        pairs = model.contacts.meet(start, motion, 0.0, 1.0)
        before, after = (pairs.overlap_rows(u) for u in (start, motion))
        both = before.near & after.near
        change = np.abs(after.gap(motion)[both] - before.gap(start)[both])
        assert both.any() and change.max() <= SLOW * np.sqrt(2.0) * np.abs(motion).max()


@pytest.mark.parametrize("value", [0.0, -1.0, np.inf, np.nan])
@pytest.mark.parametrize("name", ["approach", "scalar", "growth", "least", "patience"])
def test_limits_that_are_not_positive_are_refused(name: str, value: float) -> None:
    with pytest.raises(sw.InputError, match=name):
        sw.StepControl(**{name: value})


@pytest.mark.parametrize(("jump", "grows"), [(0.29, True), (0.31, False), (-0.31, False)])
def test_a_slab_grows_where_its_error_would_stay_small_at_twice_the_length(jump: float, grows: bool) -> None:
    """``h^2 |a1 - a0| / 12`` with twice the length and twice the jump, against a hundredth of an edge of 0.2.

    Eight times 0.1^2 / 12 times 0.3 is 0.002.
    """
    model = SimpleNamespace(space=LocalSpace(()), massive=np.array([True, True, False]), edge=np.array([0.2, 0.5, 0.2]))
    before, after = (SimpleNamespace(acceleration=np.zeros((3, 2))) for _ in range(2))
    before.acceleration[:] = 7.0
    after.acceleration[:] = 7.0
    after.acceleration[0, 1] += jump
    after.acceleration[2, 0] += 5.0  # without inertia it does not count
    assert may_grow(model, sw.StepControl(growth=0.01), 0.1, before, after) == grows
