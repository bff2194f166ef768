"""Bad contacts from the command line: exit code 2, the path, what is wrong, a remedy, and no folder left behind."""

from pathlib import Path

import numpy as np
import pytest

from softway.apps.cli import main

BLOCKS = """
[bodies.block]
kind = "Solid"
mesh = { kind = "Box", size = ["2 cm", "2 cm", "2 cm"], cells = [3, 3, 3] }
material = { kind = "NeoHookean", E = "210 GPa", nu = 0.3 }
density = "7850 kg/m^3"
velocity = [0, 0, "-1 m/s"]
place = { bottom = "0.1 mm" }
[bodies.other]
kind = "Solid"
mesh = { kind = "Box", size = ["2 cm", "2 cm", "2 cm"], cells = [4, 4, 4] }
material = { kind = "NeoHookean", E = "210 GPa", nu = 0.3 }
density = "7850 kg/m^3"
place = { bottom = "5 cm" }
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0, 0], normal = [0, 0, 1] }
[[contacts]]
name = "floor"
between = ["block.bottom", "floor"]
[time]
end = "10 us"
"""
SHAPE, PAIR = "bodies.floor.shape", "contacts[0].between"
# What is changed, "&" between several; then what the message must contain: the path, what is wrong, the remedy.
CASES = {
    "inside-out surface": (f"{SHAPE}={{kind='Surface', file='inside_out.stl'}}", f"{SHAPE}.file", "inside out", "turn"),
    "some facets turned": (f"{SHAPE}={{kind='Surface', file='mixed.stl'}}", f"{SHAPE}.file", "opposite sides", "turn"),
    "degenerate facets": (f"{SHAPE}={{kind='Surface', file='thin.stl'}}", f"{SHAPE}.file", "1 of 13", "mesh"),
    "only degenerate ones": (f"{SHAPE}={{kind='Surface', file='line.stl'}}", f"{SHAPE}.file", "no area", "mesh"),
    "wall of no thickness": (f"{SHAPE}={{kind='Surface', file='wall.stl'}}", f"{SHAPE}.file", "no thickness", "wall"),
    "inside-out body": (
        "bodies.block.mesh={kind='MeshFile', path='turned.msh'}",
        "bodies.block.mesh",
        "cell",
        "volume",
    ),
    "flat body": ("bodies.block.mesh={kind='MeshFile', path='flat.msh'}", "bodies.block.mesh", "cell", "volume"),
    "tool of another dimension": (f"{SHAPE}={{kind='HalfSpace', point=[0, 0], normal=[0, 1]}}", SHAPE, "2D", "3 coord"),
    "body of another dimension": (
        "bodies.other.mesh={kind='Rectangle', size=['2 cm', '2 cm'], cells=[4, 4]}"
        " & bodies.other.place={translation=[0, '5 cm']}",
        "bodies.other.mesh",
        "2D",
        "same space",
    ),
    "motion of another dimension": (
        "bodies.floor.motion={kind='Translation', velocity=[0, 1]}",
        "bodies.floor.motion",
        "2D",
        "3 components",
    ),
    "one name": (f"{PAIR}=['block.bottom']", PAIR, "has one name", "two names or more"),
    "the same pair twice": (
        "contacts=[{name='a', between=['block', 'other']}, {name='b', between=['other', 'block']}]",
        "contacts[1].between",
        "also the surfaces of contacts[0]",
        "single contact",
    ),
    "tool first": (f"{PAIR}=['floor', 'block']", PAIR, "'floor' is a Tool", '["block", "floor"]'),
    "tag of a tool": (f"{PAIR}=['block', 'floor.top']", PAIR, "'floor.top'", '["block", "floor"]'),
    "overlap": (
        f"{PAIR}=['block', 'other'] & bodies.other.place.bottom=19 mm",
        PAIR,
        "'block' starts 0.0011 m inside 'other'",
        'start = "fit"',
    ),
    "no inertia left": (
        f"{PAIR}=['block', 'floor'] & bodies.block.mesh.cells=[2, 2, 2]",
        "bodies.block.mesh",
        "only 1 nodes are not in a contact tag",
        "finer mesh",
    ),
    "no nodes left": (
        f"{PAIR}=['block', 'floor'] & bodies.block.mesh.cells=[1, 1, 1] & bodies.block.mesh.cell=hex20",
        "bodies.block",
        "one element thick there",
        "two layers of elements or quadratic elements",
    ),
    "unknown method": (f"{'contacts[0].method'}=DualMorter", "contacts[0].method", "DualMorter", "DualMortar"),
    "unknown start": ("contacts[0].start=fitted", "contacts[0].start", "fitted", "'fit'"),
    "negative limit": ("time.control={approach=-1}", "time.control.approach", "-1", "positive"),
}


def facets(file: Path, triangles: np.ndarray) -> None:
    """Write triangles (f, 3, 3) as STL."""
    corners = ["\n".join("vertex {} {} {}".format(*p) for p in t) for t in triangles.tolist()]
    loops = [f"facet normal 0 0 0\nouter loop\n{c}\nendloop\nendfacet" for c in corners]
    file.write_text("\n".join(["solid s", *loops, "endsolid s", ""]))


def tetrahedron(file: Path, points: list[str], cell: str) -> None:
    """Write one cell in Gmsh's format."""
    nodes = "\n".join(f"{k + 1} {p}" for k, p in enumerate(points))
    text = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{nodes}\n$EndNodes\n$Elements\n1\n1 4 2 1 1 {cell}\n"
    file.write_text(f"{text}$EndElements\n")


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    corners = np.array([[x, y, z] for z in (-0.02, 0.0) for y in (-0.05, 0.05) for x in (-0.05, 0.05)])
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    box = corners[np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])]
    line = np.array([[[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.02, 0.0, 0.0]]])
    mixed = box.copy()
    mixed[3] = mixed[3, ::-1]
    for name, found in {
        "inside_out": box[:, ::-1],
        "mixed": mixed,
        "thin": np.concatenate([box, line]),
        "line": line,
        "wall": np.concatenate([box[1:2], box[1:2, ::-1]]),
    }.items():
        facets(tmp_path / f"{name}.stl", found)
    tetrahedron(tmp_path / "turned.msh", ["0 0 0", "1 0 0", "0 1 0", "0 0 1"], "1 3 2 4")
    tetrahedron(tmp_path / "flat.msh", ["0 0 0", "1 0 0", "0 1 0", "1 1 0"], "1 2 3 4")
    file = tmp_path / "blocks.toml"
    file.write_text(BLOCKS)
    return file


@pytest.mark.parametrize("case", CASES)
def test_a_bad_contact_is_refused(case, scenario, refused):
    refused(scenario, *CASES[case])


def test_the_scenario_itself_is_right(scenario):
    assert main(["check", str(scenario), "--quiet"]) == 0
