"""Runs whose meshes change between slabs: their frames, probes, events, pictures, resumption and damaged files."""

import itertools
import shutil
from functools import partial

import h5py
import numpy as np
import pytest

import softway as sw
from records import differences
from softway.apps.cli import main
from softway.errors import InputError
from softway.meshes.adaptive.adapt import Adapt
from softway.record.audit.folder import frames_audited
from softway.record.read.summary import summarise
from softway.record.read.world_lines import changes, ends, mesh_lines
from softway.record.view.film import film
from softway.record.view.options import PictureOptions
from softway.record.view.plots.panels import world
from softway.record.write.events import MESH
from softway.record.write.grid.grid_layout import layout
from softway.record.write.grid.grid_series import GridFrame, continue_series, create_series

SHORT = PictureOptions(dpi=40, times=(0.0, 0.3))
"""Small pictures of the first part of a run, in which its mesh changes."""


def bar_on_a_wall() -> sw.Scenario:
    """A bar thrown at a wall, with probes at a tag, at a node of its base mesh and between nodes."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=8),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=0.1),
        adapt=Adapt(levels=2, contact_cells=4),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.01, normal=-1.0))
    probes = [
        sw.Probe(name="rear", of="bar", tag="left", quantity="position"),
        sw.Probe(name="middle", of="bar", at=(0.5,), quantity="velocity"),
        sw.Probe(name="third", of="bar", at=(0.34,), quantity="displacement"),
    ]
    return sw.Scenario(
        title="bar",
        bodies={"bar": bar, "wall": wall},
        contacts=[sw.Contact(between=("bar.right", "wall"))],
        time=sw.Time(end=0.7, step=0.02),
        output=sw.Output(fields_every=0.02, probes=probes),
    )


def disc_on_a_floor(cell: str = "tri3") -> sw.Scenario:
    """A disc that falls on a floor, with a probe at its rim."""
    disc = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=8, cell=cell),
        material=sw.LinearElastic(E=10.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -0.2)),
        adapt=Adapt(levels=2, tolerance=2.0, contact_cells=2, buffer=1),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.01), normal=(0.0, 1.0)))
    probe = sw.Probe(name="rim", of="disc", tag="surface", quantity="position", component="y")
    return sw.Scenario(
        title="disc",
        bodies={"disc": disc, "floor": floor},
        contacts=[sw.Contact(between=("disc.surface", "floor"))],
        time=sw.Time(end=0.8),
        output=sw.Output(probes=[probe], fields_every=0.05),
    )


SCENES = {"bar": bar_on_a_wall, "disc": disc_on_a_floor, "quads": partial(disc_on_a_floor, "quad4")}


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    return {name: sw.run(made(), tmp_path_factory.mktemp("changing") / name) for name, made in SCENES.items()}


@pytest.fixture(params=SCENES)
def run(request, runs):
    return runs[request.param]


@pytest.fixture
def bar(runs):
    return runs["bar"]


def sizes(cells) -> np.ndarray:
    """Lengths or areas of the cells at rest."""
    x = cells.reference[cells.connectivity.reshape(len(cells.types), -1)]
    if x.shape[1] == 2:
        return np.abs(x[:, 1, 0] - x[:, 0, 0])
    return 0.5 * np.cross(x, np.roll(x, -1, axis=1)).sum(axis=1)[:, 2]


@pytest.mark.slow
def test_frames_have_their_own_cells(run):
    """The cells of every frame fill the body; there are as many nodes as the history says."""
    fields, history = run.fields, run.history
    part = fields.geometries
    assert len(part) == len(fields) and part[0] == 0 and set(np.diff(part)) == {0, 1} and changes(run)
    whole = sizes(fields.cells).sum()
    for k, (frame, cells) in enumerate(fields.with_cells()):
        row = int(np.argmin(np.abs(history["time"] - frame.time)))
        assert frame.geometry == part[k] and len(cells.reference) == history["mesh.nodes"][row]
        np.testing.assert_array_equal(frame.points, cells.reference + frame.displacement)
        assert len(frame.stress) == len(cells.types) == len(cells.body)
        assert (sizes(cells) > 0.0).all()
        if cells.reference[:, 1].any():  # a disc, which is round where its cells are small
            assert whole * (1.0 - 1e-12) <= sizes(cells).sum() < np.pi
        else:
            assert sizes(cells).sum() == pytest.approx(whole, rel=1e-12)
        np.testing.assert_array_equal(fields.cells_of(frame).connectivity, cells.connectivity)
    assert len({len(frame.points) for frame in fields}) > 2


def test_vtk_opens_every_frame_with_its_cells(run):
    """The reader of VTK, which ParaView uses, and PyVista have the cells and fields of each instant."""
    pyvista = pytest.importorskip("pyvista")
    hdf = pytest.importorskip("vtkmodules.vtkIOHDF")
    reader = hdf.vtkHDFReader()
    reader.SetFileName(str(run.path / "fields.vtkhdf"))
    reader.UpdateInformation()
    key = pytest.importorskip("vtkmodules.vtkCommonExecutionModel").vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    times = reader.GetOutputInformation(0).Get(key)
    np.testing.assert_array_equal(times, run.fields.times)
    for k, (frame, cells) in enumerate(run.fields.with_cells()):
        reader.UpdateTimeStep(times[k])
        for grid in (pyvista.wrap(reader.GetOutput()), run.fields.to_pyvista(k)):
            np.testing.assert_array_equal(grid.points, frame.points)
            np.testing.assert_array_equal(grid.celltypes, cells.types)
            padded = np.insert(cells.connectivity, cells.offsets[:-1], np.diff(cells.offsets))
            np.testing.assert_array_equal(grid.cells, padded)
            np.testing.assert_array_equal(grid.point_data["velocity"], frame.velocity)
            np.testing.assert_array_equal(grid.cell_data["stress"], frame.stress)
            np.testing.assert_array_equal(grid.cell_data["body"], cells.body)


def test_probes_read_the_same_places_on_every_mesh(bar):
    """A node of the base mesh is itself, other places lie between the nodes of their cell."""
    history, fields = bar.history, bar.fields
    for frame, cells in fields.with_cells():
        row = int(np.argmin(np.abs(history["time"] - frame.time)))
        x = cells.reference[:, 0]
        middle = int(np.argmin(np.abs(x - 0.5)))
        assert history["middle"][row] == pytest.approx(frame.velocity[middle, 0], abs=1e-15)
        order = np.argsort(x)
        between = np.interp(0.34, x[order], frame.displacement[order, 0])
        assert history["third"][row] == pytest.approx(between, abs=1e-14)
        assert history["rear"][row] == pytest.approx(frame.points[np.argmin(x), 0], abs=1e-15)


def test_a_tag_has_the_mean_of_its_nodes_of_the_base_mesh(runs):
    run = runs["disc"]
    base = sw.meshes.Disc(radius=1.0, cells=8, cell="tri3").build()
    rim = base.points[base.nodes("surface")]
    for frame, cells in run.fields.with_cells():
        row = int(np.argmin(np.abs(run.history["time"] - frame.time)))
        near = np.linalg.norm(cells.reference[:, None, :2] - rim, axis=2).argmin(axis=0)
        assert run.history["rim"][row] == pytest.approx(frame.points[near, 1].mean(), abs=1e-13)


def test_events_and_summary_tell_the_changes(run, capsys):
    events, history = run.events, run.history
    mine = events["kind"] == MESH
    assert mine.sum() >= 3 and set(events["contact"][mine]) == {run.fields.cells.bodies[0]}
    assert (np.diff(events["time"]) >= 0.0).all()
    for time, text in zip(events["time"][mine], events["finding"][mine], strict=True):
        after = int(np.flatnonzero(history["time"] > time * (1.0 + 1e-12))[0])
        assert text.startswith(f"{history['mesh.nodes'][after]:.0f} nodes, ")
    told = summarise(history, events)
    nodes = history["mesh.nodes"]
    assert told["mesh"] == {
        "changes": mine.sum(),
        "most_nodes": nodes.max(),
        "mean_nodes": pytest.approx(nodes[1:].mean()),
    }
    assert told["findings"] == [] and run.status == "done"
    assert main(["show", str(run.path)]) == 0
    assert "meshes that change" in capsys.readouterr().out
    assert f"{mine.sum()} changes, at most" in run._repr_html_()


def test_the_audit_looks_at_every_mesh(run, capsys):
    found = list(frames_audited(run.fields))
    assert len(found) == len(run.fields) - 1 and not any(depths.findings for depths in found)
    assert np.isfinite(run.history["certificate.gap_nodes"]).sum() >= 2
    assert main(["audit", str(run.path), "--strict"]) == 0


def test_the_space_time_mesh_has_the_nodes_of_every_frame(bar):
    """At the time of each frame the lines pass through its nodes, and no others."""
    lines = mesh_lines(bar, 0)
    history, changed = bar.history["time"], bar.events["time"][bar.events["kind"] == MESH]
    inside = {float(history[np.argmin(np.abs(history - time))]) for time in changed}
    for frame in bar.fields:
        here = [line for line in lines if line[0, 0] <= frame.time <= line[-1, 0]]
        places = np.array([np.interp(frame.time, line[:, 0], line[:, 1]) for line in here])
        if frame.time not in inside:  # where a mesh ends and the next one begins, both are there
            np.testing.assert_allclose(np.sort(places), np.sort(frame.points[:, 0]), atol=1e-12)
    track, _, (low, high) = ends(bar, 0)
    assert (track[:, 1] > track[:, 0]).all() and low == track.min() and high == track.max()


@pytest.mark.slow
@pytest.mark.few(2)
def test_pictures_and_films(run, tmp_path):
    assert main(["plot", str(run.path), "--out", str(tmp_path / "picture.png")]) == 0
    assert (tmp_path / "picture.png").is_file() and (tmp_path / "picture_history.png").is_file()
    assert film(run, tmp_path / "film.gif", SHORT).stat().st_size > 1000
    drawing = world(run)
    assert drawing is not None and drawing.end == pytest.approx(run.history["time"][-1])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["bar", "disc"])
def test_the_page_shows_each_mesh(runs, name):
    pytest.importorskip("trame")
    pytest.importorskip("pyvista")
    from softway.apps.viewer.app import page
    from softway.apps.viewer.shown import events_of

    run = runs[name]
    made = page(run)
    made.server.state.enlarged = False
    cells = []
    for k in (0, len(run.fields) - 1):
        made.frame(k)
        x = run.fields[k].points[:, 0]
        assert made.solids.skin.bounds[:2] == pytest.approx((x.min(), x.max()), abs=1e-6)
        cells.append(made.solids.skin.n_cells)
    assert cells[0] != cells[1]
    assert MESH not in {event["kind"] for event in events_of(run)}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "after"), [("bar", 3), ("bar", 20), ("disc", 13), ("quads", 10)])
def test_a_resumed_run_has_the_same_bits(runs, tmp_path, name, after):
    seen = itertools.count(1)

    def stop(progress: object) -> None:
        if next(seen) == after:
            raise KeyboardInterrupt

    folder = tmp_path / "stopped"
    with pytest.raises(KeyboardInterrupt):
        sw.run(SCENES[name](), folder, progress=stop)
    sw.resume(folder)
    assert differences(folder, runs[name].path) == []


def copy(run, tmp_path):
    """Copy of the file of the fields of a run in a folder of its own."""
    shutil.copytree(run.path, tmp_path / "run")
    return tmp_path / "run" / "fields.vtkhdf"


def test_a_continued_file_forgets_later_meshes(bar, tmp_path):
    file = copy(bar, tmp_path)
    part = bar.fields.geometries
    for mark in (len(part) - 1, int(np.searchsorted(part, 2)), 1):
        continue_series(file, mark).close()
        cut = sw.Run(file.parent).fields
        assert len(cut) == mark
        np.testing.assert_array_equal(cut[-1].points, bar.fields[mark - 1].points)
        with h5py.File(file) as stored:
            root, count = stored["VTKHDF"], int(part[mark - 1]) + 1
            assert len(root["NumberOfCells"]) == count
            assert len(root["Offsets"]) == root["NumberOfCells"][:].sum() + count
            assert len(root["Connectivity"]) == root["NumberOfConnectivityIds"][:].sum()
            assert len(stored["reference"]) == root["NumberOfPoints"][:].sum()


def test_a_frame_that_fails_leaves_no_mesh(tmp_path):
    """The mesh of a frame is there with the frame, or not at all."""
    file = tmp_path / "fields.vtkhdf"
    grids = [layout({"part": sw.meshes.Interval(length=1.0, cells=k).build()}, {}) for k in (2, 3)]

    def frame(grid, count):
        at_points = {"u": 0.0 * grid.reference}
        return GridFrame(time=0.0, points=grid.reference, at_points=at_points, in_cells={"s": np.zeros(count)})

    series = create_series(file, grids[0], frame(grids[0], 2), {}, {"tools": {}}, grows=True)
    with pytest.raises(ValueError, match="5 values of s on a grid with 3"):
        series.write(frame(grids[1], 5), grids[1])
    series.close()
    series = continue_series(file, 1)
    series.write(frame(grids[1], 3), grids[1])
    series.close()
    with h5py.File(file) as stored:
        assert stored["VTKHDF/NumberOfCells"][:].tolist() == [2, 3]
        assert stored["VTKHDF/Steps/PartOffsets"][:].tolist() == [0, 1]


DAMAGES = {
    "a part that is not there": ("Steps/PartOffsets", -1, 10_000),
    "a negative part": ("Steps/PartOffsets", -1, -1),
    "more cells": ("NumberOfCells", 1, 10_000),
    "a negative size": ("NumberOfPoints", 1, -5),
    "a node that is not there": ("Connectivity", -1, 10_000),
    "cells that overlap": ("Offsets", -1, 1),
    "a wrong kind of cell": ("Types", -1, 9),
    "another body": ("CellData/body", -1, 7),
}


@pytest.mark.few(3)
@pytest.mark.parametrize("what", DAMAGES)
def test_damaged_meshes_are_refused(bar, tmp_path, what):
    file = copy(bar, tmp_path)
    name, row, value = DAMAGES[what]
    with h5py.File(file, "r+") as stored:
        stored["VTKHDF"][name][row] = value
    fields = sw.Run(file.parent).fields
    with pytest.raises(InputError, match="damaged"):
        list(fields.with_cells())


def test_meshes_that_stay_are_stored_once(tmp_path):
    """Arrays of constant length, as ever."""
    still = bar_on_a_wall()
    made = sw.Scenario(
        bodies={"bar": sw.Solid(mesh=still.bodies["bar"].mesh, material=sw.LinearElastic(E=1.0), density=1.0)},
        time=sw.Time(end=0.1, step=0.02),
    )
    run = sw.run(made, tmp_path / "run")
    with h5py.File(run.path / "fields.vtkhdf") as stored:
        for name in ("Connectivity", "Offsets", "Types", "NumberOfPoints", "CellData/body"):
            assert stored["VTKHDF"][name].chunks is None
        assert not stored["VTKHDF/Steps/PartOffsets"][:].any()
    assert not changes(run) and "mesh.nodes" not in run.history and run.summary["mesh"] == {}
