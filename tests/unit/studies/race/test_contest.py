"""The contest: same start, same slabs, same answer."""

import json
from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.solve.methods.central_difference import Explicit
from softway.studies.race import Penalty, contest, entrants
from softway.studies.race.report import FILE, PICTURE, described, record, save


@pytest.fixture(scope="module")
def scene() -> sw.Scene:
    """A soft square above a floor."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.05, -0.2)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"block": block, "floor": floor}, contacts=(sw.Contact(between=("block.bottom", "floor")),))


@pytest.fixture(scope="module")
def results(scene):
    """All methods over the touch."""
    seen = []
    found = contest(scene, until=3.0, step=0.1, slabs=8, tolerance=1e-10, watch=lambda n, t: seen.append((n, t)))
    assert [n for n, _ in seen] == [r.name for r in found for _ in r.laps]
    return found


@pytest.mark.parametrize("method", ["accelerated", "newton", "penalty"])
def test_a_contest_is_cancelled(scene, method):
    reached: list[float] = []
    with pytest.raises(sw.Cancelled):
        contest(
            scene, until=3.0, step=0.1, methods=(method,), watch=lambda _, t: reached.append(t),
            cancel=lambda: len(reached) == 2,
        )  # fmt: skip
    assert reached == pytest.approx([0.1, 0.2])


def test_every_method_comes_to_the_same_end(results):
    assert [r.name for r in results] == list(entrants())
    *ours, penalty = results
    for result in ours[1:]:
        np.testing.assert_allclose(result.displacement["block"], ours[0].displacement["block"], atol=1e-9)
    assert np.abs(penalty.displacement["block"] - ours[0].displacement["block"]).max() < 0.05


def test_the_slabs_are_the_same_for_all(results):
    for result in results:
        assert not result.reason and not result.rejected
        np.testing.assert_allclose([lap.time for lap in result.laps], 0.1 * np.arange(1, 9))
        assert result.cpu > 0.0 and result.wall > 0.0 and result.first > 0.0 and result.usual > 0.0


def test_multipliers_allow_no_penetration_and_a_penalty_does(results):
    *ours, penalty = results
    assert max(r.penetration for r in ours) < 1e-12 and max(r.drift for r in ours) < 1e-9
    assert penalty.penetration > 1e-4 and min(r.least_force for r in results) >= 0.0


def test_newton_factors_in_every_iteration_and_the_fixed_point_once(results):
    by_name = {r.name: r for r in results}
    assert by_name["newton"].factorisations == by_name["newton"].iterations.sum()
    assert by_name["penalty"].factorisations == by_name["penalty"].iterations.sum()
    assert by_name["modified"].factorisations == 8
    assert by_name["accelerated"].factorisations < 4


def test_a_method_that_fails_stays_with_its_reason(scene, tmp_path):
    methods = {"short": sw.FixedPoint(limit=1, handover=False), "whole": sw.FixedPoint()}
    short, whole = contest(scene, until=3.0, step=0.1, methods=methods, slabs=4)
    assert "no time step was accepted" in short.reason and len(short.laps) < len(whole.laps) == 4 and not whole.reason
    found = record((short, whole))
    assert found["reference"] == "whole" and found["methods"]["short"]["distance"] is None
    save(found, tmp_path)
    assert (tmp_path / PICTURE).stat().st_size > 20_000


def test_the_record_is_complete_json(results, tmp_path):
    save(record(results, title="Block", scenario="text"), tmp_path / "race")
    found = json.loads((tmp_path / "race" / FILE).read_text(), parse_constant=pytest.fail)
    assert found["title"] == "Block" and found["scenario"] == "text" and set(found["methods"]) == set(entrants())
    for method in found["methods"].values():
        assert method["tolerance"] == 1e-10 and method["slabs"] == len(method["laps"]) == 8  # as given
        assert method["iterations_mean"] * 8 == pytest.approx(sum(lap["iterations"] for lap in method["laps"]))
        assert {"time", "energy", "error", "gap", "force", "wall", "cpu"} < set(method["laps"][0])
    assert (tmp_path / "race" / PICTURE).stat().st_size > 20_000


def test_a_race_without_contact(scene):
    free = replace(scene, contacts=(), bodies={"block": scene.bodies["block"]})
    for result in contest(free, until=0.4, step=0.1, methods=("accelerated", "penalty")):
        assert result.penetration == 0.0 and result.least_force == 0.0 and result.laps[0].gap is None


def test_folders_that_cannot_be_written_are_named(results, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(sw.InputError, match="cannot write"):
        save(record(results), tmp_path / "file")


@pytest.mark.parametrize("change", [{"methods": ("fast",)}, {"slabs": 0}, {"until": -1.0}])
def test_wrong_arguments_are_refused(scene, change):
    with pytest.raises(sw.InputError):
        contest(scene, **{"until": 1.0, "step": 0.1, **change})


def test_methods_in_words():
    assert described(Penalty(stiffness=7.0, mean="ends")).endswith("springs of 7 E A / l, force of a slab: ends")
    assert described(Explicit()) == "central differences" and described(sw.FixedPoint(depth=0)) == "plain fixed point"
