"""Parts, instances and the assembly of a deck."""

import numpy as np
import pytest
from deck_texts import CUBE, listed, read

from softway.errors import InputError

PARTS = f"*PART, NAME=A\n{CUBE}*NSET, NSET=Low\n1, 2, 3, 4\n*END PART\n*PART, NAME=B\n{CUBE}*END PART\n"
ASSEMBLY = """*ASSEMBLY, NAME=Z
*INSTANCE, NAME=One, PART=a
*END INSTANCE
*INSTANCE, NAME=Two, PART=A
10, 0, 0
*END INSTANCE
*INSTANCE, NAME=Three, PART=B
0, 20, 0
0, 20, 0, 0, 20, 1, 90
*END INSTANCE
*NSET, NSET=Top, INSTANCE=Two
5, 6, 7, 8
*NSET, NSET=Both
One.Low, Two.low
*ELSET, ELSET=Pair
One.1
Three.1
*END ASSEMBLY
"""


def test_each_part_numbers_its_own_nodes(tmp_path):
    mesh = read(tmp_path, PARTS.replace("1, 1,0,0", "1, 1,0,0"))
    assert mesh.blocks["hex8"].tolist() == [list(range(8)), list(range(8, 16))]
    assert mesh.tags["A"].tolist() == list(range(8)) and mesh.tags["B"].tolist() == list(range(8, 16))
    assert mesh.tags["A.Low"].tolist() == [0, 1, 2, 3]
    assert listed(mesh) == {}


def test_instances_stand_at_their_places(tmp_path):
    mesh = read(tmp_path, PARTS + ASSEMBLY)
    assert mesh.blocks["hex8"].shape == (3, 8)
    x = mesh.points
    assert np.array_equal(x[mesh.tags["Two"]], x[mesh.tags["One"]] + [10, 0, 0])
    turned = x[mesh.tags["One"]] @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [0, 20, 0]
    assert np.abs(x[mesh.tags["Three"]] - turned).max() < 1e-12
    assert mesh.tags["Top"].tolist() == mesh.tags["Two"][4:].tolist()
    assert mesh.tags["Both"].tolist() == [*mesh.tags["One.Low"], *mesh.tags["Two.Low"]]
    assert mesh.tags["Pair"].tolist() == [*mesh.tags["One"], *mesh.tags["Three"]]


@pytest.mark.parametrize(
    ("only", "cells"), [("two", 1), ("A", 2), ("b", 1), ("Pair", 2), ("Three", 1)], ids=lambda v: str(v)
)
def test_a_body_takes_some_of_them(tmp_path, only, cells):
    assert len(read(tmp_path, PARTS + ASSEMBLY, only=(only,)).blocks["hex8"]) == cells


def test_a_body_takes_element_sets_of_parts_and_instances(tmp_path):
    text = PARTS.replace("*END PART", "*ELSET, ELSET=E\n1\n*END PART") + ASSEMBLY
    assert len(read(tmp_path, text, only=("one.e", "Three")).blocks["hex8"]) == 2
    assert len(read(tmp_path, text, only=("A.E",)).blocks["hex8"]) == 2
    with pytest.raises(InputError, match="'C' is no instance, part or element set") as caught:
        read(tmp_path, text, only=("C",))
    assert "One" in caught.value.remedy and "Three.E" in caught.value.remedy


def test_a_part_without_an_instance_is_listed(tmp_path):
    text = PARTS + "*ASSEMBLY\n*INSTANCE, NAME=I, PART=B\n*END INSTANCE\n*END ASSEMBLY\n"
    mesh = read(tmp_path, text)
    assert mesh.blocks["hex8"].shape == (1, 8)
    assert listed(mesh) == {"*PART": 1}
    assert "part A has no instance" in str(mesh.left_out[0])


