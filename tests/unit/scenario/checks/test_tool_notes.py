"""Notes on tools and bodies from files: flat facets of curved tools, and units of length."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.meshes.generators.recipes import Ring
from softway.obstacles.triangulated import Facets

RING = Ring(inner=1.001, outer=1.3, cells=(3, 80))
SQUARE = """*NODE
1, 0, 0
2, {size}, 0
3, {size}, {size}
4, 0, {size}
*ELEMENT, TYPE=CPE4
1, 1, 2, 3, 4
"""


def polygon(corners: int, *, smooth: bool = False, radius: float = 1.0, sign: int = 1) -> Facets:
    """Regular polygon."""
    turn, k = 2.0 * pi * np.arange(corners) / corners, np.arange(corners)
    cells = np.stack([k, np.roll(k, -1)][::sign], axis=1)
    return Facets(points=radius * np.stack([np.cos(turn), np.sin(turn)], axis=1), cells=cells, smooth=smooth)


def solid(mesh: object) -> sw.Solid:
    return sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0)  # type: ignore[arg-type]


def notes(shape: object, tag: str = "inner", mesh: object = RING, start: str = "apart") -> tuple[str, ...]:
    """Notes on a ring around a tool, those of the contact alone."""
    bodies = {"ring": solid(mesh), "tool": sw.Tool(shape=shape)}  # type: ignore[arg-type]
    contact = sw.Contact(between=(f"ring.{tag}", "tool"), start=start)  # type: ignore[arg-type]
    found = sw.check(sw.Scenario(bodies=bodies, contacts=(contact,), time=sw.Time(end=1e-3))).notes
    return tuple(str(note) for note in found if note.where.startswith("contacts"))


def test_flat_facets_of_a_round_tool_are_noted_with_their_sagitta() -> None:
    """32 facets stand 1 - cos(pi / 32) = 0.00482 off the circle, and the gap is 1e-3."""
    (note,) = notes(polygon(32))
    assert note.startswith("contacts[0].between: the facets of the tool 'tool' stand up to 0.00")
    off = float(note.partition("stand up to ")[2].split()[0])
    assert off == pytest.approx(1.0 - np.cos(pi / 32), rel=0.1)
    assert "the gap is 0.00" in note and "smooth = true" in note


def test_each_remedy_ends_the_note() -> None:
    assert notes(polygon(32, smooth=True)) == ()
    assert notes(polygon(640)) == ()


def test_a_hollow_tool_is_seen_from_inside() -> None:
    mesh = Ring(inner=0.7, outer=0.999, cells=(3, 80))
    hollow = sw.obstacles.Cavity(of=polygon(32, radius=1.01))
    (note,) = notes(hollow, "outer", mesh)
    assert "the tool 'tool'" in note
    assert notes(sw.obstacles.Cavity(of=polygon(640, radius=1.01)), "outer", mesh) == ()


def test_edges_and_flat_faces_of_a_tool_are_not_curved() -> None:
    box = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3), origin=(-0.5, 1.45))
    assert notes(polygon(4, radius=2.0**0.5), "bottom", box) == ()


def in_folder(folder: Path, unit: str, *, size: float, tool: float = 0.0, scale: float = 1.0) -> tuple[str, ...]:
    """Notes on a body of a file with a size, and on a tool of another file."""
    (folder / "body.inp").write_text(SQUARE.format(size=size))
    bodies: dict[str, sw.Solid | sw.Tool] = {"b": solid(sw.meshes.MeshFile(path=folder / "body.inp", unit=unit))}
    if tool:
        (folder / "tool.msh").write_text(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n"
            f"1 0 -1 0\n2 {tool} -1 0\n$EndNodes\n$Elements\n1\n1 1 2 0 1 2 1\n$EndElements\n"
        )
        bodies["w"] = sw.Tool(shape=sw.obstacles.Surface(file=folder / "tool.msh", scale=scale))
    return tuple(str(note) for note in sw.check(sw.Scenario(bodies=bodies, time=sw.Time(end=0.1))).notes)


def test_a_part_in_millimetres_that_is_read_in_metres_is_noted(tmp_path: Path) -> None:
    (note,) = in_folder(tmp_path, "m", size=80.0)
    assert note.startswith("bodies.b.mesh: its file extends over 80 m, read in units of 1 m, as a part does")
    assert 'try: unit = "mm", if the file is in millimetres' in note
    assert in_folder(tmp_path, "mm", size=80.0) == ()
    assert in_folder(tmp_path, "m", size=0.08) == ()


def test_a_tool_that_is_a_thousand_times_larger_is_noted(tmp_path: Path) -> None:
    (note,) = in_folder(tmp_path, "mm", size=80.0, tool=200.0)
    assert note.startswith(
        "bodies.w.shape: its file extends over 200 m, read in units of 1 m, but the solids over 0.08 m"
    )
    assert 'try: scale = "1 mm", if' in note
    assert in_folder(tmp_path, "mm", size=80.0, tool=200.0, scale=1e-3) == ()


def test_a_tool_that_is_a_thousand_times_smaller_is_noted(tmp_path: Path) -> None:
    (note,) = in_folder(tmp_path, "m", size=1.0, tool=0.5, scale=1e-3)
    assert note.startswith("bodies.w.shape: its file extends over 0.0005 m, read in units of 0.001 m")
    assert "the unit in which the file was written" in note
