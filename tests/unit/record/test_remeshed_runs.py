"""Runs whose meshes are replaced: frames, displacements, probes, events, pictures, notes and resumption."""

import itertools

import numpy as np
import pytest

import softway as sw
from records import differences
from softway.apps.cli import main
from softway.errors import InputError
from softway.record.audit.folder import frames_audited, history_audited
from softway.record.read.world_lines import changes
from softway.record.view.bodies.body_placement import body_placement
from softway.record.view.film import film
from softway.record.view.options import PictureOptions
from softway.record.write.events import MESH
from softway.scenario.checks.check import check

TEXT = """
title = "press"
inertia = {{ kind = "Off" }}

[bodies.body]
kind = "Solid"
mesh = {{ kind = "Rectangle", size = ["1 m", "0.75 m"], cells = [4, 3] }}
material = {{ kind = "{law}", {numbers} }}
density = "1 kg/m^3"
section = {{ kind = "Axisymmetric" }}
dilatation = "mean"
remesh = {remesh}
supports = [{{ kind = "Fixed", on = "bottom", components = "y" }}, {{ kind = "Fixed", on = "left", components = "x" }}]

[bodies.platen]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0, 0.75], normal = [0, -1] }}
motion = {{ kind = "Translation", velocity = [0, -1] }}

[[contacts]]
name = "platen"
between = ["body", "platen"]
friction = {{ kind = "NortonHoff", alpha = 0.3, p = 0.3, K = 1 }}

[time]
end = "0.24 s"
step = "0.02 s"

[output]
fields_every = "0.02 s"
probes = [
    {{ name = "corner", of = "body", at = ["1 m", "0.75 m"], quantity = "position" }},
    {{ name = "gone", of = "body", at = ["1 m", "0.75 m"], quantity = "displacement", component = "norm" }},
    {{ name = "flank", of = "body", tag = "right", quantity = "displacement" }},
    {{ name = "speed", of = "body", tag = "top", quantity = "velocity", component = "y" }},
    {{ name = "held", of = "body", tag = "bottom", quantity = "reaction", component = "y" }},
    {{ name = "axis", of = "body", at = ["0 m", "0 m"], quantity = "reaction", component = "y" }},
]
"""
NEW = "{ ratio = 1.3, shortened = 0, every = 2 }"
VISCOUS = {"law": "NortonHoff", "numbers": "K = 1, m = 0.3"}
ELASTIC = {"law": "NeoHookean", "numbers": "E = 1, nu = 0.3"}
SHORT = PictureOptions(dpi=40, times=(0.0, 0.24))


def scenario(folder, remesh: str = NEW, law=None) -> sw.Scenario:
    """Press of case E02 as a file."""
    file = folder / "press.toml"
    file.write_text(TEXT.format(remesh=remesh, **(law or VISCOUS)))
    return sw.load(file)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("press")
    kept = "{ quality = 0, angle = 0, ratio = 1e9, shortened = 0 }"
    return {name: sw.run(scenario(folder, how), folder / name) for name, how in (("new", NEW), ("kept", kept))}


@pytest.fixture
def run(runs):
    return runs["new"]


@pytest.mark.slow
def test_frames_have_their_cells_and_the_displacement_of_the_matter(run) -> None:
    fields = run.fields
    assert len(set(fields.geometries)) >= 3 and changes(run)
    start = {"x": (0.0, 1.0), "y": (0.0, 0.75)}
    for frame, cells in fields.with_cells():
        begun = frame.points - frame.displacement
        for axis, (low, high) in enumerate(start.values()):
            assert begun[:, axis].min() == pytest.approx(low, abs=3e-3)
            assert begun[:, axis].max() == pytest.approx(high, abs=3e-3)
        np.testing.assert_allclose(frame.start(cells), begun, atol=1e-12)
        low = cells.reference[:, 1] == 0.0
        np.testing.assert_allclose(frame.displacement[low, 1], 0.0, atol=1e-14)
    first, last = fields[0], fields[-1]
    assert np.array_equal(first.start(fields.cells), fields.cells.reference)
    top = last.points[:, 1] > 0.51 - 1e-12
    assert top.sum() == 5 and last.displacement[top, 1] == pytest.approx(-0.24, abs=1e-12)
    platen = {"platen": fields.cells.obstacles(last.time)["platen"]}
    assert body_placement(fields.cells_of(last), last, platen).factor == pytest.approx(1.0)


