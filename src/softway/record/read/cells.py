"""Cells of the stored frames, read without trust in the numbers of a file."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.bodies.solid import Tool
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.record.read.recorded_bodies import RecordedBody, recorded_bodies
from softway.record.storage.gate.hdf5_file import BROKEN
from softway.record.write.grid.geometries import part
from softway.record.write.grid.grid_layout import VTK, blocks
from softway.record.write.shapes.tool_shapes import recovered


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Cells:
    """Cells and reference coordinates, common to all frames between two changes of the meshes, and rigid obstacles.

    Parameters
    ----------
    bodies
        Names of the solids.
    tools
        Rigid obstacles by name.
    lost
        Names of the obstacles that are not stored as data: a picture never runs code of a file.
    dimension
        Dimension d of space.
    reference
        (n, 3) reference coordinates [m].
    connectivity, offsets, types, body
        Cells in the format of VTK: (k,), (e + 1,), (e,); and (e,) number of the solid of each cell.
    rigid
        Rigid bodies that have a shape, by name.
    """

    bodies: tuple[str, ...]
    tools: Mapping[str, Tool]
    lost: tuple[str, ...]
    dimension: int
    reference: Array
    connectivity: IntArray
    offsets: IntArray
    types: IntArray
    body: IntArray
    rigid: Mapping[str, RecordedBody] = field(default_factory=dict)

    def blocks(self) -> dict[str, IntArray]:
        """Connectivity (cells, nodes) by cell name."""
        return blocks(self)

    def obstacles(self, time: float) -> dict[str, PlacedShape]:
        """Rigid obstacles and rigid bodies in their positions at a time [s]."""
        tools = {name: tool.at(time) for name, tool in self.tools.items()}
        return {**tools, **{name: body.at(time) for name, body in self.rigid.items()}}


def read_cells(file: Any, folder: Path, number: int) -> Cells:
    """Cells of the geometry with a number in an open file of a run folder.

    Raises
    ------
    ValueError, KeyError, TypeError
        If the file is damaged.
    """
    root, own = file["VTKHDF"], part(file["VTKHDF"], number)
    dimension = int(file.attrs["dimension"])
    tools = {name: _tool(data, dimension) for name, data in json.loads(file["tools"][()]).items()}
    rigid = json.loads(file["rigid"][()]) if "rigid" in file else {}
    bodies = {name: _tool(data, dimension) for name, data in rigid.items()}
    found = Cells(
        bodies=tuple(json.loads(file.attrs["bodies"])),
        tools={n: tool for n, tool in tools.items() if tool is not None},
        lost=tuple(n for n, tool in (*tools.items(), *bodies.items()) if tool is None),
        dimension=dimension,
        reference=file["reference"][own.points],
        body=np.asarray(root["CellData/body"][own.cells], int),
        rigid=recorded_bodies(folder, bodies),
        connectivity=np.asarray(root["Connectivity"][own.nodes], int),
        offsets=np.asarray(root["Offsets"][own.offsets], int),
        types=np.asarray(root["Types"][own.cells], int),
    )
    _require_cells(found, own.points.stop - own.points.start, own.cells.stop - own.cells.start)
    return found


def _tool(data: Any, dimension: int) -> Tool | None:
    """Tool from its description; None if it is not plain data that make a tool of this dimension."""
    try:
        made = recovered(data)
        if isinstance(made, Tool) and made.at(0.0).gap(np.zeros((1, dimension))).shape == (1,):
            return made
    except (InputError, *BROKEN, ArithmeticError, IndexError):
        return None
    return None


def _require_cells(cells: Cells, points: int, count: int) -> None:
    """Refuse numbers that lead beyond the arrays, and arrays without all ``points`` and all cells of the geometry.

    Raises
    ------
    ValueError
        With the array.
    """
    n, e, k = len(cells.reference), len(cells.types), len(cells.connectivity)
    if (n, e) != (points, count):
        raise ValueError(f"{n} points and {e} cells of {points} and {count}")
    widths = {kind: len(CELLS[name].nodes) for name, kind in VTK.items()}
    if cells.dimension not in (1, 2, 3) or cells.reference.shape != (n, 3):
        raise ValueError("dimension or reference coordinates")
    if not (cells.connectivity.ndim == 1 and ((cells.connectivity >= 0) & (cells.connectivity < n)).all()):
        raise ValueError("cells with nodes that are not there")
    if cells.offsets.shape != (e + 1,) or cells.offsets[0] != 0 or cells.offsets[-1] != k:
        raise ValueError("offsets of cells")
    if np.diff(cells.offsets).tolist() != [widths.get(int(kind)) for kind in cells.types]:
        raise ValueError("numbers of nodes of cells")
    if cells.body.shape != (e,) or not ((cells.body >= 0) & (cells.body < len(cells.bodies))).all():
        raise ValueError("numbers of bodies")
