"""fields.vtkhdf: deformed solids with their fields at a series of instants, in one file for ParaView, PyVista and h5py.

The file follows VTK's HDF format 2.0 for a transient unstructured grid with constant cells.  Data are written before
the counts that refer to them, and an incomplete frame is removed.  A run that is killed therefore leaves all complete
frames.
Reference: VTK documentation, *VTKHDF file format*.
"""

import json
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from softway.arrays import Array
from softway.bodies.solid import Tool
from softway.errors import InputError
from softway.march.results.step import Step
from softway.model.scene import Scene, State
from softway.record.storage.gate.hdf5_file import BROKEN, require_plain
from softway.record.storage.journal import JournaledFile, undone
from softway.record.storage.uninterrupted import uninterrupted
from softway.record.write.grid_layout import Layout, components, layout, von_mises
from softway.record.write.recorder import RunStart
from softway.record.write.tool_shapes import stored

FILE = "fields.vtkhdf"
POINT_DATA = {"displacement": "m", "velocity": "m/s", "contact_force": "N"}
CELL_DATA = {"stress": "Pa", "von_mises": "Pa"}
"""Names and units of the fields in every frame."""
MORE = {"contact_pressure": "Pa", "tangential_traction": "Pa", "dissipation": "J/m^3"}
"""Units of the further fields of a run with contact, friction or a history-dependent law; other fields have none."""
PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
CHUNK = 65536
REMEDY = "a new run, or a copy of the file"
SIZES = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Frames:
    """Open file ``fields.vtkhdf``.

    A frame is written when the time passes a multiple of ``fields_every``, and at the end.  ``before`` is the number of
    frames in the file before the first change of ``guarded``.
    """

    file: h5py.File
    guarded: JournaledFile
    before: int
    layout: Layout
    opening: RunStart

    def take(self, step: Step) -> None:
        """Write a frame if one is due at the end of the slab."""
        if self.opening.frame_due(step.before.time, step.after.time):
            frame = _frame(self.layout, self.opening, step.after)
            uninterrupted(lambda: self._write(frame, step.after.time))

    def _write(self, frame: Mapping[str, Mapping[str, Array]], time: float) -> None:
        with _changing(self.guarded):
            _append(self.file, self.layout.reference, frame, time)

    @property
    def mark(self) -> int:
        """Number of frames."""
        return self.before + self.guarded.changes

    def sync(self) -> None:
        """Flush the frames to the disk."""
        self.guarded.sync()

    def close(self) -> None:
        """Close the file and remove an incomplete frame."""
        uninterrupted(self._close)

    def _close(self) -> None:
        with ExitStack() as closing:
            closing.callback(self.guarded.close)
            closing.callback(self.file.close)
            if not self.guarded.broken:
                self.guarded.begin()


def open_fields(folder: Path, opening: RunStart, mark: int | None = None) -> Frames:
    """Create ``fields.vtkhdf`` with the cells and the frame of the initial state, or continue it after ``mark`` frames.

    Raises
    ------
    InputError
        If the file has fewer frames.
    """
    path, cells = folder / FILE, layout(opening.meshes, opening.touching)
    first = _frame(cells, opening, opening.initial) if mark is None else {}
    file, guarded = uninterrupted(lambda: _opened(path, cells, opening, first, mark), _close_all)
    return Frames(file=file, guarded=guarded, before=(mark or 1) - 1, layout=cells, opening=opening)


def _close_all(opened: tuple[h5py.File, JournaledFile]) -> None:
    for file in opened:
        file.close()


def _opened(
    path: Path, cells: Layout, opening: RunStart, first: Mapping[str, Mapping[str, Array]], mark: int | None
) -> tuple[h5py.File, JournaledFile]:
    """Open the file and write its first frame, or truncate it to ``mark`` frames."""
    undone(path)
    if mark is not None and not path.is_file():
        raise InputError(str(path), "is missing", REMEDY)
    with ExitStack() as failing:
        guarded = JournaledFile(path, new=mark is None)
        failing.callback(guarded.close)
        with _changing(guarded):
            file = _file(path, guarded, new=mark is None)
            failing.callback(file.close)
            if mark is None:
                units = {f.name: f.unit for f in opening.fields}
                _write_cells(file, cells, opening.scene, first, units)
                _append(file, cells.reference, first, opening.initial.time)
            else:
                _cut(path, file, mark)
        failing.pop_all()
    return file, guarded


