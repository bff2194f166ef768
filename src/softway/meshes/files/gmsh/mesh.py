"""Mesh of a Gmsh file: its cells, the tags of its physical groups, and the list of what it does not hold."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.files.gmsh.cursor import damaged
from softway.meshes.files.gmsh.msh_file import TYPES, Elements, MshFile
from softway.meshes.files.gmsh.reader import read_msh
from softway.meshes.files.listed_mesh import LeftOut, ListedMesh

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
QUIET = ("Comments", "PartitionedEntities")
"""Sections that say nothing about the body."""


def gmsh_mesh(path: Path, cells: Sequence[str] | None = None, only: Sequence[str] = ()) -> ListedMesh:
    """Read the mesh of a Gmsh file.

    Parameters
    ----------
    path
        Path of the file.
    cells
        Names of the cells to keep; by default all cells of the highest dimension.
    only
        Names of the physical groups to keep; by default all.

    Raises
    ------
    InputError
        For a file that cannot be read, or without the wanted cells.
    """
    try:
        return _made(read_msh(path), cells, only)
    except InputError as error:
        problem = f"{path.name} cannot be read: {error.problem}" if error.where == "path" else error.problem
        raise InputError(error.where, problem, error.remedy) from None


def _made(file: MshFile, cells: Sequence[str] | None, only: Sequence[str]) -> ListedMesh:
    """Mesh of the wanted cells of a file."""
    dim = max((e.dim for e in file.elements), default=0)
    parts: dict[str, list[IntArray]] = {}
    tags: dict[str, list[IntArray]] = {}
    regions: dict[str, list[tuple[str, int, int]]] = {}
    for elements in file.elements:
        numbers, groups = file.node_numbers(elements), file.group_names(elements)
        for group in groups:
            tags.setdefault(group, []).append(numbers.ravel())
        if _wanted(elements, dim, cells) and (not only or set(groups) & set(only)):
            cell = NAMES[TYPES[elements.kind][0]]
            first = sum(len(part) for part in parts.setdefault(cell, []))
            parts[cell].append(numbers)
            for group in groups:
                regions.setdefault(group, []).append((cell, first, first + len(numbers)))
    if not parts:
        raise _nothing(file, tags, only)
    blocks = {name: np.concatenate(part) for name, part in parts.items()}
    made = {name: np.unique(np.concatenate(part)) for name, part in tags.items()}
    used = np.zeros(len(file.points), dtype=bool)
    for block in blocks.values():
        used[block] = True
    lost = () if only or cells else _unused(file, used, made)
    return ListedMesh(file.points, blocks, made, (*_sections(file), *lost), _regions(blocks, regions))


def _regions(blocks: dict[str, IntArray], found: dict[str, list[tuple[str, int, int]]]) -> dict[str, IntArray]:
    """Numbers of the cells of groups in the order of the blocks, from ranges in the blocks."""
    counts = [len(cells) for cells in blocks.values()]
    start = dict(zip(blocks, np.cumsum([0, *counts[:-1]]).tolist(), strict=True))
    return {
        group: np.concatenate([np.arange(first, last) + start[cell] for cell, first, last in ranges])
        for group, ranges in found.items()
    }


def _wanted(elements: Elements, dim: int, cells: Sequence[str] | None) -> bool:
    """True for the elements that form the body; refuses those of the body that have no cells here."""
    name = NAMES.get(TYPES[elements.kind][0])
    if cells is not None:
        return name in cells
    if name is None and elements.dim == dim and dim > 0:
        kind = TYPES[elements.kind][0]
        raise InputError("path", f"cells of type {kind!r} are not supported", f"mesh with: {', '.join(FACETS)}")
    return name is not None and CELLS[name].dim == dim


def _nothing(file: MshFile, tags: dict[str, list[IntArray]], only: Sequence[str]) -> InputError:
    """Error for a file without any of the wanted cells."""
    if not any(elements.dim for elements in file.elements):
        return damaged("no elements but points", "a file with triangles, or other cells of a body")
    if only:
        known = ", ".join(sorted(tags)) or "no groups"
        return InputError("only", f"no cells in the groups {', '.join(only)}", f"one of: {known}")
    found = ", ".join(sorted({TYPES[e.kind][0] for e in file.elements}))
    return InputError("cells", f"none of the wanted cells among {found}", f"one of: {', '.join(FACETS)}")


def _sections(file: MshFile) -> tuple[LeftOut, ...]:
    """Sections that are not honoured, and names of groups without elements."""
    found = [
        LeftOut(card=f"${name:.60}", count=count, lines=(), matters=name not in QUIET)
        for name, count in file.ignored.items()
    ]
    lost = file.unused_names()
    if lost:
        told = f"groups without elements: {', '.join(name[:60] for name in lost)}"
        found.append(LeftOut(card="$PhysicalNames", count=len(lost), lines=(), meaning=told))
    return tuple(found)


def _unused(file: MshFile, used: BoolArray, tags: dict[str, IntArray]) -> tuple[LeftOut, ...]:
    """Nodes that belong to no cell, groups of such nodes, and elements of no use."""
    found = []
    if not used.all():
        told, count = "nodes that belong to no cell", int((~used).sum())
        found.append(LeftOut(card="$Nodes", count=count, lines=(), meaning=told, matters=False))
    for name, nodes in tags.items():
        lost = int((~used[nodes]).sum())
        if lost:
            told = f"of {len(nodes)} nodes belong to no cell"
            found.append(LeftOut(card=f"group {name:.60}", count=lost, lines=(), meaning=told))
    dim = max(e.dim for e in file.elements)
    loose = sum(len(e.labels) for e in file.elements if e.dim < dim and not e.groups)
    if loose:
        told = "elements of lower dimension in no physical group"
        found.append(LeftOut(card="$Elements", count=loose, lines=(), meaning=told, matters=False))
    return tuple(found)
