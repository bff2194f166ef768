"""Gmsh files by their parts, in every version, and the signs of what they hold."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from softway.meshes.files.mesh_files import FileMesh

Sign = Callable[[FileMesh], bool]
"""Test that a mesh or its list holds what a mutation added."""
CELLS = {"quad4": 3, "tri3": 2, "hex8": 5, "tet4": 4}
"""Types of Gmsh."""
TETS = ((0, 1, 3, 7), (0, 1, 7, 5), (0, 2, 7, 3), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 7, 6))
SIZES = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 15: 1, 6: 6}


@dataclass(slots=True)
class Element:
    """Element: label, type, dimension, entity and labels of its nodes."""

    label: int
    kind: int
    dim: int
    entity: int
    nodes: list[int]


@dataclass(slots=True)
class Msh:
    """Parts of a Gmsh file.

    Parameters
    ----------
    nodes
        Labels and coordinates.
    elements
        Elements of all dimensions.
    groups
        Physical groups of each entity by dimension and tag.
    names
        Dimension, number and name of each physical group.
    sections
        Further sections by their text.
    signs
        Description of an addition, and the test that it is in the mesh or in the list.
    version, binary
        Version of the file, and whether its numbers are bytes.
    counts
        Change of the announced numbers of nodes and elements.
    """

    nodes: list[tuple[int, tuple[float, float, float]]]
    elements: list[Element]
    groups: dict[tuple[int, int], list[int]]
    names: list[tuple[int, int, str]]
    sections: list[str] = field(default_factory=list)
    signs: list[tuple[str, Sign]] = field(default_factory=list)
    version: str = "2.2"
    binary: bool = False
    counts: tuple[int, int] = (0, 0)

    @property
    def dim(self) -> int:
        """Dimension of the cells."""
        return max(e.dim for e in self.elements)

    @property
    def data(self) -> bytes:
        """The file."""
        head = f"$MeshFormat\n{self.version} {int(self.binary)} 8\n".encode()
        head += (b"\x01\x00\x00\x00\n" if self.binary else b"") + b"$EndMeshFormat\n"
        rows = "".join(f'{d} {n} "{name}"\n' for d, n, name in self.names)
        names = f"$PhysicalNames\n{len(self.names)}\n{rows}$EndPhysicalNames\n" if self.names else ""
        body = _two(self) if self.version == "2.2" else _four(self)
        return head + names.encode() + body + "".join(self.sections).encode()


def grid(rng: np.random.Generator) -> Msh:
    """A row of cells with groups at both ends, in any version."""
    cell = str(rng.choice(list(CELLS)))
    count, flat = int(rng.integers(1, 4)), cell in ("quad4", "tri3")
    high = 1 if flat else 2
    nodes = [
        (1 + i + (count + 1) * (j + 2 * k), (float(i), float(j), float(k)))
        for k in range(high)
        for j in range(2)
        for i in range(count + 1)
    ]
    across = [(count + 1) * n for n in range(2 * high)]
    elements: list[Element] = []
    for i in range(count):
        corners = [1 + i + step + away for away in across for step in (0, 1)]
        for local in _local(cell):
            elements.append(Element(len(elements) + 1, CELLS[cell], 2 if flat else 3, 1, [corners[n] for n in local]))
    for entity, start in ((1, 1), (2, count + 1)):
        ends = [start + away for away in across]
        pieces = {"quad4": [(0, 1)], "tri3": [(0, 1)], "hex8": [(0, 1, 3, 2)], "tet4": [(0, 1, 3), (0, 3, 2)]}[cell]
        for piece in pieces:
            kind = {2: 1, 3: 2, 4: 3}[len(piece)]
            label = len(elements) + 1
            elements.append(Element(label, kind, 1 if flat else 2, entity, [ends[n] for n in piece]))
    dim = 2 if flat else 3
    groups = {(dim, 1): [1], (dim - 1, 1): [2], (dim - 1, 2): [3]}
    names = [(dim, 1, "part"), (dim - 1, 2, "left"), (dim - 1, 3, "right")]
    version = str(rng.choice(["2.2", "4.0", "4.1"]))
    return Msh(nodes, elements, groups, names, version=version, binary=bool(rng.random() < 0.4))


def _local(cell: str) -> tuple[tuple[int, ...], ...]:
    """Corners of the cells of one square or cube."""
    if cell == "tet4":
        return TETS
    return {"quad4": ((0, 1, 3, 2),), "tri3": ((0, 1, 3), (0, 3, 2)), "hex8": ((0, 1, 3, 2, 4, 5, 7, 6),)}[cell]


def _pack(made: Msh, *parts: tuple[str, list[float] | list[int]]) -> bytes:
    """Numbers as bytes of the given types, or as a line of text."""
    if made.binary:
        return b"".join(np.array(values).astype(kind).tobytes() for kind, values in parts)
    return (" ".join(repr(v) for _, values in parts for v in values) + "\n").encode()


def _end(made: Msh, name: str) -> bytes:
    return (b"\n" if made.binary else b"") + f"$End{name}\n".encode()


def _two(made: Msh) -> bytes:
    """Nodes and elements of version 2.2."""
    out = f"$Nodes\n{len(made.nodes) + made.counts[0]}\n".encode()
    out += b"".join(_pack(made, ("<i4", [label]), ("<f8", list(x))) for label, x in made.nodes) + _end(made, "Nodes")
    rows = [(e, g) for e in made.elements for g in made.groups.get((e.dim, e.entity)) or [0]]
    out += f"$Elements\n{len(rows) + made.counts[1]}\n".encode()
    for element, group in rows:
        if made.binary:
            out += _pack(made, ("<i4", [element.kind, 1, 2, element.label, group, element.entity, *element.nodes]))
        else:
            row = [element.label, element.kind, 2, group, element.entity, *element.nodes]
            out += _pack(made, ("<i4", row))
    return out + _end(made, "Elements")


def _four(made: Msh) -> bytes:
    """Entities, nodes and elements of the versions 4.0 and 4.1."""
    old = made.version == "4.0"
    known = {(e.dim, e.entity): made.groups.get((e.dim, e.entity), []) for e in made.elements}
    out = b"$Entities\n" + _pack(made, ("<u8", [sum(d == k for d, _ in known) for k in range(4)]))
    for (dim, tag), groups in sorted(known.items()):
        box = [0.0] * (3 if dim == 0 and not old else 6)
        more = [("<u8", [0])] if dim else []
        out += _pack(made, ("<i4", [tag]), ("<f8", box), ("<u8", [len(groups)]), ("<i4", groups), *more)
    out += _end(made, "Entities") + b"$Nodes\n"
    count, labels = len(made.nodes), [label for label, _ in made.nodes]
    out += _pack(made, ("<u8", [1, count + made.counts[0], *([] if old else [1, count])]))
    out += _pack(made, ("<i4", [1, made.dim, 0] if old else [made.dim, 1, 0]), ("<u8", [count]))
    if old:
        out += b"".join(_pack(made, ("<i4", [label]), ("<f8", list(x))) for label, x in made.nodes)
    else:
        out += b"".join(_pack(made, ("<u8", [label])) for label in labels)
        out += b"".join(_pack(made, ("<f8", list(x))) for _, x in made.nodes)
    out += _end(made, "Nodes") + b"$Elements\n"
    batches: dict[tuple[int, int, int], list[Element]] = {}
    for e in made.elements:
        batches.setdefault((e.dim, e.entity, e.kind), []).append(e)
    total = len(made.elements) + made.counts[1]
    out += _pack(made, ("<u8", [len(batches), total, *([] if old else [1, total])]))
    size = "<i4" if old else "<u8"
    for (dim, entity, kind), batch in batches.items():
        out += _pack(made, ("<i4", [entity, dim, kind] if old else [dim, entity, kind]), ("<u8", [len(batch)]))
        out += b"".join(_pack(made, (size, [e.label, *e.nodes])) for e in batch)
    return out + _end(made, "Elements")
