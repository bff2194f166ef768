"""Content of a Gmsh file: nodes and elements by their labels, physical groups, and what nobody reads."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.files.gmsh.cursor import damaged

TYPES: Mapping[int, tuple[str, int, int]] = {
    15: ("vertex", 0, 1),
    1: ("line", 1, 2),
    8: ("line3", 1, 3),
    26: ("line4", 1, 4),
    27: ("line5", 1, 5),
    28: ("line6", 1, 6),
    2: ("triangle", 2, 3),
    9: ("triangle6", 2, 6),
    20: ("triangle9", 2, 9),
    21: ("triangle10", 2, 10),
    22: ("triangle12", 2, 12),
    23: ("triangle15", 2, 15),
    24: ("triangle15b", 2, 15),
    25: ("triangle21", 2, 21),
    3: ("quad", 2, 4),
    10: ("quad9", 2, 9),
    16: ("quad8", 2, 8),
    36: ("quad16", 2, 16),
    37: ("quad25", 2, 25),
    38: ("quad36", 2, 36),
    4: ("tetra", 3, 4),
    11: ("tetra10", 3, 10),
    29: ("tetra20", 3, 20),
    30: ("tetra35", 3, 35),
    31: ("tetra56", 3, 56),
    5: ("hexahedron", 3, 8),
    12: ("hexahedron27", 3, 27),
    17: ("hexahedron20", 3, 20),
    92: ("hexahedron64", 3, 64),
    93: ("hexahedron125", 3, 125),
    6: ("wedge", 3, 6),
    13: ("wedge18", 3, 18),
    18: ("wedge15", 3, 15),
    7: ("pyramid", 3, 5),
    14: ("pyramid14", 3, 14),
    19: ("pyramid13", 3, 13),
}
"""Name, dimension and number of nodes of the types of elements; the names are those of meshio."""
_HEX20 = [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15]
ORDER: Mapping[str, list[int]] = {
    "tetra10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
    "hexahedron20": _HEX20,
    "hexahedron27": [*_HEX20, 22, 23, 21, 24, 20, 25, 26],
}
"""Nodes in the order of VTK among those in the order of Gmsh, where these differ."""
KINDS = ("POINT", "CURVE", "SURFACE", "VOLUME")
"""What a physical group is made of, by its dimension."""


@dataclass(frozen=True, slots=True, eq=False)
class Elements:
    """Elements of one type with the same physical groups.

    Parameters
    ----------
    kind
        Number of the type.
    labels
        (e,) labels of the elements.
    nodes
        (e, a) labels of the nodes.
    groups
        Numbers of the physical groups.
    """

    kind: int
    labels: IntArray
    nodes: IntArray
    groups: tuple[int, ...] = ()

    @property
    def dim(self) -> int:
        """Dimension of the elements."""
        return TYPES[self.kind][1]


class MshFile:
    """Sections of a Gmsh file, as far as they have been read.

    Its members are the ``labels`` (n,) and coordinates ``points`` (n, 3) of the nodes, ``order`` (n,), the numbers of
    the nodes in the order of their labels, the ``elements`` in the order of the file, the ``names`` of the physical
    groups by dimension and number, and the sections that are ``ignored``, with their number.
    """

    __slots__ = ("elements", "ignored", "labels", "names", "order", "points")

    def __init__(self) -> None:
        self.labels, self.order = np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        self.points: Array = np.zeros((0, 3))
        self.elements: list[Elements] = []
        self.names: dict[tuple[int, int], str] = {}
        self.ignored: dict[str, int] = {}

    def add_nodes(self, labels: IntArray, points: Array) -> None:
        """Set the nodes; a label that occurs twice is refused."""
        order = np.argsort(labels, kind="stable")
        twice = np.flatnonzero(np.diff(labels[order]) == 0)
        if len(twice):
            raise damaged(f"the node {labels[order[twice[0]]]} occurs twice")
        self.labels, self.points, self.order = labels, points, order

    def node_numbers(self, elements: Elements) -> IntArray:
        """Numbers (e, a) of the nodes of elements, in the order of VTK."""
        if not len(self.labels):
            raise damaged("the file has elements, but no nodes")
        place = np.searchsorted(self.labels, elements.nodes, sorter=self.order)
        found = self.order[np.minimum(place, len(self.labels) - 1)]
        wrong = self.labels[found] != elements.nodes
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            raise damaged(
                f"the element {elements.labels[row]} names the node {elements.nodes[row, column]}, which is not there"
            )
        return np.asarray(found[:, ORDER.get(TYPES[elements.kind][0], slice(None))], dtype=np.int64)

    def group_names(self, elements: Elements) -> tuple[str, ...]:
        """Tags of the physical groups of elements; the number stands for a missing name."""
        return tuple(dict.fromkeys(self.tag(elements.dim, number) for number in elements.groups))

    def tag(self, dim: int, number: int) -> str:
        """Tag of a physical group.

        If groups of several dimensions have one name, it is the one of the facets of the cells, or else of the
        highest dimension; the others are called such as ``CURVE=name``.
        """
        name = self.names.get((dim, number), str(number))
        alike = {d for d, n in self._groups() if self.names.get((d, n), str(n)) == name}
        if len(alike) < 2:
            return name
        facets = max((e.dim for e in self.elements), default=0) - 1
        first = facets if facets in alike else max(alike)
        return name if dim == first else f"{KINDS[dim]}={name}"

    def _groups(self) -> set[tuple[int, int]]:
        """Dimension and number of all physical groups with elements."""
        return {(e.dim, number) for e in self.elements for number in e.groups}

    def unused_names(self) -> list[str]:
        """Names of physical groups without an element."""
        used = self._groups()
        return [name for group, name in self.names.items() if group not in used]


def known_type(kind: int) -> tuple[str, int, int]:
    """Name, dimension and number of nodes of a type of elements."""
    if kind not in TYPES:
        raise damaged(f"elements of type {kind} are not supported", "a mesh of triangles, quadrangles, tetrahedra, ...")
    return TYPES[kind]


def physical_names(lines: list[str]) -> dict[tuple[int, int], str]:
    """Names of the physical groups, from the lines of their section."""
    names: dict[tuple[int, int], str] = {}
    rows = [line for line in lines if line.strip()]
    if not rows or rows[0].strip() != str(len(rows) - 1):
        raise damaged(
            f"$PhysicalNames announces {(rows or ['nothing'])[0]!r:.40} and holds {max(len(rows) - 1, 0)} names"
        )
    for row in rows[1:]:
        parts = row.split(None, 2)
        if len(parts) != 3 or not (parts[0].isdigit() and parts[1].lstrip("-").isdigit()):
            raise damaged(f"$PhysicalNames: {row!r:.60} is not dimension, number and name")
        group, name = (int(parts[0]), int(parts[1])), parts[2].strip().removeprefix('"').removesuffix('"')
        if group[0] > 3 or names.get(group, name) != name:
            raise damaged(
                f"$PhysicalNames: the group {group[0]} {group[1]} has two names, or more than three dimensions"
            )
        names[group] = name
    return names
