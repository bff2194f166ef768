"""Nodes and elements that a deck generates, and its systems of coordinates."""

import numpy as np
import pytest
from deck_texts import CUBE, listed, read

from softway.errors import InputError
from softway.meshes.mesh import Mesh

FOUR = "*NODE\n901,0,0\n902,1,0\n903,1,1\n904,0,1\n*ELEMENT,TYPE=CPE4\n901,901,902,903,904\n"


def places(folder, text):
    """Coordinates of the nodes in their order, of a deck with a cell besides."""
    return read(folder, text + FOUR).points[:-4]


def test_systems_of_coordinates(tmp_path):
    x = places(tmp_path, "*NODE, SYSTEM=C\n1, 2, 90, 3\n*NODE, SYSTEM=s\n2, 2, 0, 30\n*NODE, SYSTEM=R\n3, 1, 2, 3\n")
    assert np.abs(x - [[0, 2, 3], [np.sqrt(3), 0, 1], [1, 2, 3]]).max() < 1e-12


def test_a_system_holds_until_the_next_one(tmp_path):
    moved = "*SYSTEM\n1, 1, 0, 1, 2, 0\n*NODE\n1, 2, 0, 0\n*SYSTEM\n5, 0, 0, 5, 1, 0\n5, 0, 1\n*NODE\n2, 1, 2, 3\n"
    x = places(tmp_path, moved + "*SYSTEM\n*NODE\n3, 7, 8, 9\n*SYSTEM\n1,1,1\n*NODE\n4, 1,1,1\n*SYSTEM\n")
    assert np.abs(x - [[1, 3, 0], [8, 1, 2], [7, 8, 9], [2, 2, 2]]).max() < 1e-12


def test_each_part_has_a_system_of_its_own(tmp_path):
    mesh = read(tmp_path, f"*PART, NAME=A\n*SYSTEM\n5,5,5\n{CUBE}*END PART\n*PART, NAME=B\n{CUBE}*END PART\n")
    assert mesh.points[0].tolist() == [5, 5, 5] and mesh.points[8].tolist() == [0, 0, 0]


def test_a_grid_by_lines_and_rows(tmp_path):
    """The same mesh by hand and by ``*NGEN``, ``*NFILL`` and ``*ELGEN``."""
    text = "*NODE\n1, 0, 0\n4, 3, 0\n21, 0, 2\n24, 3, 2\n*NGEN, NSET=Low\n1, 4\n*NGEN, NSET=High\n21, 24, 1\n"
    text += "*NFILL, NSET=Every\nLow, High, 2, 10\n*ELEMENT, TYPE=CPE4, ELSET=First\n1, 1,2,12,11\n"
    mesh = read(tmp_path, text + "*ELGEN, ELSET=Plate\n1, 3, 1, 1, 2, 10, 10\n")
    assert listed(mesh) == {}
    x, cells = mesh.points, mesh.blocks["quad4"]
    assert cells.shape == (6, 4) and len(np.unique(cells)) == 12
    assert sorted(x[:, :2].tolist()) == [[i, j] for i in range(4) for j in range(3)]
    assert len(mesh.tags["Low"]) == 4 and len(mesh.tags["Every"]) == len(mesh.tags["Plate"]) == 12
    made = Mesh(points=x[:, :2], blocks={"quad4": cells})
    assert len(made.boundary()["bar2"]) == 10


def test_bias_of_a_filled_region(tmp_path):
    text = "*NODE, NSET=A\n1, 0,0\n*NODE, NSET=B\n4, 7,0\n*NFILL, BIAS=.5\nA, B, 3, 1\n"
    assert np.sort(places(tmp_path, text)[:, 0]).tolist() == pytest.approx([0, 1, 3, 7])


