"""Surfaces of tools mutated by meaning: STL, OBJ, PLY and VTU files, of which every facet is read or none."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from inputs.command import traced
from softway.errors import InputError
from softway.obstacles.triangulated import Surface

Rng = np.random.Generator
QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
NAMES = ("", "x" * 3000, "a b", "facet normal", "ä", "endsolid", "solid solid")


@dataclass(slots=True)
class Facets:
    """A surface by its points and polygons, and how its file is written.

    Parameters
    ----------
    points, faces
        Corners and polygons.
    name
        Name of the surface.
    more
        Lines to add at the end of the file, and before the polygons.
    wrong
        True if the file is to be refused.
    change
        Text to replace in the file, and its replacement.
    """

    points: list[tuple[float, float, float]]
    faces: list[tuple[int, ...]]
    name: str = "part"
    more: list[str] = field(default_factory=list)
    wrong: bool = False
    change: list[tuple[str, str]] = field(default_factory=list)
    style: int = 0

    @property
    def area(self) -> float:
        """Sum of the areas of the polygons."""
        total = 0.0
        for face in self.faces:
            x = np.array([self.points[n] for n in face])
            total += float(np.linalg.norm(np.cross(x[1:-1] - x[0], x[2:] - x[0]).sum(axis=0)) / 2)
        return total


def judged_surface(number: int) -> str:
    """Verdict on a mutated file of a surface: ``ok``, ``refused``, or a defect in words."""
    ending, data, made = surface(number)
    with tempfile.TemporaryDirectory() as place:
        file = Path(place, f"a.{ending}")
        file.write_bytes(data)
        try:
            facets = Surface(file=file).facets
        except InputError as error:
            return "refused" if error.remedy and error.where else f"no remedy: {error}"
        except Exception as error:
            return traced(error)
    if made.wrong:
        return f"lost: a wrong part of a file .{ending}"
    x = facets.points[facets.cells]
    area = float(np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1).sum() / 2)
    return "ok" if np.isclose(area, made.area, rtol=1e-5) else f"lost: area {area:g} of {made.area:g} in .{ending}"


def surface(number: int) -> tuple[str, bytes, Facets]:
    """Ending and bytes of the file of a number, and what it holds."""
    rng = np.random.default_rng([19, number])
    made = _box(rng)
    ending = str(rng.choice(list(WRITERS)))
    for _ in range(int(rng.integers(1, 4))):
        both = (*MUTATIONS, *OWN[ending])
        both[rng.integers(len(both))](made, rng)
    if rng.random() < 0.2:
        _wrong_corner(made, rng)
    made.style = int(rng.integers(4))
    text = WRITERS[ending](made)
    for old, new in made.change:
        text = text.replace(old.encode(), new.encode(), 1)
    return ending, text, made


def _box(rng: Rng) -> Facets:
    """A box of triangles, or of quadrangles."""
    points = [(float(k & 1), float(k >> 1 & 1), float(k >> 2)) for k in range(8)]
    faces: list[tuple[int, ...]] = list(QUADS)
    if rng.random() < 0.6:
        faces = [piece for a, b, c, d in QUADS for piece in ((a, b, c), (a, c, d))]
    return Facets(points, faces)


def _second(made: Facets, rng: Rng) -> None:
    """The same surface at another place."""
    count = len(made.points)
    made.points += [(x + 5.0, y, z) for x, y, z in made.points]
    made.faces += [tuple(n + count for n in face) for face in made.faces]


def _named(made: Facets, rng: Rng) -> None:
    made.name = str(rng.choice(NAMES))


def _mixed(made: Facets, rng: Rng) -> None:
    """A polygon of another number of corners."""
    start = len(made.points)
    count = int(rng.choice([3, 4, 5, 6]))
    angle = 2 * np.pi * np.arange(count) / count
    made.points += [(float(np.cos(a)), float(np.sin(a)), 9.0) for a in angle]
    made.faces.insert(int(rng.integers(len(made.faces) + 1)), tuple(range(start, start + count)))


def _unused(made: Facets, rng: Rng) -> None:
    """A point of no polygon."""
    made.points.append((3.0, 3.0, 3.0))


def _wrong_corner(made: Facets, rng: Rng) -> None:
    """A polygon with a corner that is not there: to be refused."""
    made.faces[0] = (*made.faces[0][:-1], len(made.points) + int(rng.choice([0, 5, 10**6])))
    made.wrong = True


def _stl(made: Facets) -> bytes:
    """Triangles as text, or as bytes."""
    beyond = max(n for face in made.faces for n in face)
    places = {n: made.points[n] for n in range(len(made.points))} | ({beyond: (np.nan,) * 3} if made.wrong else {})
    pieces = [(f[0], f[k], f[k + 1]) for f in made.faces for k in range(1, len(f) - 1)]
    if made.style >= 2:
        out = made.name.encode()[:80].ljust(80, b" ") + np.uint32(len(pieces)).tobytes()
        for piece in pieces:
            rows = [(0.0, 0.0, 0.0), *(places[n] for n in piece)]
            out += np.array(rows, dtype="<f4").tobytes() + b"\0\0"
        return out + "".join(made.more).encode()
    lines = [f"solid {made.name}"]
    for piece in pieces:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [f"  vertex {x} {y} {z}" for x, y, z in (places[n] for n in piece)]
        lines += [" endloop", "endfacet"]
    text = "\n".join([*lines, f"endsolid {made.name}", *made.more]) + "\n"
    return (text.upper() if made.style == 1 and made.name.isascii() else text).encode()


def _obj(made: Facets) -> bytes:
    """Points and polygons, whose corners may count from the end."""
    lines = [f"o {made.name}" if made.name else "# nothing", *(f"v {x} {y} {z}" for x, y, z in made.points)]
    for face in made.faces:
        match made.style:
            case 1:
                lines.append("f " + " ".join(str(n - len(made.points)) for n in face))
            case 2:
                lines.append("f " + " ".join(f"{n + 1}//1" for n in face))
            case 3:
                lines.append(
                    "f " + " ".join(str(n + 1) for n in face[:2]) + " \\\n  " + " ".join(str(n + 1) for n in face[2:])
                )
            case _:
                lines.append("f " + " ".join(str(n + 1) for n in face))
    if made.style == 2:
        lines.insert(1, "vn 0 0 1")
    return "\n".join([*lines, *made.more]).encode() + b"\n"


def _ply(made: Facets) -> bytes:
    """Points with their coordinates in any order, and polygons, as text or as bytes."""
    order = "zxy" if made.style == 1 else "xyz"
    kind = ("ascii", "ascii", "binary_little_endian", "binary_big_endian")[made.style]
    head = [f"ply\nformat {kind} 1.0", f"comment {made.name[:50]}", f"element vertex {len(made.points)}"]
    head += [f"property float {axis}" for axis in order]
    head += [f"element face {len(made.faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [tuple(p["xyz".index(axis)] for axis in order) for p in made.points]
    data = "\n".join(head).encode() + b"\n"
    if made.style < 2:
        lines = [" ".join(map(str, row)) for row in rows]
        lines += [" ".join(map(str, (len(face), *face))) for face in made.faces]
        return data + "\n".join([*lines, *made.more]).encode() + b"\n"
    sign = "<" if made.style == 2 else ">"
    data += np.array(rows, dtype=f"{sign}f4").tobytes()
    return data + b"".join(bytes([len(f)]) + np.array(f, dtype=f"{sign}i4").tobytes() for f in made.faces)


def _vtu(made: Facets) -> bytes:
    """One piece, or two."""
    pieces = [made.faces]
    if made.style == 1 and len(made.faces) > 1:
        pieces = [made.faces[:1], made.faces[1:]]
    text = '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n'
    text += "<UnstructuredGrid>\n"
    for faces in pieces:
        ends = np.cumsum([len(face) for face in faces])
        kinds = [{3: 5, 4: 9}.get(len(face), 7) for face in faces]
        text += f'<Piece NumberOfPoints="{len(made.points)}" NumberOfCells="{len(faces)}">\n<Points>\n'
        text += _array("Float64", "Points", [v for p in made.points for v in p], ' NumberOfComponents="3"')
        text += "</Points>\n<Cells>\n" + _array("Int64", "connectivity", [n for face in faces for n in face])
        text += _array("Int64", "offsets", list(ends)) + _array("UInt8", "types", kinds) + "</Cells>\n</Piece>\n"
    return (text + "</UnstructuredGrid>\n</VTKFile>\n" + "".join(made.more)).encode()


def _array(kind: str, name: str, values: list[float], more: str = "") -> str:
    row = " ".join(map(str, values))
    return f'<DataArray type="{kind}" Name="{name}"{more} format="ascii">\n{row}\n</DataArray>\n'


def _added(*lines: str) -> Callable[[Facets, Rng], None]:
    """Mutation that adds lines without a facet."""

    def add(made: Facets, rng: Rng) -> None:
        made.more.append(str(rng.choice(lines)))

    return add


WRITERS: dict[str, Callable[[Facets], bytes]] = {"stl": _stl, "obj": _obj, "ply": _ply, "vtu": _vtu}
MUTATIONS = (_second, _named, _mixed, _mixed, _unused)
OWN: dict[str, tuple[Callable[[Facets, Rng], None], ...]] = {
    "stl": (_named,),
    "obj": (_added("g a b", "usemtl x", "s 1", "l 1 2", "p 1", "mtllib x.mtl", "# end", "vt 0 0", "xyzzy 1"),),
    "ply": (),
    "vtu": (),
}
