"""Gmsh files: everything they hold is in the mesh or in the list, and files that contradict themselves are refused."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from softway.errors import InputError
from softway.meshes.files.mesh_files import read_file, read_mesh

NODES = "$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 1 1 0\n40 0 1 0\n7 9 9 0\n$EndNodes\n"
CELLS = "$Elements\n3\n1 2 2 1 1 10 20 30\n2 2 2 1 1 10 30 40\n3 1 2 2 1 10 20\n$EndElements\n"
NAMES = '$PhysicalNames\n2\n2 1 "part"\n1 2 "foot"\n$EndPhysicalNames\n'
HEAD = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"


def written(tmp_path: Path, text: str) -> Path:
    (tmp_path / "a.msh").write_text(text)
    return tmp_path / "a.msh"


def test_what_the_mesh_does_not_hold_is_listed(tmp_path: Path) -> None:
    more = "$NodeData\nanything\n$EndNodeData\n$Comments\nme\n$EndComments\n"
    names = NAMES.replace("\n2\n", "\n3\n", 1).replace('"foot"\n', '"foot"\n2 9 "ghost"\n')
    lone = CELLS.replace("\n3\n", "\n5\n", 1).replace("10 20\n$", "10 20\n4 15 2 3 1 7\n5 1 2 0 1 20 30\n$")
    read = read_file(written(tmp_path, HEAD + names + NODES + lone + more))
    assert {name: len(nodes) for name, nodes in read.mesh.tags.items()} == {"part": 4, "foot": 2}
    assert [str(entry) for entry in read.left_out] == [
        "$NodeData (1)",
        "$Comments (1)",
        "$PhysicalNames (1): groups without elements: ghost",
        "$Nodes (1): nodes that belong to no cell",
        "group 3 (1): of 1 nodes belong to no cell",
        "$Elements (1): elements of lower dimension in no physical group",
    ]
    assert [entry.matters for entry in read.left_out] == [True, False, True, False, True, False]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("10 30 40", "10 30 41", "the element 2 names the node 41, which is not there"),
        ("10 30 40", "10 30 0", "the element 2 names the node 0, which is not there"),
        ("10 30 40", "10 30", "the element 2 has 2 nodes; a triangle has 3"),
        ("7 9 9 0", "10 9 9 0", "the node 10 occurs twice"),
        ("7 9 9 0", "7 9 9 x", "could not convert"),
        ("$Nodes\n5", "$Nodes\n4", "4 numbers more than it announces"),
        ("$Nodes\n5", "$Nodes\n6", "announces 24 numbers where 20 are left"),
        ("$Elements\n3", "$Elements\n2", "announces 2 elements and holds 3"),
        ("$Elements\n3", "$Elements\nx", "begins with 'x'"),
        ("$EndElements\n", "$EndElements\n$Elements\n0\n$EndElements\n", r"\$Elements occurs twice"),
        ("$EndElements\n", "", r"\$Elements has no \$EndElements"),
        ('1 2 "foot"', '2 1 "foot"', "has two names"),
        ("\n2\n2 1", "\n3\n2 1", "announces '3' and holds 2 names"),
        ("2.2 0 8", "3.0 0 8", "version 3.0 of the format is not supported"),
        ("2.2 0 8", "2.2 7 8", "is not version, kind of file and size of numbers"),
        ("$Nodes", "Nodes", "stands between two sections"),
    ],
)
def test_files_that_contradict_themselves_are_refused(tmp_path: Path, old: str, new: str, told: str) -> None:
    text = HEAD + NAMES + NODES + CELLS
    assert old in text
    with pytest.raises(InputError, match=f"a.msh cannot be read: .*{told}") as caught:
        read_mesh(written(tmp_path, text.replace(old, new, 1)))
    assert caught.value.remedy


def test_elements_keep_their_groups_where_others_have_none(tmp_path: Path) -> None:
    """A cell without tags once moved the groups of all later ones to the cells before."""
    text = CELLS.replace("1 2 2 1 1 10 20 30", "1 2 0 10 20 30")
    mesh = read_mesh(written(tmp_path, HEAD + NAMES + NODES + text))
    assert mesh.points[mesh.nodes("part")].tolist() == [[0, 0], [1, 1], [0, 1]]


def test_one_name_of_groups_of_several_dimensions(tmp_path: Path) -> None:
    mesh = read_mesh(written(tmp_path, HEAD + NAMES.replace("foot", "part") + NODES + CELLS))
    assert {name: len(nodes) for name, nodes in mesh.tags.items()} == {"part": 2, "SURFACE=part": 4}


FOUR = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "part"
2 5 "also"
$EndPhysicalNames
$Entities
0 1 1 0
4 0 0 0 1 1 0 0 0
1 0 0 0 1 1 0 2 1 5 0
$EndEntities
$Nodes
1 3 4 900000000000
2 1 1 3
4
900000000000
6
0 0 0 0 0
1 0 0 0 0
0 1 0 0 0
$EndNodes
$Elements
1 1 1 1
2 1 2 1
1 4 900000000000 6
$EndElements
"""


def test_an_entity_in_several_groups_has_all_their_tags(tmp_path: Path) -> None:
    """Labels may be huge, nodes parametric, and further entities without a group."""
    mesh = read_mesh(written(tmp_path, FOUR))
    assert mesh.blocks["tri3"].tolist() == [[0, 1, 2]]
    assert mesh.nodes("part").tolist() == mesh.nodes("also").tolist() == [0, 1, 2]


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("version", ["gmsh22", "gmsh"])
def test_what_another_program_writes_as_text_and_as_bytes(tmp_path: Path, version: str, binary: bool) -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    raw = meshio.Mesh(points, [("hexahedron", np.arange(8)[None])])
    meshio.write(tmp_path / "a.msh", raw, file_format=version, binary=binary)
    mesh = read_mesh(tmp_path / "a.msh")
    assert mesh.blocks["hex8"].tolist() == [list(range(8))]
    assert np.array_equal(mesh.points, points)
