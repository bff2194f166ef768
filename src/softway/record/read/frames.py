"""Stored frames of the fields, read back as plain arrays."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.bodies.solid import Tool
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.record.read.recorded_bodies import RecordedBody, recorded_bodies
from softway.record.storage.gate.hdf5_file import BROKEN, reading
from softway.record.write.fields import FILE
from softway.record.write.grid.grid_layout import VTK, blocks
from softway.record.write.grid.grid_series import SIZES
from softway.record.write.shapes.tool_shapes import recovered

if TYPE_CHECKING:
    import pyvista

REMEDY = f"a run folder with the complete file {FILE}"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Cells:
    """Cells, reference coordinates and rigid obstacles, common to all frames.

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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Frame:
    """Solids at one instant.

    Parameters
    ----------
    time
        Instant [s].
    points, displacement, velocity
        (n, 3) deformed positions [m], displacements [m], velocities [m/s].
    contact_force
        (n,) normal contact force on the slave nodes [N].
    stress, von_mises
        (e, 6) mean Cauchy stress of the cells, xx yy zz xy yz xz, and (e,) its von Mises equivalent [Pa].
    more
        Further recorded fields by name: ``contact_pressure`` (n,) and ``tangential_traction`` (n, 3) [Pa],
        ``plastic_strain`` and other scalar history variables (e,) of a law, ``dissipation`` (e,) [J/m^3]; of conductors
        ``temperature`` (n,) [K], ``heat_flux`` (e, 3) [W/m^2] and ``liquid`` (e,), while their stress is ``nan``.
    """

    time: float
    points: Array
    displacement: Array
    velocity: Array
    contact_force: Array
    stress: Array
    von_mises: Array
    more: Mapping[str, Array] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Array:
        """Field with a given name."""
        if name in self.more:
            return self.more[name]
        if name not in ALWAYS:
            raise KeyError(f"no field {name!r}; known fields: {', '.join((*ALWAYS, *self.more))}")
        return np.asarray(getattr(self, name))


ALWAYS = ("displacement", "velocity", "contact_force", "stress", "von_mises", "points")
"""Fields of every frame."""


@dataclass(frozen=True, slots=True)
class Kind:
    """Description of a field, given ``on`` "nodes" or "cells", with a ``unit`` (may be empty) and 1, 3 or 6
    ``components``.
    """

    on: str
    unit: str
    components: int


