"""Readers of mesh files; the only module that uses meshio, for STL, PLY and VTK files."""

import contextlib
import io
import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS, FLAT
from softway.meshes.files.abaqus.assembly import deck_mesh
from softway.meshes.files.abaqus.lexer import is_file, is_folder
from softway.meshes.files.gmsh.mesh import NAMES, gmsh_mesh
from softway.meshes.files.listed_mesh import FileTie, LeftOut, ListedMesh
from softway.meshes.files.wavefront import obj_facets
from softway.meshes.mesh import Mesh

if TYPE_CHECKING:
    import meshio

LOG = logging.getLogger(__name__)
_SURFACES = {".stl": "stl", ".ply": "ply", ".vtu": "vtu"}
_BODIES = (".msh", ".vtu")
"""Formats whose plane cells form a body in the plane; in other formats they form a surface in space."""
LARGEST = 8_000_000_000
"""Greatest size of a mesh file in bytes."""
PLY_ENDS, HEAD = b"end_header", 100_000
"""End mark of the header of a PLY file, and the greatest length of the header in bytes."""
_DIMS = {
    "vertex": 0,
    "line": 1,
    "triangle": 2,
    "quad": 2,
    "polygon": 2,
    "tetra": 3,
    "hexahedron": 3,
    "wedge": 3,
    "pyramid": 3,
}


@dataclass(frozen=True, slots=True, eq=False)
class FileMesh:
    """Mesh of a file.

    Parameters
    ----------
    mesh
        Mesh of the wanted cells.
    left_out
        Cards of an input deck, or sections, nodes and groups of a Gmsh file, that the mesh does not hold.
    ties
        Pairs of tags that the file glues; a mesh of a part of the file may lack them.
    """

    mesh: Mesh
    left_out: tuple[LeftOut, ...] = ()
    ties: tuple[FileTie, ...] = ()


def read_mesh(
    path: str | Path, scale: float = 1.0, *, cells: Sequence[str] | None = None, only: Sequence[str] = ()
) -> Mesh:
    """Read a Gmsh ``.msh`` or an Abaqus/CalculiX ``.inp`` file.

    Physical groups of any dimension, node sets, surfaces, element sets and instances become tags, which hold the nodes
    of the named entities. Physical groups of cells, element sets and the materials of sections become regions, which
    hold cells. Cells of lower dimension are used for tags only. Points without a cell are dropped, as is the
    constant third coordinate of a plane mesh.

    Parameters
    ----------
    path
        Path of the file.
    scale
        Length unit of the file [m].
    cells
        Names of the cells to keep; by default all cells of the highest dimension.
    only
        Names of the physical groups, or of the instances, parts or element sets of a deck, to keep; by default all.

    Raises
    ------
    InputError
        For a file that cannot be read, with the line if it is an input deck.
    """
    return read_file(path, scale, cells=cells, only=only).mesh


def read_file(
    path: str | Path, scale: float = 1.0, *, cells: Sequence[str] | None = None, only: Sequence[str] = ()
) -> FileMesh:
    """Read a mesh file as :func:`read_mesh` does, and list what of it the mesh does not hold."""
    file = Path(path)
    _require_file(file, (".msh", ".inp"))
    found = (deck_mesh if file.suffix.lower() == ".inp" else gmsh_mesh)(file, cells, only)
    return FileMesh(_mesh(found.points * scale, found), found.left_out, found.ties)


def _mesh(points: Array, found: ListedMesh) -> Mesh:
    """Mesh without unused points, and without the constant third coordinate of plane cells."""
    dim = max(CELLS[name].dim for name in found.blocks)
    if dim == 2 and points.shape[1] == 3 and np.ptp(points[:, 2]) <= 1e-12 * np.ptp(points, axis=0).max():
        points = points[:, :2]
    return replace(_compact(points, found.blocks, found.tags), regions=found.regions)