def _file(path: Path, guarded: JournaledFile, new: bool) -> h5py.File:
    """Open the guarded file with h5py."""
    try:
        return h5py.File(guarded, "w" if new else "r+")
    except OSError as error:
        if new:
            raise
        raise InputError(str(path), f"is damaged: {error}", REMEDY) from None


@contextmanager
def _changing(guarded: JournaledFile) -> Iterator[None]:
    """Context of one change of the file: it is committed at the end, or undone when the file is closed."""
    try:
        guarded.begin()
        yield
        guarded.commit()
    except BaseException:
        guarded.give_up()
        raise


def _cut(path: Path, file: h5py.File, mark: int) -> None:
    """Truncate the file of an earlier part of the run to ``mark`` frames."""
    try:
        require_plain(file)
        root = file["VTKHDF"]
        steps = root["Steps"]
        count = int(steps.attrs["NSteps"])
    except BROKEN as error:
        raise InputError(str(path), f"is damaged: {error}", REMEDY) from None
    if count < mark:
        raise InputError(str(path), f"has {count} frames, but {mark} at the checkpoint", REMEDY)
    steps.attrs["NSteps"] = np.int64(mark)
    sizes = dict(zip(SIZES, (int(root[name][0]) for name in SIZES), strict=True))
    _shorten(root["Points"], mark * sizes["NumberOfPoints"])
    for group, size in (("PointData", "NumberOfPoints"), ("CellData", "NumberOfCells")):
        for name, series in steps[f"{group}Offsets"].items():
            _shorten(root[group][name], mark * sizes[size])
            _shorten(series, mark)
    for series in steps.values():
        if isinstance(series, h5py.Dataset):
            _shorten(series, mark)
    file.flush()


def _shorten(series: h5py.Dataset, rows: int) -> None:
    if len(series) > rows:
        series.resize(rows, axis=0)


def _frame(cells: Layout, opening: RunStart, state: State) -> dict[str, dict[str, Array]]:
    stress = np.concatenate([opening.stresses[name](state) for name in cells.bodies])
    force = cells.forces(state.pressure)
    return {
        "PointData": {
            **_tractions(cells, opening, state, force),
            "displacement": cells.nodal(state.displacement),
            "velocity": cells.nodal(state.velocity),
            "contact_force": force,
            **{name: np.concatenate([values[body] for body in cells.bodies]) for name, values in state.fields.items()},
        },
        "CellData": {**_past(cells, opening, state), "stress": components(stress), "von_mises": von_mises(stress)},
    }


def _tractions(cells: Layout, opening: RunStart, state: State, force: Array) -> dict[str, Array]:
    """Contact pressure (n,) and, with friction, tangential traction (n, 3) [Pa]."""
    if opening.spread is None:
        return {}
    if not state.traction:
        return {"contact_pressure": opening.spread(state, force[:, None])[:, 0]}
    found = opening.spread(state, np.column_stack([force, cells.tangential(state.traction)]))
    return {"contact_pressure": found[:, 0], "tangential_traction": found[:, 1:]}


def _past(cells: Layout, opening: RunStart, state: State) -> dict[str, Array]:
    """History variables (e,) of the cells by name; zero in solids without history."""
    found = [opening.remembered[name](state) if name in opening.remembered else {} for name in cells.bodies]
    counts = [mesh.n_cells for mesh in opening.meshes.values()]
    names = dict.fromkeys(name for one in found for name in one if name.isidentifier())
    return {
        name: np.concatenate([one.get(name, np.zeros(n)) for one, n in zip(found, counts, strict=True)])
        for name in names
    }


