"""Readers of mesh files; the only module that uses meshio."""

import contextlib
import io
import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS, FLAT
from softway.meshes.files.abaqus_deck import plain_deck
from softway.meshes.mesh import Mesh

LOG = logging.getLogger(__name__)
NAMES = {
    "line": "bar2",
    "line3": "bar3",
    "triangle": "tri3",
    "triangle6": "tri6",
    "quad": "quad4",
    "quad8": "quad8",
    "quad9": "quad9",
    "tetra": "tet4",
    "tetra10": "tet10",
    "hexahedron": "hex8",
    "hexahedron20": "hex20",
    "hexahedron27": "hex27",
}
"""Name of a cell in meshio -> name here; both use the node order of VTK."""

_READERS = {".msh": "gmsh", ".inp": "abaqus"}
_SURFACES = {".stl": "stl", ".obj": "obj", ".ply": "ply", ".msh": "gmsh", ".vtu": "vtu"}
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


def read_mesh(path: str | Path, scale: float = 1.0, *, cells: Sequence[str] | None = None) -> Mesh:
    """Read a Gmsh ``.msh`` or an Abaqus/CalculiX ``.inp`` file.

    Physical groups of any dimension, node sets and element sets become tags, which hold the nodes of the named
    entities. Cells of lower dimension are used for tags only. Points without a cell are dropped, as is the constant
    third coordinate of a plane mesh.

    Parameters
    ----------
    path
        Path of the file.
    scale
        Length unit of the file [m].
    cells
        Names of the cells to keep; by default all cells of the highest dimension.
    """
    raw, sets = _read(Path(path), _READERS)
    dim = max((_dim(block.type) for block in raw.cells), default=0)
    blocks = _blocks(raw, dim, cells)
    tags = _groups(raw) if Path(path).suffix.lower() == ".msh" else {**_element_sets(raw, sets), **_node_sets(raw)}
    points = np.asarray(raw.points, dtype=float) * scale
    if dim == 2 and points.shape[1] == 3 and np.ptp(points[:, 2]) <= 1e-12 * np.ptp(points, axis=0).max():
        points = points[:, :2]
    return _compact(points, blocks, tags)


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
    raw, _ = _read(path, _SURFACES)
    dim = max((_dim(block.type) for block in raw.cells), default=0)
    if dim == 0:
        raise InputError("path", f"{path.name} has no facets", "a file with triangles, or with lines in a plane")
    blocks = _blocks(raw, dim, None)
    points = np.asarray(raw.points, dtype=float) * scale
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


def _read(path: Path, readers: Mapping[str, str]) -> tuple[meshio.Mesh, list[str | None]]:
    """Mesh of meshio, and the set names of the element blocks in a deck; errors of meshio become input errors."""
    known = ", ".join(readers)
    if not path.is_file():
        raise InputError(
            "path",
            f"{'a folder' if path.is_dir() else 'no such file'}: {path}",
            f"the path of a {' or '.join(readers)} file, relative to the scenario",
        )
    if path.suffix.lower() not in readers:
        raise InputError("path", f"{path.name} has the ending {path.suffix!r}", f"one of: {known}")
    size = path.stat().st_size
    if not 0 < size <= LARGEST:
        raise InputError("path", f"{path.name} has {size} bytes", f"a mesh file of up to {LARGEST:.0e} bytes")
    reader = readers[path.suffix.lower()]
    with path.open("rb") as opened:
        if reader == "ply" and PLY_ENDS not in opened.read(HEAD):  # meshio would search without end
            raise InputError("path", f"{path.name} has no {PLY_ENDS.decode()}", "save the mesh again")
    text, sets = plain_deck(path) if reader == "abaqus" else ("", [])
    try:
        hushed = contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO())
        with hushed[0], hushed[1], np.errstate(over="ignore"):
            return meshio.read(io.StringIO(text) if text else path, file_format=reader), sets
    except (Exception, SystemExit) as error:  # meshio raises many kinds on a damaged file, and exits on some
        told = "it is damaged, or of another format" if isinstance(error, SystemExit) else str(error)
        raise InputError(
            "path", f"{path.name} cannot be read: {told or type(error).__name__}", "save the mesh again"
        ) from error


def _dim(name: str) -> int:
    """Topological dimension of a cell with the given name in meshio."""
    return next((dim for stem, dim in _DIMS.items() if name.rstrip("0123456789") == stem), 0)


def _blocks(raw: meshio.Mesh, dim: int, wanted: Sequence[str] | None) -> dict[str, IntArray]:
    """Wanted cells, or all cells of the highest dimension, by name."""
    parts: dict[str, list[IntArray]] = {}
    for block in raw.cells:
        name = NAMES.get(block.type)
        if name is None and _dim(block.type) == dim and dim > 0 and wanted is None:
            raise InputError(
                "path", f"cells of type {block.type!r} are not supported", f"mesh with: {', '.join(FACETS)}"
            )
        if name is None or (wanted is None and CELLS[name].dim != dim) or (wanted is not None and name not in wanted):
            continue
        parts.setdefault(name, []).append(np.asarray(block.data, dtype=np.int64))
    if not parts:
        found = sorted({block.type for block in raw.cells})
        raise InputError(
            "cells", f"none of the wanted cells among {', '.join(found) or 'no cells'}", f"one of: {', '.join(FACETS)}"
        )
    return {name: np.concatenate(part) for name, part in parts.items()}


def _groups(raw: meshio.Mesh) -> dict[str, IntArray]:
    """Nodes of the physical groups of Gmsh; the number of a group replaces a missing name."""
    numbers = raw.cell_data.get("gmsh:physical", [])
    names = {(int(value[1]), int(value[0])): name for name, value in raw.field_data.items()}
    parts: dict[str, list[IntArray]] = {}
    for block, marks in zip(raw.cells, numbers, strict=False):
        dim = _dim(block.type)
        for mark in np.unique(marks):
            if mark != 0:
                name = names.get((dim, int(mark)), str(int(mark)))
                parts.setdefault(name, []).append(np.asarray(block.data)[np.asarray(marks) == mark].ravel())
    return {name: np.concatenate(part).astype(np.int64) for name, part in parts.items()}


def _element_sets(raw: meshio.Mesh, names: Sequence[str | None]) -> dict[str, IntArray]:
    """Element sets as node sets, with the names of the element blocks in the deck."""
    found: dict[str, list[IntArray]] = {}
    for name, parts in raw.cell_sets.items():
        called = names[int(name.removeprefix("block "))] if name.startswith("block ") else name
        for block, part in zip(raw.cells, parts, strict=False):
            if called is not None and part is not None and len(part):
                found.setdefault(called, []).append(np.asarray(block.data, dtype=np.int64)[np.asarray(part)].ravel())
    return {name: np.concatenate(nodes) for name, nodes in found.items()}


def _node_sets(raw: meshio.Mesh) -> dict[str, IntArray]:
    sets: Mapping[str, Any] = raw.point_sets
    return {name: np.asarray(nodes, dtype=np.int64) for name, nodes in sets.items() if len(nodes)}


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
