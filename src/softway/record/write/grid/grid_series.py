"""Series of frames of one unstructured grid in a file for ParaView, PyVista and h5py.

The file follows VTK's HDF format 2.0 for a transient unstructured grid; frames share their cells until these change.
Data are written before the counts that refer to them, and an incomplete frame is removed.  A run that is killed
therefore leaves all complete frames.
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
from softway.record.write.grid.geometries import (
    LEAST,
    SIZES,
    create_geometry,
    cut_geometries,
    part,
    parts_of_frames,
    rows_of_frame,
    series,
    shorten,
)
from softway.record.write.grid.grid_layout import Grid
from softway.record.write.grid.series_end import SeriesEnd

REMEDY = "a new run, or a copy of the file"


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
    """Open file of frames, with its ``end``; ``before`` is the number of frames in it before the first change of
    ``guarded``.
    """

    file: h5py.File
    guarded: JournaledFile
    end: SeriesEnd
    before: int

    def write(self, frame: GridFrame, grid: Grid | None = None) -> None:
        """Write a frame completely, or not at all; with a ``grid`` that may differ from that of the frame before."""
        uninterrupted(lambda: self._write(frame, grid))

    def _write(self, frame: GridFrame, grid: Grid | None) -> None:
        with _changing(self.guarded):
            if grid is not None:
                self.end.on(grid)
            self.end.append(frame.time, frame.points, frame.groups)

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
    path: Path,
    grid: Grid,
    first: GridFrame,
    units: Mapping[str, str],
    about: Mapping[str, Mapping[str, Any]],
    grows: bool = False,
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
    grows
        True if points and cells may change from frame to frame.
    """
    return uninterrupted(lambda: _opened(path, grid, first, units, about, grows), GridSeries.close)


def continue_series(path: Path, mark: int) -> GridSeries:
    """Continue a file after ``mark`` frames.

    Raises
    ------
    InputError
        If the file has fewer frames.
    """
    return uninterrupted(lambda: _reopened(path, mark), GridSeries.close)


def _opened(
    path: Path,
    grid: Grid,
    first: GridFrame,
    units: Mapping[str, str],
    about: Mapping[str, Mapping[str, Any]],
    grows: bool,
) -> GridSeries:
    """Open a new file and write its first frame."""
    undone(path)
    with ExitStack() as failing:
        guarded = JournaledFile(path, new=True)
        failing.callback(guarded.close)
        with _changing(guarded):
            file = _file(path, guarded, new=True)
            failing.callback(file.close)
            _write_start(file, grid, first, units, grows)
            for name, data in about.items():
                file[name] = json.dumps(data)
            end = SeriesEnd(file)
            end.append(first.time, first.points, first.groups)
        failing.pop_all()
    return GridSeries(file=file, guarded=guarded, end=end, before=0)


def _reopened(path: Path, mark: int) -> GridSeries:
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
            end = SeriesEnd(file)
        failing.pop_all()
    return GridSeries(file=file, guarded=guarded, end=end, before=mark - 1)


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
    try:
        parts = parts_of_frames(root, mark)
        points, cells = rows_of_frame(root, parts)
        last = part(root, int(parts[-1]))
    except BROKEN as error:
        raise InputError(str(path), f"is damaged: {error}", REMEDY) from None
    steps.attrs["NSteps"] = np.int64(mark)
    shorten(root["Points"], points.stop)
    for group, rows in (("PointData", points), ("CellData", cells)):
        for name, starts in steps[f"{group}Offsets"].items():
            if name != "body":
                shorten(root[group][name], rows.stop)
            shorten(starts, mark)
    for starts in steps.values():
        if isinstance(starts, h5py.Dataset):
            shorten(starts, mark)
    if last.number + 1 < len(root[SIZES[0]]):
        cut_geometries(file, last.number)
    file.flush()


def _write_start(file: h5py.File, grid: Grid, first: GridFrame, units: Mapping[str, str], grows: bool) -> None:
    """Write the first cells, and create empty series for the data that change from frame to frame."""
    n, e = (max(rows, LEAST) if grows else rows for rows in (len(grid.reference), len(grid.types)))
    root = file.create_group("VTKHDF")
    root.attrs["Version"] = np.array([2, 0])
    root.attrs["Type"] = np.bytes_("UnstructuredGrid")
    series(root, "Points", (3,), n, "m")
    steps = root.create_group("Steps")
    series(steps, "Values", (), 1, "s")
    for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
        series(steps, name, (), 1, dtype=np.int64)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        series(steps, name, (1,), 1, dtype=np.int64)
    for (group, arrays), rows in zip(first.groups.items(), (n, e), strict=True):
        for name, data in arrays.items():
            series(root.require_group(group), name, data.shape[1:], rows, units.get(name, ""))
            series(steps.require_group(f"{group}Offsets"), name, (), 1, dtype=np.int64)
    create_geometry(file, grid, grows)
    series(steps["CellDataOffsets"], "body", (), 1, dtype=np.int64)
    file.attrs["bodies"] = json.dumps(list(grid.bodies))
    file.attrs["dimension"] = grid.dimension
    steps.attrs["NSteps"] = np.int64(0)