def test_probes_have_no_jumps_and_follow_the_matter(runs) -> None:
    """Curves on replaced meshes and on the one that stays; the speed of the probe is that of its place."""
    new, kept = (runs[name].history for name in ("new", "kept"))
    for name in ("corner", "gone", "flank"):
        assert new[name] == pytest.approx(kept[name], abs=2e-3)
        growth = np.diff(new[name])
        assert np.abs(np.diff(growth)).max() < 0.15 * growth.max()
    assert new["corner"][0] == pytest.approx(1.0) and new["flank"][0] == pytest.approx(0.0)
    assert new["gone"] == pytest.approx(np.hypot(new["corner"] - 1.0, new["time"]), abs=1e-12)
    assert new["speed"][1:] == pytest.approx(-1.0, abs=1e-12)
    force = new["contact.platen.force_n"]
    assert new["held"][1:] == pytest.approx(force[1:], rel=1e-9)
    assert 0.0 < new["axis"][-1] < 0.1 * force[-1]


def test_events_summary_and_audit(run, capsys) -> None:
    events, history = run.events, run.history
    mine = events["kind"] == MESH
    assert mine.sum() == run.fields.geometries[-1] >= 2 and set(events["contact"][mine]) == {"body"}
    assert all(text.startswith("20 nodes, 12 cells: ") for text in events["finding"][mine])
    assert events["finding"][mine][0].endswith(": ratio of edges 1.38")
    told = run.summary["mesh"]
    assert told["changes"] == mine.sum() and told["most_nodes"] == told["mean_nodes"] == 20
    assert np.abs(history["remeshing"]).max() < 1e-13 * history["work_external"][-1]
    assert not history_audited(history)
    assert not any(depths.findings for depths in frames_audited(run.fields))
    assert run.status == "done"
    assert main(["audit", str(run.path), "--strict"]) == 0
    assert main(["show", str(run.path)]) == 0
    assert "meshes that change" in capsys.readouterr().out