def read_facets(path: str | Path, scale: float = 1.0) -> tuple[Array, IntArray]:
    """Read the flat facets of a surface: STL, OBJ, PLY, or the cells of highest dimension in a Gmsh or VTK file.

    If these cells fill space, or the plane z = const, the facets of their boundary are used.

    Parameters
    ----------
    path
        Path of the file.
    scale
        Length unit of the file [m].

    Returns
    -------
    points
        (n, d) [m], d = 2 or 3.
    cells
        (f, d) numbers of the points, triangles in space and segments in the plane.
    """
    path = Path(path)
    _require_file(path, (*_SURFACES, ".obj", ".msh"))
    points, blocks = _cells(path)
    dim = max((CELLS[name].dim for name in blocks), default=0)
    if dim == 0:
        raise InputError("path", f"{path.name} has no facets", "a file with triangles, or with lines in a plane")
    points = points * scale
    flat = points.shape[1] == 2 or np.ptp(points[:, 2]) <= 1e-12 * np.ptp(points, axis=0).max()
    if dim == 1 and not flat:
        raise InputError(
            "path", f"{path.name} has lines that are not in a plane z = const", "lines in one plane, or facets"
        )
    if dim == 1 or (dim == 2 and flat and path.suffix.lower() in _BODIES):
        points = points[:, :2]
    if dim == points.shape[1]:
        body = _compact(points, blocks, {})
        points, blocks = body.points, dict(body.boundary())
    pieces = [cells[:, piece] for name, cells in blocks.items() for piece in np.array(FLAT[name])]
    return points, np.concatenate(pieces)


def _require_file(path: Path, known: Sequence[str]) -> None:
    """Refuse what is no file, a file of another format, and one that is empty or too large."""
    if not is_file(path):
        raise InputError(
            "path",
            f"{'a folder' if is_folder(path) else 'no such file'}: {str(path):.300}",
            f"the path of a {' or '.join(known)} file, relative to the scenario",
        )
    if path.suffix.lower() not in known:
        raise InputError("path", f"{path.name} has the ending {path.suffix!r}", f"one of: {', '.join(known)}")
    size = path.stat().st_size
    if not 0 < size <= LARGEST:
        raise InputError("path", f"{path.name} has {size} bytes", f"a mesh file of up to {LARGEST:.0e} bytes")


def _read(path: Path, readers: Mapping[str, str]) -> "meshio.Mesh":
    """Mesh of meshio, whose errors become input errors."""
    import meshio  # slow to load

    reader = readers[path.suffix.lower()]
    with path.open("rb") as opened:
        if reader == "ply" and PLY_ENDS not in opened.read(HEAD):  # meshio would search without end
            raise InputError("path", f"{path.name} has no {PLY_ENDS.decode()}", "save the mesh again")
    try:
        hushed = contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO())
        with hushed[0], hushed[1], np.errstate(over="ignore"):
            return meshio.read(path, file_format=reader)
    except (Exception, SystemExit) as error:  # meshio raises many kinds on a damaged file, and exits on some
        told = "it is damaged, or of another format" if isinstance(error, SystemExit) else str(error)
        raise InputError(
            "path", f"{path.name} cannot be read: {told or type(error).__name__}", "save the mesh again"
        ) from error


def _dim(name: str) -> int:
    """Topological dimension of a cell with the given name in meshio."""
    return next((dim for stem, dim in _DIMS.items() if name.rstrip("0123456789") == stem), 0)


def _cells(path: Path) -> tuple[Array, dict[str, IntArray]]:
    """Points and cells of the highest dimension, by name."""
    if path.suffix.lower() == ".msh":
        found = gmsh_mesh(path)
        return found.points, dict(found.blocks)
    if path.suffix.lower() == ".obj":
        return obj_facets(path)
    if path.suffix.lower() == ".vtu" and path.read_bytes().count(b"<Piece ") > 1:
        raise InputError("path", f"{path.name} has several pieces", "a file with one piece")
    raw = _read(path, _SURFACES)
    dim, parts = max((_dim(block.type) for block in raw.cells), default=0), dict[str, list[IntArray]]()
    for block in raw.cells:
        name = NAMES.get(block.type)
        if name is None and _dim(block.type) == dim and dim > 0:
            raise InputError(
                "path", f"cells of type {block.type!r} are not supported", f"mesh with: {', '.join(FACETS)}"
            )
        if name is not None and CELLS[name].dim == dim:
            parts.setdefault(name, []).append(np.asarray(block.data, dtype=np.int64))
    return np.asarray(raw.points, dtype=float), {name: np.concatenate(part) for name, part in parts.items()}


def _compact(points: Array, blocks: Mapping[str, IntArray], tags: Mapping[str, IntArray]) -> Mesh:
    """Make a mesh without the points that belong to no cell."""
    used = np.unique(np.concatenate([cells.ravel() for cells in blocks.values()]))
    if len(used) < len(points):
        LOG.info("%d of %d points belong to no cell: dropped", len(points) - len(used), len(points))
    number = np.full(len(points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    kept = {name: number[nodes][number[nodes] >= 0] for name, nodes in tags.items()}
    return Mesh(
        points=points[used],
        blocks={name: number[cells] for name, cells in blocks.items()},
        tags={name: nodes for name, nodes in kept.items() if len(nodes)},
    )
