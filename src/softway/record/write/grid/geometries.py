"""Geometries in a file of frames: places at rest and cells, one *part* of the VTK format for each mesh of a run.

Frames between two changes of the meshes share a part.  In runs whose meshes stay there is one, of arrays that do not
grow.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from softway.arrays import IntArray
from softway.record.storage.gate.hdf5_file import write_rows
from softway.record.write.grid.grid_layout import Grid

PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
CHUNK = 65536
LEAST = 1024
"""Rows of the chunks of arrays whose length may change from frame to frame, at least."""
SIZES = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Rows of a part in the arrays of a file: its number, and where its points, cells and their nodes are."""

    number: int
    points: slice
    cells: slice
    nodes: slice

    @property
    def offsets(self) -> slice:
        """Rows of the starts of its cells, one more than cells in each part."""
        return slice(self.cells.start + self.number, self.cells.stop + self.number + 1)


def part(root: Any, number: int) -> Part:
    """Part of a file.

    Raises
    ------
    ValueError
        If the file has no such part, or sizes of parts are no counts.
    """
    sizes = [np.asarray(root[name][: number + 1]) for name in SIZES]
    if number < 0 or any(len(size) != number + 1 or size.dtype.kind not in "iu" or size.min() < 0 for size in sizes):
        raise ValueError(f"part {number} with sizes {[size.tolist()[-3:] for size in sizes]}")
    points, cells, nodes = (slice(int(size[:-1].sum()), int(size.sum())) for size in sizes)
    return Part(number=number, points=points, cells=cells, nodes=nodes)


def parts_of_frames(root: Any, count: int) -> IntArray:
    """Number (count,) of the part of each of the first frames.

    Raises
    ------
    ValueError
        If a number is missing, or is none of a part.
    """
    known = len(root[SIZES[0]])
    if known == 1:
        return np.zeros(count, dtype=np.int64)
    found = np.asarray(root["Steps/PartOffsets"][:count])
    if found.shape != (count,) or not ((found >= 0) & (found < known)).all():
        raise ValueError("parts of frames")
    return found


def rows_of_frame(root: Any, parts: IntArray) -> tuple[slice, slice]:
    """Rows of the last of the frames on some ``parts`` (k,): in the arrays at points, and in those in cells."""
    sizes = [np.asarray(root[name][:])[parts] for name in SIZES[:2]]
    points, cells = (slice(int(size[:-1].sum()), int(size.sum())) for size in sizes)
    return points, cells


def create_geometry(file: Any, grid: Grid, grows: bool) -> None:
    """Write the first geometry of a new file, in arrays that grow by further ones or in arrays that stay."""
    arrays = _arrays(grid)
    for name, data in arrays.items():
        if not grows:
            file[name] = data
        else:
            rows = 1 if name.endswith(SIZES) else max(len(data), LEAST)
            made = series(file, name, data.shape[1:], rows, dtype=data.dtype)
            write_rows(made, 0, data)


def add_geometry(file: Any, grid: Grid) -> None:
    """Write a further geometry: its data before their sizes."""
    for name, data in _arrays(grid).items():
        write_rows(file[name], len(file[name]), data)


def is_last(file: Any, grid: Grid) -> bool:
    """True for the geometry of the last part, and for every one if the arrays do not grow."""
    root = file["VTKHDF"]
    if root["Types"].maxshape[0] is not None:
        return True
    last = part(root, len(root[SIZES[0]]) - 1)
    rows = {"reference": last.points, "VTKHDF/CellData/body": last.cells, **_rows(last)}
    stored = {name: file[name][at] for name, at in rows.items()}
    return all(np.array_equal(found, _arrays(grid)[name]) for name, found in stored.items())


def cut_geometries(file: Any, number: int) -> None:
    """Remove all geometries after the part ``number``."""
    last = part(file["VTKHDF"], number)
    for name in SIZES:
        shorten(file["VTKHDF"][name], number + 1)
    for name, at in {"reference": last.points, "VTKHDF/CellData/body": last.cells, **_rows(last)}.items():
        shorten(file[name], at.stop)


def series(group: Any, name: str, shape: tuple[int, ...], rows: int, unit: str = "", dtype: Any = float) -> Any:
    """Create an empty array that grows by about ``rows`` along its first axis at a time."""
    chunks = (max(1, min(rows if rows > 1 else 256, CHUNK)), *shape)
    packed = PACKED if rows > 1 else {}
    made = group.create_dataset(name, (0, *shape), dtype, maxshape=(None, *shape), chunks=chunks, **packed)
    if unit:
        made.attrs["unit"] = unit
    return made


def shorten(rows: Any, count: int) -> None:
    """Remove the rows of an array after the first ``count``."""
    if len(rows) > count:
        rows.resize(count, axis=0)


def _arrays(grid: Grid) -> dict[str, Any]:
    """Arrays of a geometry by their names in the file, the sizes last."""
    sizes = zip(SIZES, (len(grid.reference), len(grid.types), len(grid.connectivity)), strict=True)
    return {
        "VTKHDF/Connectivity": grid.connectivity,
        "VTKHDF/Offsets": grid.offsets,
        "VTKHDF/Types": grid.types.astype(np.uint8),
        "VTKHDF/CellData/body": grid.body.astype(np.int32),
        "reference": grid.reference,
        **{f"VTKHDF/{name}": np.array([size]) for name, size in sizes},
    }


def _rows(of: Part) -> dict[str, slice]:
    """Rows of the cells of a part by the names of their arrays."""
    return {"VTKHDF/Connectivity": of.nodes, "VTKHDF/Offsets": of.offsets, "VTKHDF/Types": of.cells}
