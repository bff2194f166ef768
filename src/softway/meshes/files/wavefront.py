"""Points and facets of Wavefront files (OBJ)."""

from pathlib import Path

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError

_QUIET = {"vn", "vt", "g", "o", "s", "l", "p", "mtllib", "usemtl", "usemap", "maplib", "lod", "bevel"}
"""Statements that make no facet."""


def obj_facets(path: Path) -> tuple[Array, dict[str, IntArray]]:
    r"""Read the points (n, 3), and the triangles and quadrangles by the names of their cells.

    Corners may count from the last point (negative numbers), carry numbers of textures and normals, and stand in
    several lines that end with a backslash.

    Raises
    ------
    InputError
        For corners that are not there, polygons of more corners, and curved surfaces.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a.obj"
    >>> _ = path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 -1//1\n")
    >>> obj_facets(path)[1]["tri3"].tolist()
    [[0, 1, 2]]
    """
    points: list[list[float]] = []
    facets: dict[str, list[list[int]]] = {}
    text = path.read_text(encoding="utf-8", errors="replace").replace("\\\n", " ")
    for count, line in enumerate(text.split("\n"), start=1):
        words = line.partition("#")[0].split()
        try:
            if not words:
                continue
            if words[0] == "v":
                points.append([float(word) for word in words[1:4]])
            elif words[0] == "f":
                corners = _corners(words[1:], len(points))
                facets.setdefault({3: "tri3", 4: "quad4"}[len(corners)], []).append(corners)
            elif words[0] not in _QUIET:
                raise ValueError(f"{words[0]:.40} is not supported")
        except KeyError:
            raise _unreadable(
                path, count, f"a polygon of {len(words) - 1} corners", "triangles and quadrangles"
            ) from None
        except ValueError as error:
            raise _unreadable(path, count, str(error), "save the mesh again") from None
    if any(len(point) != 3 for point in points):
        raise InputError("path", f"{path.name} has points in the plane", "three coordinates of each point")
    return np.array(points).reshape(-1, 3), {name: np.array(rows, dtype=np.int64) for name, rows in facets.items()}


def _corners(words: list[str], count: int) -> list[int]:
    """Numbers of the corners of a facet among so many points."""
    numbers = [int(word.partition("/")[0]) for word in words]
    found = [n - 1 if n > 0 else count + n for n in numbers]
    if min(found, default=0) < 0 or 0 in numbers:
        raise ValueError("a facet with a corner that is not there")
    return found


def _unreadable(path: Path, line: int, problem: str, remedy: str) -> InputError:
    return InputError("path", f"{path.name} cannot be read: line {line}: {problem}", remedy)
