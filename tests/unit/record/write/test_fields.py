"""fields.vtkhdf: what is written, that VTK opens it, and that it stays readable while it grows."""

import subprocess
import sys
import textwrap
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from softway.marching.results.step_states import KnownStates
from softway.model.field import Field
from softway.record.read.frames import Fields
from softway.record.write.fields import open_fields
from softway.record.write.grid.grid_layout import components, von_mises


def seen_by_vtk(path, k):
    """Frame ``k`` as VTK's own reader gives it, and all instants that it knows."""
    pyvista = pytest.importorskip("pyvista")
    hdf = pytest.importorskip("vtkmodules.vtkIOHDF")
    reader = hdf.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    key = pytest.importorskip("vtkmodules.vtkCommonExecutionModel").vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    times = reader.GetOutputInformation(0).Get(key)
    reader.UpdateTimeStep(times[k])
    return pyvista.wrap(reader.GetOutput()), times


@pytest.fixture
def written(fake, tmp_path):
    recorder = open_fields(tmp_path, fake.opening())
    for step in fake.steps():
        recorder.take(step)
    recorder.close()
    return Fields(tmp_path / "fields.vtkhdf")


def test_frames_hold_the_states(fake, written):
    np.testing.assert_allclose(written.times, np.linspace(0.0, 1.0, 11), atol=1e-14)
    d = fake.mesh.dim
    for frame in written:
        state = fake.state(frame.time)
        np.testing.assert_array_equal(frame.displacement[:, :d], state.displacement["part"])
        np.testing.assert_array_equal(frame.velocity[:, :d], state.velocity["part"])
        np.testing.assert_array_equal(frame.points, written.cells.reference + frame.displacement)
        assert frame.contact_force.sum() == pytest.approx(state.pressure["part.surface-floor"].sum(), rel=1e-14)
        stress = fake.stress(state)
        np.testing.assert_array_equal(frame.stress, components(stress))
        np.testing.assert_array_equal(frame.von_mises, von_mises(stress))
    assert written[-1].time == 1.0
    with pytest.raises(IndexError, match="11 of 11"):
        written[11]


def test_cells_come_back(fake, written):
    cells = written.cells
    assert cells.bodies == ("part",) and cells.dimension == fake.mesh.dim
    assert np.atleast_1d(cells.tools["floor"].shape.normal)[-1] == 1.0
    for name, nodes in cells.blocks().items():
        np.testing.assert_array_equal(nodes, fake.mesh.blocks[name])


def test_vtk_opens_every_frame(written):
    for k in (0, 5, 10):
        (grid, times), frame = seen_by_vtk(written.path, k), written[k]
        np.testing.assert_array_equal(times, written.times)
        np.testing.assert_array_equal(grid.points, frame.points)
        np.testing.assert_array_equal(grid.celltypes, written.cells.types)
        np.testing.assert_array_equal(grid.cell_connectivity, written.cells.connectivity)
        for name in ("displacement", "velocity", "contact_force"):
            np.testing.assert_array_equal(grid.point_data[name], getattr(frame, name))
        np.testing.assert_array_equal(grid.cell_data["stress"], frame.stress)
        np.testing.assert_array_equal(grid.cell_data["body"], 0)


def test_pyvista_opens_the_file(written):
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.get_reader(str(written.path)).read()
    np.testing.assert_array_equal(grid.points, written[0].points)


def test_vtk_finds_the_reference_size(fake, written):
    """Node orders are right when VTK's own cells fill the unit body."""
    pytest.importorskip("pyvista")
    grid = written.to_pyvista(4)
    grid.points = written.cells.reference
    sizes = grid.compute_cell_sizes()
    kind = {1: "Length", 2: "Area", 3: "Volume"}[fake.mesh.cell_dim]
    assert abs(sizes.cell_data[kind].sum()) == pytest.approx(1.0, rel=1e-6)
    np.testing.assert_array_equal(grid.cell_data["von_mises"], written[4].von_mises)


def test_readable_while_it_grows(bar, tmp_path):
    recorder = open_fields(tmp_path, bar.opening())
    fields = Fields(tmp_path / "fields.vtkhdf")
    lengths = []
    for step in bar.steps():
        recorder.take(step)
        lengths.append(len(fields))
    recorder.close()
    assert lengths[0] == 1 and lengths[-1] == len(fields) == 11 and sorted(lengths) == lengths


def test_readable_after_a_kill_between_frames(tmp_path):
    """The process ends without closing anything."""
    program = """
        import os, sys
        sys.path.insert(0, sys.argv[1])
        from conftest import Fake, MESHES
        from pathlib import Path
        from softway.record.write.fields import open_fields
        fake = Fake(MESHES["tet10"]())
        recorder = open_fields(Path(sys.argv[2]), fake.opening())
        for step in fake.steps():
            recorder.take(step)
            if step.after.time > 0.52:
                os._exit(9)
    """
    here = str(Path(__file__).parents[1])
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(program), here, str(tmp_path)], check=False)
    assert done.returncode == 9
    fields = Fields(tmp_path / "fields.vtkhdf")
    assert len(fields) == 6 and fields[5].time == pytest.approx(0.5)
    grid, times = seen_by_vtk(fields.path, 5)
    assert len(times) == 6
    np.testing.assert_array_equal(grid.points, fields[5].points)


def test_a_frame_cut_short_is_not_counted(bar, tmp_path):
    """Data that no count announces are ignored by both readers, and overwritten by the next frame."""
    recorder = open_fields(tmp_path, bar.opening())
    recorder.take(next(s for s in bar.steps() if s.after.time > 0.09))
    recorder.close()
    with h5py.File(tmp_path / "fields.vtkhdf", "r+") as file:
        for name in ("Points", "PointData/velocity", "Steps/Values", "Steps/PointOffsets"):
            series = file["VTKHDF"][name]
            series.resize(series.shape[0] + 1, axis=0)
    fields = Fields(tmp_path / "fields.vtkhdf")
    assert len(fields) == len(fields.times) == 2
    grid, times = seen_by_vtk(fields.path, 1)
    assert len(times) == 2
    np.testing.assert_array_equal(grid.points, fields[1].points)


def test_von_mises_of_shear():
    """Pure shear tau gives sqrt(3) tau."""
    stress = np.zeros((1, 3, 3))
    stress[0, 0, 1] = stress[0, 1, 0] = 2.0
    assert von_mises(stress)[0] == pytest.approx(2.0 * np.sqrt(3.0), rel=1e-15)
    assert components(stress).tolist() == [[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]]


def test_companion_fields_are_written_with_their_units(fake, tmp_path):
    opening = fake.opening()
    n = fake.mesh.n_nodes
    heat = np.linspace(1.0, 2.0, n)[:, None]
    fields = (
        Field(name="displacement", unit="m", components=fake.mesh.dim),
        Field(name="heat", unit="J", components=1),
    )
    start = replace(opening.initial, fields={"heat": {"part": heat}})
    recorder = open_fields(tmp_path, replace(opening, initial=start, fields=fields))
    for step in fake.steps():
        after = replace(step.after, fields={"heat": {"part": heat + step.after.time}})
        recorder.take(replace(step, states=replace(KnownStates.of(step.states), after=after)))
    recorder.close()
    with h5py.File(tmp_path / "fields.vtkhdf") as file:
        found = file["VTKHDF/PointData/heat"]
        assert found.attrs["unit"] == "J" and file["VTKHDF/PointData/displacement"].attrs["unit"] == "m"
        np.testing.assert_array_equal(found[:n], heat[:, 0])
        np.testing.assert_allclose(found[-n:], heat[:, 0] + 1.0, atol=1e-14)