def test_arcs_and_parabolas(tmp_path):
    arc = "*NODE, SYSTEM=C\n1, 2, 0\n4, 2, 90\n*NGEN, LINE=C\n1, 4, 1\n"
    x = places(tmp_path, arc)[2:]
    assert np.abs(np.hypot(x[:, 0], x[:, 1]) - 2).max() < 1e-12
    assert np.degrees(np.arctan2(x[:, 1], x[:, 0])).tolist() == pytest.approx([30, 60])
    half = "*NODE\n1, 3, 0\n3, -1, 0\n*NGEN, LINE=C\n1, 3, 1, , 1, 0, 0, 0, 0, -1\n"
    assert places(tmp_path, half)[2].tolist() == pytest.approx([1, -2, 0])
    bent = "*NODE\n1, 0, 0\n5, 4, 0\n9, 2, 1\n*NGEN, LINE=P\n1, 5, 2, 9\n"
    assert places(tmp_path, bent)[3].tolist() == pytest.approx([2, 1, 0])


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ("SHIFT\n1,0,0", [3, 3, 4]),
        ("SHIFT\n1,0,0\n0,0,0,0,0,1,90", [-3, 3, 4]),
        ("REFLECT=POINT\n0,0,0", [-2, -3, -4]),
        ("REFLECT=LINE\n0,0,0, 1,0,0", [2, -3, -4]),
        ("REFLECT=MIRROR\n0,0,0, 0,1,0\n0,0,1", [-2, 3, 4]),
        ("POLE\n, 0,0,4", [4, 6, 4]),
    ],
)
def test_copies_of_nodes(tmp_path, how, expected):
    text = f"*NODE, NSET=Old\n1, 2, 3, 4\n*NCOPY, CHANGE NUMBER=10, OLD SET=Old, NEW SET=New, {how}\n"
    assert places(tmp_path, text)[1].tolist() == pytest.approx(expected)


def test_copies_of_copies(tmp_path):
    text = "*NODE, NSET=Old\n1, 2\n*NCOPY, CHANGE NUMBER=10, OLD SET=Old, SHIFT, MULTIPLE=3\n1,0,0\n"
    assert places(tmp_path, text)[:, 0].tolist() == [2, 3, 4, 5]


def test_a_mirrored_half(tmp_path):
    """Copied elements keep a positive volume."""
    text = CUBE.replace("*NODE", "*NODE, NSET=N").replace("C3D8", "C3D8, ELSET=E")
    text += "*NCOPY, CHANGE NUMBER=10, OLD SET=N, REFLECT=MIRROR\n1,0,0, 1,1,0\n1,0,1\n"
    text += "*ELCOPY, ELEMENT SHIFT=5, OLD SET=E, SHIFT NODES=10, NEW SET=F, REFLECT\n"
    mesh = read(tmp_path, text)
    made = Mesh(points=mesh.points, blocks=mesh.blocks)
    assert made.n_cells == 2 and np.ptp(made.points[:, 0]) == 2
    assert made.points[mesh.tags["F"], 0].min() == 1


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("*NGEN\n1, 2, 3\n", "no steps of 3 lead from node 1 to node 2"),
        ("*NGEN\n1, 77\n", "node 77 is not defined"),
        ("*NGEN, LINE=C\n1, 3\n", "the arc has no normal"),
        ("*NFILL\nNone, None, 2\n", "node set 'None' is not defined"),
        ("*NSET, NSET=A\n1,2\n*NSET, NSET=B\n3\n*NFILL\nA, B, 2\n", "A has 2 nodes, B has 1"),
        ("*NCOPY, CHANGE NUMBER=1, OLD SET=Z, SHIFT\n1\n", "node set 'Z' is not defined"),
        ("*NSET, NSET=A\n1\n*NCOPY, CHANGE NUMBER=1000, OLD SET=A\n1\n", "no SHIFT, REFLECT or POLE"),
        ("*ELGEN\n7, 2\n", "element 7 is not defined"),
        ("*ELGEN\n1, 100000, 1, 1, 100000, 1, 1\n", "100000 x 100000 x 1 elements"),
        ("*NSET, NSET=A\n1\n*NCOPY, CHANGE NUMBER=9, OLD SET=A, SHIFT, MULTIPLE=99999999\n1\n", "MULTIPLE=99999999"),
        ("*SYSTEM\n0,0,0, 1,0,0\n2,0,0\n", "on one line"),
        ("*NODE, SYSTEM=Q\n50, 1\n", "SYSTEM=Q"),
    ],
)
def test_generators_that_cannot_work(tmp_path, text, problem):
    with pytest.raises(InputError, match=problem) as caught:
        read(tmp_path, CUBE + text)
    assert caught.value.remedy and "line" in caught.value.problem


def test_a_generator_that_is_not_honoured_is_named_where_its_nodes_are_missed(tmp_path):
    text = CUBE + "*NSET, NSET=A\n1,2\n*NSET, NSET=B\n3,4\n*NFILL, SINGULAR=1\nA, B, 2, 20\n"
    assert listed(read(tmp_path, text)) == {"*NFILL, SINGULAR": 1}
    with pytest.raises(InputError, match="names node 21") as caught:
        read(tmp_path, text + "*ELEMENT, TYPE=C3D8\n2, 21,22,3,4,5,6,7,8\n")
    assert "*NFILL, SINGULAR, which is not honoured" in caught.value.remedy
