"""Series of frames of one unstructured grid in a file for ParaView, PyVista and h5py.

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
from softway.errors import InputError
from softway.record.storage.gate.hdf5_file import BROKEN, require_plain
from softway.record.storage.journal import JournaledFile, undone
from softway.record.storage.uninterrupted import uninterrupted
from softway.record.write.grid.grid_layout import Grid

PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
CHUNK = 65536
REMEDY = "a new run, or a copy of the file"
SIZES = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GridFrame:
    """Frame of a grid at an instant [s]: points (n, 3) [m], and arrays by name at the points (n, ...) and in the cells
    (e, ...).
    """

    time: float
    points: Array
    at_points: Mapping[str, Array]
    in_cells: Mapping[str, Array]

    @property
    def groups(self) -> dict[str, Mapping[str, Array]]:
        """Arrays by the name of their group in the file."""
        return {"PointData": self.at_points, "CellData": self.in_cells}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GridSeries:
    """Open file of frames; ``before`` is the number of frames in it before the first change of ``guarded``."""

    file: h5py.File
    guarded: JournaledFile
    before: int

    def write(self, frame: GridFrame) -> None:
        """Write a frame completely, or not at all."""
        uninterrupted(lambda: self._write(frame))

    def _write(self, frame: GridFrame) -> None:
        with _changing(self.guarded):
            _append(self.file, frame)

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


def create_series(
    path: Path, grid: Grid, first: GridFrame, units: Mapping[str, str], about: Mapping[str, Mapping[str, Any]]
) -> GridSeries:
    """Create a file with the cells and the first frame.

    Parameters
    ----------
    path
        File.
    grid
        Points and cells.
    first
        First frame; its arrays are those of all frames.
    units
        Units of the arrays.
    about
        Further plain data by name, such as shapes of tools.
    """
    file, guarded = uninterrupted(lambda: _opened(path, grid, first, units, about), _close_all)
    return GridSeries(file=file, guarded=guarded, before=0)


def continue_series(path: Path, mark: int) -> GridSeries:
    """Continue a file after ``mark`` frames.

    Raises
    ------
    InputError
        If the file has fewer frames.
    """
    file, guarded = uninterrupted(lambda: _reopened(path, mark), _close_all)
    return GridSeries(file=file, guarded=guarded, before=mark - 1)


def _close_all(opened: tuple[h5py.File, JournaledFile]) -> None:
    for file in opened:
        file.close()


def _opened(
    path: Path, grid: Grid, first: GridFrame, units: Mapping[str, str], about: Mapping[str, Mapping[str, Any]]
) -> tuple[h5py.File, JournaledFile]:
    """Open a new file and write its first frame."""
    undone(path)
    with ExitStack() as failing:
        guarded = JournaledFile(path, new=True)
        failing.callback(guarded.close)
        with _changing(guarded):
            file = _file(path, guarded, new=True)
            failing.callback(file.close)
            _write_cells(file, grid, first, units)
            for name, data in about.items():
                file[name] = json.dumps(data)
            _append(file, first)
        failing.pop_all()
    return file, guarded


def _reopened(path: Path, mark: int) -> tuple[h5py.File, JournaledFile]:
    """Open a file and truncate it to ``mark`` frames."""
    undone(path)
    if not path.is_file():
        raise InputError(str(path), "is missing", REMEDY)
    with ExitStack() as failing:
        guarded = JournaledFile(path, new=False)
        failing.callback(guarded.close)
        with _changing(guarded):
            file = _file(path, guarded, new=False)
            failing.callback(file.close)
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


def _write_cells(file: h5py.File, grid: Grid, first: GridFrame, units: Mapping[str, str]) -> None:
    """Write the constant data, and create empty series for the data that change from frame to frame."""
    n, e = len(grid.reference), len(grid.types)
    root = file.create_group("VTKHDF")
    root.attrs["Version"] = np.array([2, 0])
    root.attrs["Type"] = np.bytes_("UnstructuredGrid")
    for name, size in zip(SIZES, (n, e, len(grid.connectivity)), strict=True):
        root[name] = np.array([size])
    root["Connectivity"], root["Offsets"] = grid.connectivity, grid.offsets
    root["Types"] = grid.types.astype(np.uint8)
    _series(root, "Points", (3,), n, "m")
    steps = root.create_group("Steps")
    _series(steps, "Values", (), 1, "s")
    for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
        _series(steps, name, (), 1, dtype=np.int64)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        _series(steps, name, (1,), 1, dtype=np.int64)
    for (group, arrays), rows in zip(first.groups.items(), (n, e), strict=True):
        for name, data in arrays.items():
            _series(root.require_group(group), name, data.shape[1:], rows, units.get(name, ""))
            _series(steps.require_group(f"{group}Offsets"), name, (), 1, dtype=np.int64)
    root["CellData/body"] = grid.body.astype(np.int32)
    _series(steps["CellDataOffsets"], "body", (), 1, dtype=np.int64)
    file.attrs["bodies"] = json.dumps(list(grid.bodies))
    file.attrs["dimension"] = grid.dimension
    file["reference"] = grid.reference
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


def _append(file: h5py.File, frame: GridFrame) -> None:
    """Write one frame: first the data, then their offsets, then the number of frames."""
    root = file["VTKHDF"]
    steps, k = root["Steps"], int(root["Steps"].attrs["NSteps"])
    n, e = (int(root[name][0]) for name in SIZES[:2])
    _put(root["Points"], k * n, frame.points)
    for (group, arrays), rows in zip(frame.groups.items(), (n, e), strict=True):
        for name, data in arrays.items():
            _put(root[group][name], k * rows, data)
            _put(steps[f"{group}Offsets"][name], k, np.array([k * rows]))
    _put(steps["CellDataOffsets/body"], k, np.array([0]))
    _put(steps["PartOffsets"], k, np.array([0]))
    _put(steps["NumberOfParts"], k, np.array([1]))
    _put(steps["PointOffsets"], k, np.array([k * n]))
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        _put(steps[name], k, np.array([[0]]))
    _put(steps["Values"], k, np.array([frame.time]))
    file.flush()
    steps.attrs["NSteps"] = np.int64(k + 1)
    file.flush()


def _put(series: h5py.Dataset, start: int, data: Array) -> None:
    series.resize(start + len(data), axis=0)
    series[start:] = data
