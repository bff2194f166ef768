"""End of a file of frames: its open arrays, and the rows where the next frame goes."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.record.storage.gate.hdf5_file import kept_number, write_rows
from softway.record.write.grid.geometries import SIZES, add_geometry, is_last, part, parts_of_frames, rows_of_frame
from softway.record.write.grid.grid_layout import Grid

STARTS = ("PartOffsets", "NumberOfParts", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets")
"""Whole numbers of each frame: its part, the number of its parts, and where its points, cells and their nodes start."""


class SeriesEnd:
    """End of a file whose last frame is complete.

    Finding an array by its path takes longer than writing the rows of a small frame, and the starts of all frames
    before need not be read again: both are kept.

    Parameters
    ----------
    file
        The open file.
    """

    __slots__ = ("_arrays", "_cells", "_count", "_file", "_grid", "_part", "_points", "_written")

    def __init__(self, file: Any) -> None:
        root = file["VTKHDF"]
        self._file = file
        self._grid: Grid | None = None
        self._arrays: dict[str, Any] = {}
        self._count = int(root["Steps"].attrs["NSteps"])
        self._written = kept_number(root["Steps"], "NSteps")
        self._part = part(root, len(root[SIZES[0]]) - 1)
        points, cells = rows_of_frame(root, np.append(parts_of_frames(root, self._count), self._part.number))
        self._points, self._cells = points.start, cells.start

    def on(self, grid: Grid) -> None:
        """Let the next frames be on a grid: written as a new geometry if it is not that of the frame before."""
        if grid is self._grid:
            return
        if not is_last(self._file, grid):
            add_geometry(self._file, grid)
            root = self._file["VTKHDF"]
            self._part = part(root, len(root[SIZES[0]]) - 1)
        self._grid = grid

    def append(self, time: float, points: Array, groups: Mapping[str, Mapping[str, Array]]) -> None:
        """Write one frame on the last geometry: first the data, then their offsets, then the number of frames.

        ``groups`` are the arrays at the points and in the cells, by the names of their groups in the file.
        """
        own, k = self._part, self._count
        sizes = (own.points.stop - own.points.start, own.cells.stop - own.cells.start)
        self._put("Points", self._points, points)
        for (group, arrays), start, size in zip(groups.items(), (self._points, self._cells), sizes, strict=True):
            for name, data in arrays.items():
                if len(data) != size:
                    raise ValueError(f"{len(data)} values of {name} on a grid with {size}")
                self._put(f"{group}/{name}", start, data)
                self._put(f"Steps/{group}Offsets/{name}", k, np.array([start]))
        self._put("Steps/CellDataOffsets/body", k, np.array([own.cells.start]))
        starts = ([own.number], [1], [self._points], [[own.cells.start]], [[own.nodes.start]])
        for name, start_of in zip(STARTS, starts, strict=True):
            self._put(f"Steps/{name}", k, np.array(start_of))
        self._put("Steps/Values", k, np.array([time]))
        self._file.flush()
        self._written.write(np.array(k + 1))
        self._file.flush()
        self._count, self._points, self._cells = k + 1, self._points + sizes[0], self._cells + sizes[1]

    def _put(self, name: str, start: int, data: Any) -> None:
        rows = self._arrays.get(name)
        if rows is None:
            rows = self._arrays[name] = self._file["VTKHDF"][name]
        write_rows(rows, start, data)