def test_a_single_instance_has_its_sets_without_its_name_too(tmp_path):
    text = PARTS.split("*PART, NAME=B")[0] + "*INSTANCE, NAME=I, PART=A\n*END INSTANCE\n"
    tags = read(tmp_path, text).tags
    assert tags["Low"].tolist() == tags["I.Low"].tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("*PART, NAME=A\n*END PART\n*PART, NAME=a\n*END PART\n", "part a is defined twice"),
        ("*INSTANCE, NAME=I, PART=Q\n*END INSTANCE\n", "part 'Q' is not in the deck"),
        (
            PARTS + "*INSTANCE, NAME=I, PART=A\n*END INSTANCE\n*INSTANCE, NAME=i, PART=B\n",
            "instance i is defined twice",
        ),
        (PARTS + "*INSTANCE, NAME=I, PART=A\n0,0,0\n0,0,0,0,0,0,30\n", "the axis of rotation has no length"),
        (CUBE + "*NODE\n1, 5,5,5\n", "node 1 lies at"),
        (CUBE + "*ELEMENT, TYPE=C3D8\n1, 8,7,6,5,4,3,2,1\n", "element 1 is defined twice"),
        (CUBE + "*ELEMENT, TYPE=C3D8\n2, 1,2,3,4,5,6,7,99\n", "element 2 names node 99"),
        (CUBE + "*ELEMENT, TYPE=C3D8\n2, 1,2,3,4,5,6,7\n", "element 2 has 7 nodes"),
        (CUBE + "*NODE\nx, 1\n", "'?x'? is not a whole number"),
        (CUBE + "*NODE\n9, 1, wide\n", "wide is not a number"),
    ],
)
def test_decks_that_contradict_themselves(tmp_path, text, problem):
    with pytest.raises(InputError, match=problem) as caught:
        read(tmp_path, text)
    assert caught.value.remedy


CAE = f"""*Heading
*Part, name=Plate
{CUBE}*Nset, nset=Set-1, generate
 1, 8, 1
*Elset, elset=Set-1
 1,
*Elset, elset=_Surf-1_S1, internal
 1,
*Surface, type=ELEMENT, name=Surf-1
_Surf-1_S1, S1
*Solid Section, elset=Set-1, material=Steel
,
*End Part
*Part, name=Ball
{CUBE}*End Part
*Assembly, name=Assembly
*Instance, name=Plate-1, part=Plate
*End Instance
*Instance, name=Ball-1, part=Ball
 0., 0., 5.
*End Instance
*Tie, name=Constraint-1, adjust=yes
s_Surf-1, m_Surf-1
*End Assembly
*Material, name=Steel
"""


def test_the_ordinary_export_of_two_parts(tmp_path):
    """Sections and surfaces within a part, materials without, and a tie of surfaces that are not there."""
    mesh = read(tmp_path, CAE)
    assert mesh.points[mesh.tags["Ball-1"]].min(axis=0).tolist() == [0, 0, 5]
    assert mesh.points[mesh.tags["Plate-1"]].max(axis=0).tolist() == [1, 1, 1]
    assert mesh.points[mesh.tags["Plate-1.Surf-1"], 2].tolist() == [0, 0, 0, 0]
    assert listed(mesh) == {"*TIE, NAME=Constraint-1": 1, "*MATERIAL": 1, "*SOLID SECTION": 1}


def test_headers_that_give_nothing_new(tmp_path):
    """A repeated header, a header at the end, and the same lines again."""
    mesh = read(tmp_path, CUBE.replace("*ELEMENT, TYPE=C3D8\n", "*ELEMENT, TYPE=C3D8\n*ELEMENT, TYPE=C3D8\n") + CUBE)
    assert mesh.blocks["hex8"].shape == (1, 8)
    mesh = read(tmp_path, CUBE + "*NODE, NSET=left\n")
    assert mesh.blocks["hex8"].shape == (1, 8)
    assert listed(mesh) == {"*NSET, NSET=left": 1}
