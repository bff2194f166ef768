"""Every scenario ten times with its nodes moved a little: it ends in the same way, with the same contact."""

from collections.abc import Mapping
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import softway as sw
from counts import WITHIN, Count, stored
from jitter import jittered
from softway.contact.impact_rule import Energy
from softway.scenario.checks.check import check
from softway.scenario.scenario import Scenario
from softway.tolerances import ENERGY
from variants import OTHERS, SCENARIOS, VARIANTS, each, small, whole

pytestmark = pytest.mark.slow

MOVED = [*product([1e-6, 1e-2], range(5))]
"""Sizes of the movements in cells, and seeds: the smallest ones find decisions by last bits."""
RARELY = "output.fields_every=1 h"
"""Frames at the start and the end only."""
TOUCHES = {1e-6: 0, 1e-2: 2}
"""Greatest difference of the numbers of touches and of releases, by the size of the movements in cells."""
SENSITIVE = 1.0 / 3.0
"""Greatest difference of the number of touches, relative to it, of variants that are sensitive to all movements. Nodes
let go there and touch again in neighbouring slabs: the releases are not compared."""
FIRST = {1e-6: 1e-3, 1e-2: 0.5}
"""Greatest difference of the instant of the first touch, in slabs."""
IMPULSE = {1e-6: 1e-4, 1e-2: 0.05}
"""Greatest difference of the impulse of a contact, relative to it."""
BALANCE = 10.0 * ENERGY
"""Greatest error of the energy balance of a run, relative to its energies: what ten slabs may miss together."""


def ended(scenario: Scenario, folder: Path, count: Count | None = None) -> sw.Run:
    """Run of a scenario, also one that stopped early; ``count`` what it costs."""
    of = Count() if count is None else count
    try:
        return sw.run(check(scenario), folder, progress=lambda seen: of.take(seen.step), cancel=of.cancel)
    except sw.NumericsError:
        return sw.Run(folder)


@pytest.fixture(scope="module", params=each())
def name(request) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def given(name) -> Scenario:
    return small(name, RARELY)


@pytest.fixture(scope="module")
def count(name) -> Count:
    """What the run of a variant costs whose nodes are where they are."""
    return Count()


@pytest.fixture(scope="module")
def still(name, given, count, tmp_path_factory) -> sw.Run:
    """Run of a variant whose nodes are where they are."""
    return ended(given, tmp_path_factory.mktemp(name) / "run", count)


def test_the_cost_is_the_stored_one(name, count, still):
    """Scenarios take no more slabs, iterations and rejections than they did: see test_counts.py."""
    assert still.stop.reason == "done"
    expected = stored()["small"][name]
    assert count.numbers() == pytest.approx(expected, rel=WITHIN), "python tests/scenarios/counts.py stores new numbers"


@pytest.mark.few(12)
def test_slightly_moved_nodes_change_little(name, given, still, tmp_path):
    require_same_course(name, given, *MOVED[0], still, tmp_path)


@pytest.mark.minutes
@pytest.mark.parametrize(("size", "seed"), MOVED[1:])
def test_moved_nodes_change_little(name, given, size, seed, still, tmp_path):
    require_same_course(name, given, size, seed, still, tmp_path)


def require_same_course(name: str, given: Scenario, size: float, seed: int, still: sw.Run, tmp_path: Path) -> None:
    """A run with moved nodes ends as the other one, with the same contact."""
    moved = ended(jittered(given, size, seed, VARIANTS[name].held), tmp_path / "run")
    assert (moved.status, moved.stop.message) == (still.status, still.stop.message)
    assert_energy(given, moved, still)
    found, expected = moved.summary["contacts"], still.summary["contacts"]
    assert found.keys() == expected.keys()
    for label in expected:
        slab, sensitive = float(still.history["h"].max()), bool(VARIANTS[name].sensitive)
        assert_contact(found[label], expected[label], size, slab, sensitive)


def assert_energy(given: Scenario, moved: sw.Run, still: sw.Run) -> None:
    """The energy balance closes; with ``Impulse`` and ``Paper`` it may lose energy, at most twice as much as before.

    Without inertia solids with heat may miss as much where they touch.
    """
    history = moved.history
    taking_part = history["energy_kinetic"] + np.abs(history["energy_strain"]) + np.abs(history["work_external"])
    tolerance = BALANCE * float(taking_part.max())
    lost = 0.0
    if not all(isinstance(contact.timing, Energy) for contact in given.contacts):
        lost = 2.0 * float(np.abs(still.history["energy_error"]).max())
    missed = 0.0
    if isinstance(given.inertia, sw.bodies.Off) and any(getattr(b, "thermal", None) for b in given.bodies.values()):
        lost = missed = 2.0 * float(np.abs(still.history["energy_error"]).max())
    assert history["energy_error"].max() <= tolerance + missed
    assert history["energy_error"].min() >= -tolerance - lost


def assert_contact(
    found: Mapping[str, Any], expected: Mapping[str, Any], size: float, slab: float, sensitive: bool
) -> None:
    """Touches, releases, first touch and impulse of a contact are the same up to the tolerances."""
    touches = SENSITIVE * expected["touches"] if sensitive else TOUCHES[size]
    assert found["touches"] == pytest.approx(expected["touches"], abs=touches)
    assert sensitive or found["releases"] == pytest.approx(expected["releases"], abs=touches)
    assert found["impulse"] == pytest.approx(expected["impulse"], rel=IMPULSE[1e-2 if sensitive else size])
    if expected["first_touch"] is None:
        assert found["first_touch"] is None
    else:
        assert found["first_touch"] == pytest.approx(expected["first_touch"], abs=FIRST[size] * slab)


def test_every_scenario_has_a_variant_that_touches_as_it_does():
    assert VARIANTS.keys() | set(OTHERS) == {file.stem for file in SCENARIOS.glob("*.toml")}
    for name, variant in VARIANTS.items():
        shipped, given = whole(name), small(name)
        assert len(variant.same) > 40 and given.time.end <= shipped.time.end, name
        assert given.contacts == shipped.contacts or "contacts" in variant.changes[0], name
        kinds, those = ({body: type(it) for body, it in x.bodies.items()} for x in (given, shipped))
        assert kinds.items() <= those.items() and set(kinds.values()) == set(those.values()), name
        assert len(kinds) == len(those) or any(".copies=" in change for change in variant.changes), name


def test_jitter_moves_all_nodes_but_those_that_are_held(name, given):
    held = VARIANTS[name].held
    moved = jittered(given, 1e-2, 0, held)
    for body, solid in given.bodies.items():
        if not isinstance(solid, sw.Solid):
            continue
        mesh = solid.mesh.build()
        change = np.abs(moved.bodies[body].mesh.points - mesh.points) / mesh.edges()[:, None]
        stays = np.zeros(change.shape, dtype=bool)
        for tag, components in held.get(body, {}).items():
            stays[np.ix_(mesh.nodes(tag), components)] = True
        assert (change[stays] == 0.0).all() and (change[~stays] > 0.0).all() and 0.005 < change.max() <= 0.01 + 1e-9
