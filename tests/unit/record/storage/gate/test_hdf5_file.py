"""Fields that somebody forged: no other file is read, memory is bounded by the file, no number leads astray."""

import json
import resource
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from softway.apps.cli import main
from softway.errors import InputError
from softway.record.conduct import record_run
from softway.record.run import Run
from softway.record.storage.run_folder import RunFolder
from softway.record.write.fields import open_fields

SECRET = "a secret of the user"


@pytest.fixture
def forged(square, tmp_path) -> Path:
    (tmp_path / "secret").write_text(SECRET)
    with h5py.File(tmp_path / "other.h5", "w") as other:
        other["Points"] = np.ones((4, 3))
    return record_run(square.steps(), square.opening(), RunFolder(out=tmp_path / "run"), title="Made up").path


def again(file: h5py.File, name: str, data: Any = None, **options: Any) -> None:
    del file[name]
    file.create_dataset(name, data=data, **options)


def linked(file: h5py.File, link: object) -> None:
    del file["VTKHDF/Points"]
    file["VTKHDF/Points"] = link


def virtual(file: h5py.File) -> None:
    del file["VTKHDF/Points"]
    layout = h5py.VirtualLayout(shape=(4, 3), dtype=float)
    layout[:] = h5py.VirtualSource("../other.h5", "Points", shape=(4, 3))
    file.create_virtual_dataset("VTKHDF/Points", layout)


def changed(file: h5py.File, name: str, value: float) -> None:
    data = file[name][:]
    data[-1] = value
    file[name][:] = data


HARMS: dict[str, Callable[[h5py.File], object]] = {
    "external link": lambda f: linked(f, h5py.ExternalLink("../other.h5", "/Points")),
    "soft link": lambda f: linked(f, h5py.SoftLink("/reference")),
    "dangling link": lambda f: linked(f, h5py.SoftLink("/nowhere")),
    "external storage": lambda f: again(
        f, "VTKHDF/Points", shape=(2,), dtype="u1", external=[("../secret", 0, h5py.h5f.UNLIMITED)]
    ),
    "virtual": virtual,
    "a trillion numbers": lambda f: again(f, "VTKHDF/Points", shape=(10**12, 3), dtype=float, chunks=(1000, 3)),
    "a huge chunk": lambda f: again(f, "VTKHDF/Points", shape=(10**9, 3), dtype=float, chunks=(10**8, 3)),
    "contiguous": lambda f: again(f, "reference", shape=(10**11, 3), dtype=float),
    "filter": lambda f: again(f, "reference", data=np.zeros((16, 3)), compression="lzf"),
    "objects": lambda f: again(f, "reference", shape=(3,), dtype=h5py.ref_dtype),
    "compound": lambda f: again(f, "reference", data=np.zeros(3, [("a", float)])),
    "type": lambda f: f.create_dataset("kind", data=1) and f.__setitem__("t", np.dtype("f8")),
    "node": lambda f: changed(f, "VTKHDF/Connectivity", 10**9),
    "negative node": lambda f: changed(f, "VTKHDF/Connectivity", -1),
    "offset": lambda f: changed(f, "VTKHDF/Offsets", 10**6),
    "cell": lambda f: changed(f, "VTKHDF/Types", 77),
    "body": lambda f: changed(f, "VTKHDF/CellData/body", 9),
    "points": lambda f: f["VTKHDF/NumberOfPoints"].__setitem__(0, 10**9),
    "steps": lambda f: f["VTKHDF/Steps"].attrs.__setitem__("NSteps", 10**6),
    "no steps": lambda f: f["VTKHDF/Steps"].attrs.__delitem__("NSteps"),
    "no group": lambda f: f.__delitem__("VTKHDF/PointData"),
    "reference": lambda f: again(f, "reference", data=np.zeros((3, 7))),
    "dimension": lambda f: f.attrs.__setitem__("dimension", 9),
    "bodies": lambda f: f.attrs.__setitem__("bodies", "["),
    "deep tools": lambda f: again(f, "tools", data="[" * 100_000),
    "tools": lambda f: again(f, "tools", data="[1, 2]"),
}


@pytest.mark.parametrize("harm", HARMS)
def test_forged_fields_are_named(forged, capsys, harm):
    """With bounded memory, and without a traceback."""
    pytest.importorskip("matplotlib")
    with h5py.File(forged / "fields.vtkhdf", "r+") as file:
        HARMS[harm](file)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    code = main(["plot", str(forged)])
    told = capsys.readouterr()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    assert code == 2 and "fields.vtkhdf" in told.err and SECRET not in told.err + told.out


def test_fields_that_are_whole_are_read(forged):
    run = Run(forged)
    assert len(run.fields) == 11 and run.fields.cells.tools and run.fields[-1].points.shape == (25, 3)


def test_a_run_is_not_resumed_into_forged_fields(forged, square, tmp_path):
    """The file would be opened for writing."""
    with h5py.File(forged / "fields.vtkhdf", "r+") as file:
        linked(file, h5py.ExternalLink("../other.h5", "/Points"))
    before = (tmp_path / "other.h5").read_bytes()
    with pytest.raises(InputError, match="is a link"):
        open_fields(forged, square.opening(), 2)
    assert (tmp_path / "other.h5").read_bytes() == before


TOOLS: dict[str, Any] = {
    "number for shape": {"kind": "Tool", "shape": 5, "motion": {"kind": "Still"}},
    "shape for tool": {"kind": "Sphere", "centre": [0.0, 0.0], "radius": 1.0},
    "text": {"kind": "Tool", "shape": {"kind": "Sphere", "centre": "xy", "radius": 1.0}, "motion": {"kind": "Still"}},
    "dimension": {
        "kind": "Tool", "shape": {"kind": "Sphere", "centre": [0.0] * 9, "radius": 1.0}, "motion": {"kind": "Still"},
    },
    "motion": {"kind": "Tool", "shape": {"kind": "HalfSpace", "point": [0, 0], "normal": [0, 1]}, "motion": 3},
    "list": [1, 2],
    "deep": {"kind": "Cavity", "of": {"kind": "Cavity", "of": {"kind": "Cavity", "of": 3}}},
}  # fmt: skip


@pytest.mark.few(4)
@pytest.mark.parametrize("harm", TOOLS)
def test_tools_that_are_none_are_not_drawn(forged, harm):
    pytest.importorskip("matplotlib")
    with h5py.File(forged / "fields.vtkhdf", "r+") as file:
        again(file, "tools", data=json.dumps({"floor": TOOLS[harm]}))
    assert Run(forged).fields.cells.lost == ("floor",)
    assert main(["plot", str(forged)]) == 0
    shutil.rmtree(forged)