def _write_cells(
    file: h5py.File, cells: Layout, scene: Scene, first: Mapping[str, Mapping[str, Array]], units: Mapping[str, str]
) -> None:
    """Write the constant data, and create empty series for the data that change from frame to frame."""
    n, e = len(cells.reference), len(cells.types)
    root = file.create_group("VTKHDF")
    root.attrs["Version"] = np.array([2, 0])
    root.attrs["Type"] = np.bytes_("UnstructuredGrid")
    for name, size in zip(SIZES, (n, e, len(cells.connectivity)), strict=True):
        root[name] = np.array([size])
    root["Connectivity"], root["Offsets"] = cells.connectivity, cells.offsets
    root["Types"] = cells.types.astype(np.uint8)
    _series(root, "Points", (3,), n, "m")
    steps = root.create_group("Steps")
    _series(steps, "Values", (), 1, "s")
    for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
        _series(steps, name, (), 1, dtype=np.int64)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        _series(steps, name, (1,), 1, dtype=np.int64)
    units = {**MORE, **POINT_DATA, **CELL_DATA, **units}
    for group, rows in (("PointData", n), ("CellData", e)):
        for name, data in first[group].items():
            _series(root.require_group(group), name, data.shape[1:], rows, units.get(name, ""))
            _series(steps.require_group(f"{group}Offsets"), name, (), 1, dtype=np.int64)
    root["CellData/body"] = cells.body.astype(np.int32)
    _series(steps["CellDataOffsets"], "body", (), 1, dtype=np.int64)
    file.attrs["bodies"] = json.dumps(list(cells.bodies))
    file.attrs["dimension"] = cells.dimension
    file["reference"] = cells.reference
    points = cells.reference[:, : cells.dimension]
    tools = {name: stored(body, points) for name, body in scene.bodies.items() if isinstance(body, Tool)}
    file["tools"] = json.dumps(tools)
    rigid = {} if scene.mechanism is None else scene.mechanism.bodies
    shapes = {name: stored(Tool(shape=body.shape), points) for name, body in rigid.items() if body.shape is not None}
    file["rigid"] = json.dumps(shapes)
    steps.attrs["NSteps"] = np.int64(0)


def _series(
    group: h5py.Group, name: str, shape: tuple[int, ...], rows: int, unit: str = "", dtype: Any = float
) -> None:
    """Create an empty array that grows by ``rows`` along its first axis in each frame."""
    chunks = (max(1, min(rows if rows > 1 else 256, CHUNK)), *shape)
    packed = PACKED if rows > 1 else {}
    made = group.create_dataset(name, (0, *shape), dtype, maxshape=(None, *shape), chunks=chunks, **packed)
    if unit:
        made.attrs["unit"] = unit


def _append(file: h5py.File, reference: Array, frame: Mapping[str, Mapping[str, Array]], time: float) -> None:
    """Write one frame: first the data, then their offsets, then the number of frames."""
    root = file["VTKHDF"]
    steps, k = root["Steps"], int(root["Steps"].attrs["NSteps"])
    n, e = (int(root[name][0]) for name in SIZES[:2])
    _put(root["Points"], k * n, reference + frame["PointData"]["displacement"])
    for group, rows in (("PointData", n), ("CellData", e)):
        for name, data in frame[group].items():
            _put(root[group][name], k * rows, data)
            _put(steps[f"{group}Offsets"][name], k, np.array([k * rows]))
    _put(steps["CellDataOffsets/body"], k, np.array([0]))
    _put(steps["PartOffsets"], k, np.array([0]))
    _put(steps["NumberOfParts"], k, np.array([1]))
    _put(steps["PointOffsets"], k, np.array([k * n]))
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        _put(steps[name], k, np.array([[0]]))
    _put(steps["Values"], k, np.array([time]))
    file.flush()
    steps.attrs["NSteps"] = np.int64(k + 1)
    file.flush()


def _put(series: h5py.Dataset, start: int, data: Array) -> None:
    series.resize(start + len(data), axis=0)
    series[start:] = data
