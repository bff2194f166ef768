"""Entities, nodes and elements of Gmsh files of the versions 4.0 and 4.1."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softway.meshes.files.gmsh.cursor import Cursor, Tokens, damaged
from softway.meshes.files.gmsh.msh_file import Elements, MshFile, known_type

Groups = dict[tuple[int, int], tuple[int, ...]]
"""Numbers of the physical groups of an entity, by its dimension and tag."""
INT, SIZE, REAL = "<i4", "<u8", "<f8"


class Numbers:
    """Numbers of a section, as text or as bytes.

    Parameters
    ----------
    cursor
        Place at the begin of the section.
    name
        Name of the section.
    binary
        True for bytes.
    """

    __slots__ = ("cursor", "name", "tokens")

    def __init__(self, cursor: Cursor, name: str, *, binary: bool) -> None:
        self.cursor, self.name = cursor, name
        self.tokens = None if binary else Tokens(name, cursor.body(name))

    def array(self, dtype: str, count: int) -> NDArray[Any]:
        """Next numbers."""
        if self.tokens is None:
            return self.cursor.array(dtype, count)
        return self.tokens.array(np.float64 if dtype == REAL else np.int64, count)

    def whole(self, dtype: str, count: int) -> list[int]:
        """Next whole numbers."""
        return [int(n) for n in self.array(dtype, count)]

    def rows(self, pattern: list[str], count: int) -> list[NDArray[Any]]:
        """Columns of a table whose columns have several types."""
        if self.tokens is None:
            table = self.cursor.array([(str(k), dtype) for k, dtype in enumerate(pattern)], count)
            return [table[str(k)] for k in range(len(pattern))]
        words = self.tokens.array("S64", count * len(pattern)).reshape(count, -1)
        try:
            return [words[:, k].astype(float if d == REAL else np.int64) for k, d in enumerate(pattern)]
        except (ValueError, OverflowError) as error:
            raise damaged(f"${self.name}: {error}") from None

    def close(self) -> None:
        """Refuse a section that holds more than it announces."""
        if self.tokens is None:
            self.cursor.close(self.name)
        else:
            self.tokens.close()


def read_entities(cursor: Cursor, *, binary: bool, old: bool) -> Groups:
    """Physical groups of the entities; ``old`` for version 4.0."""
    section, groups = Numbers(cursor, "Entities", binary=binary), Groups()
    for dim, count in enumerate(section.whole(SIZE, 4)):
        for _ in range(count):
            (tag,) = section.whole(INT, 1)
            section.array(REAL, 3 if dim == 0 and not old else 6)
            numbers = section.whole(INT, section.whole(SIZE, 1)[0])
            groups[dim, tag] = tuple(dict.fromkeys(n for n in numbers if n))
            if dim > 0:
                section.array(INT, section.whole(SIZE, 1)[0])
    section.close()
    return groups


def read_nodes(cursor: Cursor, found: MshFile, *, binary: bool, old: bool) -> None:
    """Read the section of the nodes."""
    section = Numbers(cursor, "Nodes", binary=binary)
    blocks, total = section.whole(SIZE, 2 if old else 4)[:2]
    labels, points = [np.zeros(0, dtype=np.int64)], [np.zeros((0, 3))]
    for _ in range(blocks):
        dim, _, parametric = section.whole(INT, 3)
        (count,) = section.whole(SIZE, 1)
        more = max(0, dim) if parametric else 0
        if old:
            columns = section.rows([INT, *[REAL] * (3 + more)], count)
            labels.append(columns[0].astype(np.int64))
            points.append(np.column_stack(columns[1:4]).reshape(-1, 3))
        else:
            labels.append(section.array(SIZE, count).astype(np.int64))
            points.append(section.array(REAL, count * (3 + more)).reshape(count, 3 + more)[:, :3])
    section.close()
    _require("Nodes", sum(map(len, labels)), total)
    found.add_nodes(np.concatenate(labels), np.concatenate(points))


def read_elements(cursor: Cursor, found: MshFile, groups: Groups, *, binary: bool, old: bool) -> None:
    """Read the section of the elements."""
    section = Numbers(cursor, "Elements", binary=binary)
    blocks, total = section.whole(SIZE, 2 if old else 4)[:2]
    number = INT if old else SIZE
    seen = 0
    for _ in range(blocks):
        first, second, kind = section.whole(INT, 3)
        (count,) = section.whole(SIZE, 1)
        width = 1 + known_type(kind)[2]
        table = section.array(number, count * width).reshape(count, width).astype(np.int64)
        entity = (second, first) if old else (first, second)
        found.elements.append(Elements(kind, table[:, 0], table[:, 1:], groups.get(entity, ())))
        seen += count
    section.close()
    _require("Elements", seen, total)


def _require(name: str, count: int, told: int) -> None:
    """Refuse a section with another number of entries than it announces."""
    if count != told:
        raise damaged(f"${name} announces {told} entries and holds {count}")
