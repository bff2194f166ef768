"""Rigid bodies from meshes and closed surfaces: mass, centre and inertia of the enclosed volume."""

from pathlib import Path

import numpy as np
import numpy.typing as npt

from softway.errors import InputError, within
from softway.mechanisms.members.moments import Moments, facet_moments
from softway.mechanisms.members.rigid import Rigid
from softway.meshes.element import element, exact_degree
from softway.meshes.files.mesh_files import read_facets
from softway.meshes.mesh import Mesh
from softway.obstacles.primitives import Shape
from softway.obstacles.triangulated import Facets
from softway.units import KilogramPerCubicMetre, Metre, MetrePerSecond, RadianPerSecond

Velocity = tuple[MetrePerSecond, ...] | None
Spin = RadianPerSecond | tuple[RadianPerSecond, ...]


def _rigid(found: Moments, density: float, velocity: Velocity, spin: Spin, shape: Shape | None = None) -> Rigid:
    """Rigid body of a density, in the plane an area density."""
    if not (np.isfinite(density) and density > 0.0):
        raise InputError("density", f"{density:g} is not positive", "the density of the material")
    return Rigid(
        mass=density * found.volume,
        centre=found.centre,
        inertia=found.inertia(density),
        velocity=velocity,
        spin=spin,
        shape=shape,
    )


def rigid_mesh(
    mesh: Mesh, *, density: KilogramPerCubicMetre, thickness: Metre = 1.0, velocity: Velocity = None, spin: Spin = 0.0
) -> Rigid:
    """Rigid body of the cells of a mesh; curved cells count with their curved faces.

    Parameters
    ----------
    mesh
        Mesh of cells that fill the plane or space.
    density
        Density [kg/m^3].
    thickness
        Thickness of a body in the plane [m].
    velocity, spin
        Motion at the start, as of :class:`Rigid`.

    Raises
    ------
    InputError
        For cells of a lower dimension than space, and a density that is not positive.

    Examples
    --------
    >>> from softway.meshes.generators.graded import grid
    >>> body = rigid_mesh(grid((0.0, 2.0), (0.0, 1.0)), density=3.0)
    >>> round(body.mass, 12), tuple(round(x, 12) for x in body.centre), round(body.inertia, 12)
    (6.0, (1.0, 0.5), 2.5)
    """
    dim, volume = mesh.dim, 0.0
    if mesh.cell_dim != dim or dim == 1:
        problem = f"cells of dimension {mesh.cell_dim} in {dim}D enclose no volume"
        raise InputError("mesh", problem, "a mesh of the plane or of space, or a closed surface with rigid_surface")
    about = mesh.points.mean(axis=0)
    first, second = np.zeros(dim), np.zeros((dim, dim))
    for name, cells in mesh.blocks.items():
        it, corners = element(name, exact_degree(name, curved=True)), mesh.points[cells] - about
        weight = it.weights * np.linalg.det(np.einsum("eai,qar->eqir", corners, it.dN))
        place = np.einsum("qa,eai->eqi", it.N, corners)
        volume += float(weight.sum())
        first += np.einsum("eq,eqi->i", weight, place)
        second += np.einsum("eq,eqi,eqj->ij", weight, place, place)
    found = Moments(volume=volume, first=first, second=second, about=about)
    return _rigid(found, density * _thick(thickness, dim), velocity, spin)


def rigid_surface(
    points: npt.ArrayLike,
    cells: npt.ArrayLike,
    *,
    density: KilogramPerCubicMetre,
    thickness: Metre = 1.0,
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Rigid body inside a closed surface of flat facets, exactly; further shells inside it are cavities.

    The surface is its shape, for contact with solids.

    Parameters
    ----------
    points, cells
        Vertices (n, d) [m], and their numbers (f, d) for each facet, triangles in space and segments in the plane.
        Seen from outside, the corners of a triangle are anticlockwise; a segment has the body on its left.
    density, thickness, velocity, spin
        As of :func:`rigid_mesh`.

    Raises
    ------
    InputError
        If the surface is open, inside out or without volume, or the density is not positive.

    Examples
    --------
    >>> square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    >>> body = rigid_surface(square, [(0, 1), (1, 2), (2, 3), (3, 0)], density=6.0)
    >>> round(body.mass, 12), tuple(round(x, 12) for x in body.centre), round(body.inertia, 12)
    (6.0, (0.5, 0.5), 1.0)
    """
    surface = Facets(points=np.asarray(points, float), cells=np.asarray(cells, np.int64))
    return _rigid(facet_moments(surface), density * _thick(thickness, surface.dim), velocity, spin, surface)


def rigid_file(
    path: str | Path,
    *,
    density: KilogramPerCubicMetre,
    scale: float = 1.0,
    thickness: Metre = 1.0,
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Rigid body inside the closed surface of a file: STL, OBJ, PLY, or the cells of a Gmsh or VTK file.

    Parameters
    ----------
    path
        Path of the file.
    scale
        Length unit of the file [m].
    density, thickness, velocity, spin
        As of :func:`rigid_mesh`.

    Raises
    ------
    InputError
        If the file cannot be read, and what :func:`rigid_surface` refuses, with the name of the file.
    """
    points, cells = read_facets(path, scale)
    with within(Path(path).name):
        return rigid_surface(points, cells, density=density, thickness=thickness, velocity=velocity, spin=spin)


def _thick(thickness: float, dim: int) -> float:
    """Thickness of a body in the plane, 1 in space."""
    if not (np.isfinite(thickness) and thickness > 0.0):
        raise InputError("thickness", f"{thickness:g} m is not positive", "the thickness of the body in the plane")
    return thickness if dim == 2 else 1.0