@dataclass(frozen=True, slots=True, eq=False)
class Fields:
    """Frames of a run; ``fields[k]`` reads one, negative numbers count from the end, ``fields[::10]`` reads a tuple.

    ``keep`` is an object that must live as long as the file, such as the holder of a temporary folder.
    """

    path: Path
    keep: object = None

    def __len__(self) -> int:
        with reading(self.path, REMEDY) as file:
            return _count(file["VTKHDF"])

    def __iter__(self) -> Iterator[Frame]:
        return (self[k] for k in range(len(self)))

    @overload
    def __getitem__(self, k: int) -> Frame: ...

    @overload
    def __getitem__(self, k: slice) -> tuple[Frame, ...]: ...

    def __getitem__(self, k: int | slice) -> Frame | tuple[Frame, ...]:
        if isinstance(k, slice):
            return tuple(self._frame(one) for one in range(len(self))[k])
        return self._frame(k)

    def _frame(self, k: int) -> Frame:
        with reading(self.path, REMEDY) as file:
            root = file["VTKHDF"]
            count = _count(root)
            if not -count <= k < count:
                raise IndexError(f"frame {k} of {count}")
            n, e = (int(root[name][0]) for name in SIZES[:2])
            at, k = slice(k % count * n, (k % count + 1) * n), k % count
            point = {name: data[at] for name, data in root["PointData"].items()}
            cell = {name: d[k * e : (k + 1) * e] for name, d in root["CellData"].items() if name != "body"}
            data = {**point, **cell}
            if any(len(values) != rows for part, rows in ((point, n), (cell, e)) for values in part.values()):
                raise ValueError(f"a field of frame {k} is too short")
            always = {name: data.pop(name, nothing) for name, nothing in _absent(n, e).items()}
            return Frame(time=float(root["Steps/Values"][k]), points=root["Points"][at], **always, more=data)

    @property
    def kinds(self) -> dict[str, Kind]:
        """Description of every field by name: on nodes or cells, unit, number of components."""
        with reading(self.path, REMEDY) as file:
            return {
                name: Kind(on=on, unit=str(data.attrs.get("unit", "")), components=int(np.prod(data.shape[1:])))
                for on, group in (("nodes", "PointData"), ("cells", "CellData"))
                for name, data in file["VTKHDF"][group].items()
                if name != "body"
            }

    @property
    def times(self) -> Array:
        """Instants of the frames (frames,) [s]."""
        with reading(self.path, REMEDY) as file:
            return np.asarray(file["VTKHDF/Steps/Values"][: _count(file["VTKHDF"])])

    @property
    def cells(self) -> Cells:
        """Cells, reference coordinates and rigid obstacles, common to all frames."""
        with reading(self.path, REMEDY) as file:
            root = file["VTKHDF"]
            whole = {name: np.asarray(root[name.title()][:], int) for name in ("connectivity", "offsets", "types")}
            dimension = int(file.attrs["dimension"])
            tools = {name: _tool(data, dimension) for name, data in json.loads(file["tools"][()]).items()}
            rigid = json.loads(file["rigid"][()]) if "rigid" in file else {}
            bodies = {name: _tool(data, dimension) for name, data in rigid.items()}
            found = Cells(
                bodies=tuple(json.loads(file.attrs["bodies"])),
                tools={n: tool for n, tool in tools.items() if tool is not None},
                lost=tuple(n for n, tool in (*tools.items(), *bodies.items()) if tool is None),
                dimension=dimension,
                reference=file["reference"][:],
                body=np.asarray(root["CellData/body"][:], int),
                rigid=recorded_bodies(self.path.parent, bodies),
                **whole,
            )
            _require_cells(found)
            return found

    def to_pyvista(self, k: int) -> "pyvista.UnstructuredGrid":
        """Frame ``k`` as a deformed PyVista grid with all its fields."""
        try:
            import pyvista
        except ImportError:
            raise InputError("fields", "PyVista is not installed", "pip install pyvista") from None
        frame, cells = self[k], self.cells
        grid = pyvista.UnstructuredGrid(_padded(cells), cells.types.astype(np.uint8), frame.points)
        for name, kind in self.kinds.items():
            (grid.point_data if kind.on == "nodes" else grid.cell_data)[name] = frame[name]
        grid.cell_data["body"] = cells.body
        return grid


def _absent(n: int, e: int) -> dict[str, Array]:
    """Fields of solids as conductors have them: no motion and no force, and stresses that are not known."""
    still, unknown = np.zeros((n, 3)), np.full(e, np.nan)
    points = {"displacement": still, "velocity": still, "contact_force": still[:, 0]}
    return {**points, "stress": np.full((e, 6), np.nan), "von_mises": unknown}


def _count(root: Any) -> int:
    """Number of frames."""
    count, stored = int(root["Steps"].attrs["NSteps"]), len(root["Steps/Values"])
    if not 0 <= count <= stored:
        raise ValueError(f"{count} frames, but {stored} instants")
    return count


def _tool(data: Any, dimension: int) -> Tool | None:
    """Tool from its description; None if it is not plain data that make a tool of this dimension."""
    try:
        made = recovered(data)
        if isinstance(made, Tool) and made.at(0.0).gap(np.zeros((1, dimension))).shape == (1,):
            return made
    except (InputError, *BROKEN, ArithmeticError, IndexError):
        return None
    return None


def _require_cells(cells: Cells) -> None:
    """Refuse numbers that lead beyond the arrays: what draws them does not look.

    Raises
    ------
    ValueError
        With the array.
    """
    n, e, k = len(cells.reference), len(cells.types), len(cells.connectivity)
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


def _padded(cells: Cells) -> IntArray:
    """Connectivity with the number of nodes in front of each cell, as PyVista needs it."""
    return np.insert(cells.connectivity, cells.offsets[:-1], np.diff(cells.offsets))
