"""Stored frames of the fields, read back as plain arrays."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.record.read.cells import Cells, read_cells
from softway.record.storage.gate.hdf5_file import reading
from softway.record.write.fields import FILE
from softway.record.write.grid.geometries import parts_of_frames, rows_of_frame

if TYPE_CHECKING:
    import pyvista

ROUNDING = 1e-13
"""Rounding of places, relative to the greatest coordinate."""
REMEDY = f"a run folder with the complete file {FILE}"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Frame:
    """Solids at one instant.

    Parameters
    ----------
    time
        Instant [s].
    points, displacement, velocity
        (n, 3) deformed positions [m], displacements [m], velocities [m/s].  Displacements are those of the matter since
        the start of the run; where meshes are replaced, ``remesh``, the reference coordinates of the cells are the
        shape of the body when its mesh was new, and not ``points - displacement``, where the matter was at the start.
    contact_force
        (n,) normal contact force on the slave nodes [N].
    stress, von_mises
        (e, 6) mean Cauchy stress of the cells, xx yy zz xy yz xz, and (e,) its von Mises equivalent [Pa].
    more
        Further recorded fields by name: ``contact_pressure`` (n,) and ``tangential_traction`` (n, 3) [Pa],
        ``plastic_strain`` and other scalar history variables (e,) of a law, ``dissipation`` (e,) [J/m^3]; of conductors
        ``temperature`` (n,) [K], ``heat_flux`` (e, 3) [W/m^2] and ``liquid`` (e,), while their stress is ``nan``.
    geometry
        Number of its cells and reference coordinates: 0 in runs whose meshes stay.
    """

    time: float
    points: Array
    displacement: Array
    velocity: Array
    contact_force: Array
    stress: Array
    von_mises: Array
    more: Mapping[str, Array] = field(default_factory=dict)
    geometry: int = 0

    def start(self, cells: Cells) -> Array:
        """Places (n, 3) at the start of the run of the matter in the nodes [m]: the reference coordinates of its
        ``cells`` where meshes are not replaced.
        """
        found = self.points - self.displacement
        near = ROUNDING * float(np.abs(self.points).max())
        return np.where(np.abs(found - cells.reference) <= near, cells.reference, found)

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
            k %= count
            parts = parts_of_frames(root, k + 1)
            at, within = rows_of_frame(root, parts)
            n, e = at.stop - at.start, within.stop - within.start
            point = {name: data[at] for name, data in root["PointData"].items()}
            cell = {name: data[within] for name, data in root["CellData"].items() if name != "body"}
            data = {**point, **cell}
            time, points = float(root["Steps/Values"][k]), root["Points"][at]
            sizes = ((point, n), (cell, e), ({"Points": points}, n))
            if any(len(values) != rows for part, rows in sizes for values in part.values()):
                raise ValueError(f"a field of frame {k} is too short")
            always = {name: data.pop(name, nothing) for name, nothing in _absent(n, e).items()}
            return Frame(time=time, points=points, **always, more=data, geometry=int(parts[-1]))

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
        """Cells, reference coordinates and rigid obstacles of the first frame; of all frames where meshes stay."""
        return self.geometry(0)

    def cells_of(self, frame: Frame) -> Cells:
        """Cells of a frame."""
        return self.geometry(frame.geometry)

    def geometry(self, number: int) -> Cells:
        """Cells with the number that a frame has as its ``geometry``."""
        with reading(self.path, REMEDY) as file:
            return read_cells(file, self.path.parent, number)

    def with_cells(self, numbers: Iterable[int] | None = None) -> Iterator[tuple[Frame, Cells]]:
        """Frames with the given numbers, by default all of them, each with its cells."""
        last, cells = -1, None
        for k in range(len(self)) if numbers is None else numbers:
            frame = self[k]
            if cells is None or frame.geometry != last:
                last, cells = frame.geometry, self.cells_of(frame)
            yield frame, cells

    @property
    def geometries(self) -> IntArray:
        """Number (frames,) of the geometry of each frame, which rises where the meshes of a run change."""
        with reading(self.path, REMEDY) as file:
            root = file["VTKHDF"]
            return parts_of_frames(root, _count(root))

    def to_pyvista(self, k: int) -> "pyvista.UnstructuredGrid":
        """Frame ``k`` as a deformed PyVista grid with its cells and all its fields."""
        try:
            import pyvista
        except ImportError:
            raise InputError("fields", "PyVista is not installed", "pip install pyvista") from None
        frame = self[k]
        cells = self.cells_of(frame)
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


def _padded(cells: Cells) -> IntArray:
    """Connectivity with the number of nodes in front of each cell, as PyVista needs it."""
    return np.insert(cells.connectivity, cells.offsets[:-1], np.diff(cells.offsets))
