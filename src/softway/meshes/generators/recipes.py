"""Mesh generators as plain data, for scenarios."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from pathlib import Path
from typing import Annotated

from softway.errors import InputError, within
from softway.meshes.files.mesh_files import FileMesh, read_file
from softway.meshes.generators import graded, shapes
from softway.meshes.generators.zones import Zone, divided
from softway.meshes.mesh import Mesh
from softway.units import Metre, Pure

UNITS = {"m": 1.0, "dm": 1e-1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "km": 1e3, "in": 0.0254, "ft": 0.3048}
"""Length units of mesh files in metres."""

Radian = Annotated[float, "rad"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """Straight bar, see :func:`softway.meshes.generators.shapes.interval`.

    Examples
    --------
    >>> Interval(length=1.0, cells=2).build().n_nodes
    3
    """

    length: Metre
    cells: int
    origin: tuple[Metre, ...] | Metre = 0.0
    cell: str = "bar2"
    direction: tuple[Pure, ...] = ()
    dim: int | None = None

    def build(self) -> Mesh:
        """Build the mesh."""
        origin = None if not isinstance(self.origin, tuple) and self.origin == 0.0 else self.origin
        return shapes.interval(
            self.length, self.cells, origin=origin, cell=self.cell, direction=self.direction or None, dim=self.dim
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Rectangle:
    """Rectangle along the axes, see :func:`softway.meshes.generators.shapes.rectangle`.

    Examples
    --------
    >>> Rectangle(size=(2.0, 1.0), cells=(2, 1)).build().n_cells
    2
    """

    size: tuple[Metre, Metre]
    cells: tuple[int, int]
    origin: tuple[Metre, Metre] = (0.0, 0.0)
    cell: str = "quad4"

    def build(self) -> Mesh:
        """Build the mesh."""
        return shapes.rectangle(self.size, self.cells, origin=self.origin, cell=self.cell)


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """Box along the axes, see :func:`softway.meshes.generators.shapes.box`.

    Examples
    --------
    >>> Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 2), cell="tet4").build().n_cells
    12
    """

    size: tuple[Metre, Metre, Metre]
    cells: tuple[int, int, int]
    origin: tuple[Metre, Metre, Metre] = (0.0, 0.0, 0.0)
    cell: str = "hex8"

    def build(self) -> Mesh:
        """Build the mesh."""
        return shapes.box(self.size, self.cells, origin=self.origin, cell=self.cell)


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """Disc, see :func:`softway.meshes.generators.shapes.disc`.

    Examples
    --------
    >>> Disc(radius=1.0, cells=4).build().n_cells
    12
    """

    radius: Metre
    cells: int
    centre: tuple[Metre, Metre] = (0.0, 0.0)
    cell: str = "quad4"

    def build(self) -> Mesh:
        """Build the mesh."""
        return shapes.disc(self.radius, self.cells, centre=self.centre, cell=self.cell)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinder:
    """Cylinder along z, see :func:`softway.meshes.generators.shapes.cylinder`.

    Examples
    --------
    >>> Cylinder(radius=1.0, height=2.0, cells=(4, 1)).build().n_cells
    12
    """

    radius: Metre
    height: Metre
    cells: tuple[int, int]
    origin: tuple[Metre, Metre, Metre] = (0.0, 0.0, 0.0)
    cell: str = "hex8"

    def build(self) -> Mesh:
        """Build the mesh."""
        return shapes.cylinder(self.radius, self.height, self.cells, origin=self.origin, cell=self.cell)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ball:
    """Ball, see :func:`softway.meshes.generators.shapes.ball`.

    Examples
    --------
    >>> Ball(radius=1.0, cells=4).build().n_cells
    32
    """

    radius: Metre
    cells: int
    centre: tuple[Metre, Metre, Metre] = (0.0, 0.0, 0.0)
    cell: str = "hex8"

    def build(self) -> Mesh:
        """Build the mesh."""
        return shapes.ball(self.radius, self.cells, centre=self.centre, cell=self.cell)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """Rectangle or box with cells between given coordinates, see :func:`softway.meshes.generators.graded.grid`.

    Parameters
    ----------
    x, y
        Increasing coordinates of the grid lines along the axis [m].
    z
        Likewise along z; empty in the plane.

    Examples
    --------
    >>> Grid(x=(0.0, 0.1, 1.0), y=(0.0, 0.5)).build().n_cells
    2
    """

    x: tuple[Metre, ...]
    y: tuple[Metre, ...]
    z: tuple[Metre, ...] = ()
    cell: str | None = None

    def build(self) -> Mesh:
        """Build the mesh."""
        return graded.grid(self.x, self.y, *((self.z,) if self.z else ()), cell=self.cell)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ring:
    """Ring or sector of a ring, see :func:`softway.meshes.generators.graded.ring`.

    Examples
    --------
    >>> Ring(inner=1.0, outer=2.0, cells=(2, 12)).build().n_nodes
    36
    """

    inner: Metre
    outer: Metre
    cells: tuple[int, int]
    angle: Radian = 2.0 * pi
    start: Radian = 0.0
    centre: tuple[Metre, Metre] = (0.0, 0.0)
    cell: str = "quad4"

    def build(self) -> Mesh:
        """Build the mesh."""
        return graded.ring(
            self.inner, self.outer, self.cells, angle=self.angle, start=self.start, centre=self.centre, cell=self.cell
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class GradedDisc:
    """Disc or part of a disc, refined at its lowest point, see :func:`softway.meshes.generators.graded.graded_disc`.

    Examples
    --------
    >>> GradedDisc(radius=1.0, focus=0.01, cells=4, part="quarter").build().n_cells
    232
    """

    radius: Metre
    focus: Metre
    cells: int
    part: graded.Part = "whole"
    centre: tuple[Metre, Metre] = (0.0, 0.0)
    cell: str = "quad4"

    def build(self) -> Mesh:
        """Build the mesh."""
        return graded.graded_disc(
            self.radius, self.focus, self.cells, part=self.part, centre=self.centre, cell=self.cell
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshFile:
    """Gmsh ``.msh`` or Abaqus/CalculiX ``.inp`` file, see :func:`softway.meshes.files.mesh_files.read_mesh`.

    Parameters
    ----------
    path
        Path of the file.
    unit
        Length unit of the file: m, dm, cm, mm, um, nm, km, in, ft.
    cells
        Names of the cells to keep; by default all cells of the highest dimension.
    only
        Name, or names, of the parts of the file that form the body: physical groups of a ``.msh`` file; instances,
        parts or element sets of a deck. By default all.
    """

    path: str | Path
    unit: str = "m"
    cells: tuple[str, ...] | None = None
    only: str | tuple[str, ...] = ()

    def build(self) -> Mesh:
        """Build the mesh."""
        return self.read().mesh

    def read(self) -> FileMesh:
        """Build the mesh, and list what of a deck it does not hold."""
        if self.unit not in UNITS:
            raise InputError("unit", f"{self.unit!r} is not a length unit of mesh files", f"one of: {', '.join(UNITS)}")
        only = (self.only,) if isinstance(self.only, str) else self.only
        return read_file(Path(self.path), scale=UNITS[self.unit], cells=self.cells, only=only)


Whole = Interval | Rectangle | Box | Disc | Cylinder | Ball | Grid | Ring | GradedDisc | MeshFile


@dataclass(frozen=True, slots=True, kw_only=True)
class Divided:
    """Mesh with regions by place, for bodies with several materials, see
    :func:`softway.meshes.generators.zones.divided`.

    Parameters
    ----------
    mesh
        Mesh to divide.
    regions
        Zones by name: the cells with their centres in a zone form its region; the first of several zones counts.
    rest
        Name of the region of all cells in no other one; empty for none.

    Examples
    --------
    >>> from softway.meshes.generators.zones import InBox
    >>> Divided(mesh=Interval(length=1.0, cells=4), regions={"tip": InBox(low=(0.7,))}).build().cells("rest").tolist()
    [0, 1, 2]
    """

    mesh: Whole
    regions: Mapping[str, Zone] = field(default_factory=dict)
    rest: str = "rest"

    def build(self) -> Mesh:
        """Build the mesh."""
        return self.read().mesh

    def read(self) -> FileMesh:
        """Build the mesh, and list what of a file it does not hold."""
        with within("mesh"):
            found = self.mesh.read() if isinstance(self.mesh, MeshFile) else FileMesh(self.mesh.build())
        return FileMesh(divided(found.mesh, dict(self.regions), self.rest), found.left_out, found.ties)


MeshSource = Whole | Divided
