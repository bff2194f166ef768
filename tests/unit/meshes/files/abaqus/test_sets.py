"""Sets and surfaces of a deck as tags."""

import pytest
from deck_texts import CUBE, listed, read

from softway.errors import InputError
from softway.meshes.mesh import Mesh

TWO = CUBE + "*NODE\n9,2,0,0\n10,2,1,0\n11,2,0,1\n12,2,1,1\n*ELEMENT,TYPE=C3D8\n2, 2,9,10,3,6,11,12,7\n"


def tag(folder, text, name):
    """Labels of the nodes of a tag."""
    return (read(folder, TWO + text).tags[name] + 1).tolist()


def test_ranges_with_and_without_an_increment(tmp_path):
    assert tag(tmp_path, "*NSET, NSET=A, GENERATE\n1, 4\n7, 11, 2\n", "A") == [1, 2, 3, 4, 7, 9, 11]
    assert tag(tmp_path, "*ELSET, ELSET=E, GENERATE\n2, 2\n", "E") == [2, 3, 6, 7, 9, 10, 11, 12]


def test_a_range_of_more_labels_than_there_are_nodes(tmp_path):
    assert len(tag(tmp_path, "*NSET, NSET=A, GENERATE\n1, 999999999999, 1\n", "A")) == 12


def test_names_in_any_case_and_sets_in_sets(tmp_path):
    text = "*nset, nset=Low\n1, 2\n*NSET,NSET=LOW\n3, 4\n*Nset, nset=Most\nlow, 9\n*NSET, NSET=Nodes, ELSET=right\n"
    mesh = read(tmp_path, TWO + text + '*ELSET, ELSET="Right"\n2\n')
    assert (mesh.tags["Low"] + 1).tolist() == [1, 2, 3, 4]
    assert (mesh.tags["Most"] + 1).tolist() == [1, 2, 3, 4, 9]
    assert mesh.tags["Nodes"].tolist() == mesh.tags["Right"].tolist()
    made = Mesh(points=mesh.points, blocks=mesh.blocks, tags=mesh.tags)
    assert made.nodes("low").tolist() == made.nodes("LOW").tolist() == [0, 1, 2, 3]


def test_sets_that_name_each_other(tmp_path):
    assert tag(tmp_path, "*NSET, NSET=A\nB, 1\n*NSET, NSET=B\nA, 2\n", "A") == [1, 2]


@pytest.mark.parametrize(
    ("face", "nodes"),
    [
        ("S1", [1, 2, 3, 4]),
        ("S2", [5, 6, 7, 8]),
        ("S3", [1, 2, 5, 6]),
        ("s4", [2, 3, 6, 7]),
        ("S5", [3, 4, 7, 8]),
        ("S6", [1, 4, 5, 8]),
    ],
)
def test_faces_of_bricks(tmp_path, face, nodes):
    assert tag(tmp_path, f"*SURFACE, NAME=F\n1, {face}\n", "F") == nodes


def test_faces_of_tetrahedra_and_plane_cells(tmp_path):
    tet = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4,ELSET=E\n1,1,2,3,4\n"
    for face, nodes in (("S1", [0, 1, 2]), ("S2", [0, 1, 3]), ("S3", [1, 2, 3]), ("S4", [0, 2, 3])):
        assert read(tmp_path, tet + f"*SURFACE,NAME=F\nE,{face}\n").tags["F"].tolist() == nodes
    flat = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT,TYPE=CPS4,ELSET=E\n1,1,2,3,4\n*SURFACE,NAME=F\nE,S3\n"
    assert read(tmp_path, flat).tags["F"].tolist() == [2, 3]


def test_free_faces_and_surfaces_of_nodes(tmp_path):
    assert tag(tmp_path, "*ELSET,ELSET=E\n2\n*SURFACE, NAME=F\nE\n", "F") == [2, 3, 6, 7, 9, 10, 11, 12]
    assert tag(tmp_path, "*NSET,NSET=N\n1,2\n*SURFACE, NAME=F, TYPE=NODE\nN\n7, 1.\n", "F") == [1, 2, 7]


def test_sets_of_different_kinds_with_one_name(tmp_path):
    text = "*NSET,NSET=X\n1\n*ELSET,ELSET=x\n2\n*SURFACE,NAME=X\n1,S1\n*ELSET,ELSET=ALL\n1\n"
    tags = read(tmp_path, TWO + text).tags
    assert tags["X"].tolist() == [0]
    assert tags["SURFACE=X"].tolist() == [0, 1, 2, 3]
    assert len(tags["ELSET=x"]) == len(tags["all"]) == 8


def test_entries_that_do_not_exist_are_listed(tmp_path):
    text = (
        "*NSET,NSET=A\n1,99\n*ELSET,ELSET=B\nNone\n*SURFACE,NAME=F\n1,S9\n77,S1\n*SURFACE,NAME=G,COMBINE=UNION\nF,F\n"
    )
    assert listed(read(tmp_path, TWO + text)) == {
        "*NSET, NSET=A": 1,
        "*ELSET, ELSET=B": 1,
        "*SURFACE, NAME=F": 1,
        "*SURFACE, COMBINE": 1,
    }


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("*NSET\n1\n", "no NSET=NAME"),
        ("*NSET, NSET=A, GENERATE\n5, 1\n", "the range from 5 to 1 by 1 is empty"),
        ("*NSET, NSET=A, GENERATE\n1, 5, 0\n", "by 0 is empty"),
        ("*NSET, NSET=A, INSTANCE=I\n1\n", "instance 'I' is not in the deck"),
    ],
)
def test_sets_that_cannot_be_read(tmp_path, text, problem):
    with pytest.raises(InputError, match=problem):
        read(tmp_path, TWO + text)
