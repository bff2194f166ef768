"""Reader of a Gmsh file, section by section."""

from pathlib import Path

from softway.meshes.files.gmsh import msh2, msh4
from softway.meshes.files.gmsh.cursor import Cursor, damaged, decoded
from softway.meshes.files.gmsh.msh_file import MshFile, physical_names

ONCE = ("Nodes", "Elements", "PhysicalNames", "Entities")
"""Sections that may occur once."""


def read_msh(path: Path) -> MshFile:
    """Read a Gmsh file of version 2 or 4 in full.

    Raises
    ------
    InputError
        For a file that is damaged, that names nodes which are not there, or of another version.
    """
    cursor, found = Cursor(path.read_bytes()), MshFile()
    version, binary = _format(cursor)
    groups, seen = msh4.Groups(), set[str]()
    while not cursor.ended:
        line = cursor.line()
        name = line[1:]
        if line and not line.startswith("$"):
            raise damaged(f"{line!r:.60} stands between two sections")
        if name in seen and name in ONCE:
            raise damaged(f"the section ${name} occurs twice", "a file with one mesh")
        seen.add(name)
        if name == "PhysicalNames":
            found.names = physical_names(decoded(cursor.body(name)).splitlines())
        elif name == "Entities" and version >= 4.0:
            groups = msh4.read_entities(cursor, binary=binary, old=version < 4.1)
        elif name == "Nodes":
            _nodes(cursor, found, version, binary=binary)
        elif name == "Elements" and version >= 4.0:
            msh4.read_elements(cursor, found, groups, binary=binary, old=version < 4.1)
        elif name == "Elements":
            msh2.read_elements(cursor, found, binary=binary)
        elif name:
            cursor.body(name)
            found.ignored[name] = found.ignored.get(name, 0) + 1
    return found


def _nodes(cursor: Cursor, found: MshFile, version: float, *, binary: bool) -> None:
    """Read the nodes of any version."""
    if version >= 4.0:
        msh4.read_nodes(cursor, found, binary=binary, old=version < 4.1)
    else:
        msh2.read_nodes(cursor, found, binary=binary)


def _format(cursor: Cursor) -> tuple[float, bool]:
    """Version of the file, and True if its numbers are bytes."""
    while not cursor.ended and (line := cursor.line()) != "$MeshFormat":
        if line == "$Comments":
            cursor.body("Comments")
        elif line:
            raise damaged(f"the file begins with {line!r:.60}, not with $MeshFormat")
    words = cursor.line().split() if not cursor.ended else []
    if len(words) != 3 or words[1] not in ("0", "1") or words[2] != "8":
        raise damaged(f"$MeshFormat: {' '.join(words)!r:.60} is not version, kind of file and size of numbers")
    if words[0] not in ("2", "2.0", "2.1", "2.2", "4", "4.0", "4.1"):
        raise damaged(f"version {words[0]:.20} of the format is not supported", "save the mesh in version 4.1 or 2.2")
    if words[1] == "1" and cursor.array("<i4", 1)[0] != 1:
        raise damaged("the bytes of the numbers are in the other order", "save the mesh as text")
    cursor.close("MeshFormat")
    return float(words[0]), words[1] == "1"
