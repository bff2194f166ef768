"""Nodes and elements of Gmsh files of version 2."""

import numpy as np

from softway.meshes.files.gmsh.cursor import Cursor, Tokens, damaged
from softway.meshes.files.gmsh.msh_file import Elements, MshFile, known_type

NODE = np.dtype([("label", "<i4"), ("x", "<f8", 3)])
Row = tuple[int, int, tuple[int, ...], tuple[int, ...]]
"""Type, label, groups and nodes of an element."""


def read_nodes(cursor: Cursor, found: MshFile, *, binary: bool) -> None:
    """Read the section of the nodes."""
    if binary:
        count = _count(cursor.line(), "Nodes")
        rows = cursor.array(NODE, count)
        found.add_nodes(rows["label"].astype(np.int64), rows["x"].astype(float))
        cursor.close("Nodes")
        return
    tokens = Tokens("Nodes", cursor.body("Nodes"))
    count = tokens.one()
    words = tokens.array("S64", 4 * count).reshape(count, 4)
    tokens.close()
    try:
        found.add_nodes(words[:, 0].astype(np.int64), words[:, 1:].astype(float))
    except ValueError as error:
        raise damaged(f"$Nodes: {error}") from None


def read_elements(cursor: Cursor, found: MshFile, *, binary: bool) -> None:
    """Read the section of the elements."""
    rows = _binary_rows(cursor) if binary else _text_rows(cursor.body("Elements"))
    batches: dict[tuple[int, tuple[int, ...]], list[Row]] = {}
    for row in rows:
        batches.setdefault((row[0], row[2]), []).append(row)
    for (kind, groups), batch in batches.items():
        try:
            labels, nodes = (np.array([row[k] for row in batch], dtype=np.int64) for k in (1, 3))
        except OverflowError:
            raise damaged("$Elements holds numbers beyond 64 bits") from None
        found.elements.append(Elements(kind, labels, nodes, groups))


def _text_rows(body: bytes) -> list[Row]:
    """Type, label, groups and nodes of each element of a text file."""
    lines = [line for line in body.split(b"\n") if line.strip()]
    count = _count(lines[0].decode("latin-1") if lines else "", "Elements")
    if count != len(lines) - 1:
        raise damaged(f"$Elements announces {count} elements and holds {len(lines) - 1}")
    return [_row(line) for line in lines[1:]]


def _row(line: bytes) -> Row:
    """Type, label, groups and nodes of an element."""
    try:
        label, kind, tags, *rest = map(int, line.split())
    except ValueError:
        raise damaged(f"$Elements: {line.decode('latin-1').strip()!r:.60} is no element") from None
    if tags < 0 or len(rest) != tags + known_type(kind)[2]:
        name, _, count = known_type(kind)
        raise damaged(f"the element {label} has {len(rest) - tags} nodes; a {name} has {count}")
    return kind, label, _groups(rest[:tags]), tuple(rest[tags:])


def _groups(tags: list[int]) -> tuple[int, ...]:
    """Physical group of an element: the first of its tags, unless it is zero."""
    return tuple(tags[:1]) if tags and tags[0] else ()


def _binary_rows(cursor: Cursor) -> list[Row]:
    """Type, label, groups and nodes of each element of a file of bytes."""
    left, rows = _count(cursor.line(), "Elements"), []
    while left > 0:
        kind, count, tags = cursor.array("<i4", 3).tolist()
        size = known_type(kind)[2]
        if not (0 < count <= left and tags >= 0):
            raise damaged(f"$Elements announces {left} elements and holds {count}")
        table = cursor.array("<i4", count * (1 + tags + size)).reshape(count, -1).tolist()
        rows += [(kind, row[0], _groups(row[1 : 1 + tags]), tuple(row[1 + tags :])) for row in table]
        left -= count
    cursor.close("Elements")
    return rows


def _count(line: str, name: str) -> int:
    """Number of entries that a section announces."""
    if not line.strip().isdigit():
        raise damaged(f"${name} begins with {line.strip()!r:.40}, not with the number of its entries")
    return int(line)