@pytest.mark.slow
def test_pictures_films_and_the_page(run, tmp_path) -> None:
    assert main(["plot", str(run.path), "--out", str(tmp_path / "picture.png")]) == 0
    assert (tmp_path / "picture.png").is_file() and (tmp_path / "picture_history.png").is_file()
    assert film(run, tmp_path / "film.gif", SHORT).stat().st_size > 1000
    pytest.importorskip("trame")
    pytest.importorskip("pyvista")
    from softway.apps.viewer.app import page

    made = page(run)
    for k in (0, len(run.fields) - 1):
        made.frame(k)
        x = run.fields[k].points[:, 0]
        assert made.solids.skin.bounds[:2] == pytest.approx((x.min(), x.max()), abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("after", [5, 9])
def test_a_resumed_run_has_the_same_bits(runs, tmp_path, after) -> None:
    seen = itertools.count(1)

    def stop(progress: object) -> None:
        if next(seen) == after:
            raise KeyboardInterrupt

    folder = tmp_path / "stopped"
    with pytest.raises(KeyboardInterrupt):
        sw.run(scenario(tmp_path), folder, progress=stop)
    sw.resume(folder)
    assert differences(folder, runs["new"].path) == []


def test_notes_on_meshes_that_stay(tmp_path) -> None:
    """With auto a law that knows the undeformed shape keeps its mesh; with numbers it is refused."""
    (note,) = (n for n in check(scenario(tmp_path, '"auto"', ELASTIC)).notes if n.where.endswith("remesh"))
    assert note.where == "bodies.body.remesh" and "the mesh stays; bodies.body.material is NeoHookean" in note.problem
    with pytest.raises(InputError, match=r"bodies\.body\.material: NeoHookean"):
        check(scenario(tmp_path, NEW, ELASTIC))
    assert check(scenario(tmp_path, '"auto"')).model.remeshed.keys() == {"body"}


@pytest.fixture(scope="module")
def renewed(tmp_path_factory):
    """Triangles with ``remesh = "auto"``, pressed until no rezoned mesh is within the limits."""
    folder = tmp_path_factory.mktemp("renewed")
    return sw.run(triangles(folder), folder / "run")


def triangles(folder) -> sw.Scenario:
    """Press of triangles as a file."""
    text = TEXT.format(remesh='"auto"', **VISCOUS).replace("0.24 s", "0.56 s")
    text = text.replace("cells = [4, 3]", 'cells = [4, 3], cell = "tri3"').replace('"mean"', '"corner"')
    (file := folder / "triangles.toml").write_text(text)
    return sw.load(file)


@pytest.mark.slow
def test_a_run_with_new_cells(renewed) -> None:
    """Events, audit and frames, whose matter came from the body at the start."""
    assert renewed.status == "done"
    nodes = renewed.history["mesh.nodes"]
    assert nodes[0] == 20 and len(set(nodes)) > 1
    assert main(["audit", str(renewed.path), "--strict"]) == 0
    assert not history_audited(renewed.history)
    assert not any(depths.findings for depths in frames_audited(renewed.fields))
    assert set(renewed.events["contact"][renewed.events["kind"] == MESH]) == {"body"}
    for frame, cells in renewed.fields.with_cells():
        assert len(frame.points) == len(cells.reference)
        begun = frame.points - frame.displacement
        for axis, size in enumerate((1.0, 0.75)):
            assert begun[:, axis].min() == pytest.approx(0.0, abs=0.01)
            assert begun[:, axis].max() == pytest.approx(size, abs=0.02)
        np.testing.assert_allclose(frame.displacement[cells.reference[:, 1] == 0.0, 1], 0.0, atol=1e-14)


def test_probes_with_new_cells(renewed) -> None:
    """No jumps, forces that balance, and speeds of the platen at nodes that came from the top."""
    history = renewed.history
    for name in ("corner", "gone", "flank"):
        growth = np.diff(history[name])
        assert np.abs(np.diff(growth)).max() < 0.5 * growth.max()
    assert history["gone"][-1] > 0.56
    assert history["held"][1:] == pytest.approx(history["contact.platen.force_n"][1:], rel=1e-9)
    assert history["speed"][1:] == pytest.approx(-1.0, abs=1e-9)


@pytest.mark.slow
def test_a_resumed_run_with_new_cells(renewed, tmp_path) -> None:
    """Stopped after the change of the cells, it goes on with the same bits."""
    changed = int(np.flatnonzero(np.diff(renewed.history["mesh.nodes"]))[0]) + 1
    seen = itertools.count(1)

    def stop(progress: object) -> None:
        if next(seen) == changed + 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(triangles(tmp_path), tmp_path / "stopped", progress=stop)
    sw.resume(tmp_path / "stopped")
    assert differences(tmp_path / "stopped", renewed.path) == []


def test_pictures_with_new_cells(renewed, tmp_path) -> None:
    assert main(["plot", str(renewed.path), "--out", str(tmp_path / "picture.png")]) == 0
    assert (tmp_path / "picture.png").is_file() and (tmp_path / "picture_history.png").is_file()


@pytest.mark.slow
def test_the_page_with_new_cells(renewed) -> None:
    pytest.importorskip("trame")
    pytest.importorskip("pyvista")
    from softway.apps.viewer.app import page

    made = page(renewed)
    for k in (0, len(renewed.fields) - 1):
        made.frame(k)
        x = renewed.fields[k].points[:, 0]
        assert made.solids.skin.bounds[:2] == pytest.approx((x.min(), x.max()), abs=1e-6)
