"""List of the cards of a deck that the mesh does not hold: in Python, on the terminal, and in the run folder."""

import json

import pytest
from deck_texts import CUBE, listed, read

from softway.apps.cli import main
from softway.errors import InputError
from softway.meshes.files.mesh_files import read_mesh

LOADED = """*HEADING
A cube of steel
*ELEMENT, TYPE=SPRINGA, ELSET=Springs
11, 1, 5
12, 2, 6
*ELEMENT, TYPE=S4, ELSET=Skin
21, 5,6,7,8
*ELEMENT, TYPE=CPS3, ELSET=Face
31, 1,2,3
*SOLID SECTION, ELSET=Body, MATERIAL=Steel
*BOUNDARY
1, 1, 3
*NODE PRINT
U
*BOUNDARY
2, 3
"""
SCENARIO = """[bodies.a]
kind = "Solid"
mesh = { kind = "MeshFile", path = "deck.inp" }
material = { kind = "NeoHookean", E = 1e6, nu = 0.3 }
density = 1000
place = { bottom = 0.01 }
[bodies.b]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0, 0], normal = [0, 0, 1] }
[[contacts]]
between = ["a", "b"]
timing = "Impulse"
[time]
end = 0.002
step = 0.001
"""


@pytest.fixture
def scenario(tmp_path):
    """Scenario of a cube whose deck has cards that are not honoured."""
    (tmp_path / "deck.inp").write_text(CUBE.replace("C3D8", "C3D8, ELSET=Body") + LOADED)
    (tmp_path / "s.toml").write_text(SCENARIO)
    return tmp_path / "s.toml"


def test_every_card_once_with_its_lines(tmp_path):
    mesh = read(tmp_path, CUBE.replace("C3D8", "C3D8, ELSET=Body") + LOADED)
    told = {card.card: (card.count, card.lines, card.matters) for card in mesh.left_out}
    assert told == {
        "*BOUNDARY": (2, ("22", "26"), True),
        "*ELEMENT, TYPE=SPRINGA": (2, ("14",), True),
        "*ELEMENT, TYPE=S4": (1, ("17",), True),
        "*SOLID SECTION": (1, ("21",), True),
        "*HEADING": (1, ("12",), False),
        "*NODE PRINT": (1, ("24",), False),
        "*ELEMENT, TYPE=CPS3": (1, ("19",), False),
    }
    assert mesh.tags["Skin"].tolist() == [4, 5, 6, 7] and mesh.tags["Face"].tolist() == [0, 1, 2]


def test_check_lists_the_cards(scenario, capsys):
    assert main(["check", str(scenario)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "note bodies.a.mesh: its file has cards that are not honoured" in told
    assert "*BOUNDARY (2; lines 22, 26)" in told and "*ELEMENT, TYPE=SPRINGA (2; line 14)" in told
    assert "without meaning for the mesh: *HEADING, *NODE PRINT, *ELEMENT, TYPE=CPS3" in told


def test_strict_refuses_them(scenario, capsys, tmp_path):
    for command in (["check"], ["run", "--out", str(tmp_path / "out")]):
        assert main([*command, str(scenario), "--strict"]) == 2
        told = capsys.readouterr().err
        assert "bodies.a.mesh: the mesh file has cards that are not honoured" in told and "*BOUNDARY (2" in told
        assert "*HEADING" not in told
    assert not (tmp_path / "out").exists()


def test_strict_admits_a_deck_that_is_read_in_full(scenario, tmp_path):
    (tmp_path / "deck.inp").write_text("*HEADING\nA cube\n" + CUBE + "*NSET, NSET=Low\n1,2,3,4\n*NODE PRINT\nU\n")
    assert main(["check", str(scenario), "--strict"]) == 0


def test_a_run_keeps_the_list(scenario, tmp_path, capsys):
    assert main(["run", str(scenario), "--out", str(tmp_path / "out"), "--quiet"]) == 0
    (kept,) = json.loads((tmp_path / "out" / "summary.json").read_text())["notes"]
    assert kept["where"] == "bodies.a.mesh" and "*BOUNDARY (2; lines 22, 26)" in kept["problem"]
    capsys.readouterr()
    assert main(["show", str(tmp_path / "out")]) == 0
    assert "*BOUNDARY (2; lines 22, 26)" in capsys.readouterr().out


def test_several_materials_are_named_with_a_remedy_that_works(tmp_path):
    text = CUBE.replace("C3D8", "C3D8, ELSET=Plate") + "*ELEMENT, TYPE=C3D8, ELSET=Pad\n2, 1,2,3,4,5,6,7,8\n"
    text += "*SOLID SECTION, ELSET=Plate, MATERIAL=Steel\n*SOLID SECTION, ELSET=Pad, MATERIAL=Rubber\n"
    (card,) = read(tmp_path, text).left_out
    assert card.count == 2
    told = 'Plate of Steel, Pad of Rubber; give a law to each region, material = { "Steel" = ..., "Rubber" = ... }'
    assert told + '; or make one body of each: mesh = { ..., only = "Plate" }' in str(card)
    assert len(read(tmp_path, text, only=("Plate",)).blocks["hex8"]) == 1


def test_one_body_of_a_scenario_for_each_instance(scenario, tmp_path):
    part = f"*PART, NAME=P\n{CUBE}*END PART\n"
    (tmp_path / "deck.inp").write_text(
        part + "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n5,0,0\n*END INSTANCE\n"
    )
    assert read_mesh(tmp_path / "deck.inp").n_cells == 2
    scenario.write_text(SCENARIO.replace('"deck.inp"', '"deck.inp", only = "J"'))
    assert main(["check", str(scenario)]) == 0
    scenario.write_text(SCENARIO.replace('"deck.inp"', '"deck.inp", only = ["I", "K"]'))
    assert main(["check", str(scenario)]) == 2


def test_axial_symmetry_is_listed(tmp_path):
    text = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT, TYPE=CAX3\n1, 1,2,3\n"
    assert listed(read(tmp_path, text)) == {"*ELEMENT, TYPE=CAX3": 1}


@pytest.mark.parametrize("kind", ["SPRINGA", "MASS", "D", "B31", "S4R", "F3D8", "CONN3D2"])
def test_a_deck_without_cells_of_a_body_is_refused(tmp_path, kind):
    nodes = CUBE.split("*ELEMENT")[0]
    with pytest.raises(InputError, match=rf"deck.inp has no cells of a body: {kind} \(1\)"):
        read(tmp_path, f"{nodes}*ELEMENT, TYPE={kind}\n1, 1,2,3,4\n")


@pytest.mark.parametrize(("kind", "nodes"), [("C3D6", 6), ("C3D15", 15)])
def test_solid_cells_without_a_counterpart_are_refused(tmp_path, kind, nodes):
    row = ",".join(str(1 + k % 8) for k in range(nodes))
    with pytest.raises(InputError, match=rf"elements of type {kind} \(1\) are not supported"):
        read(tmp_path, f"{CUBE}*ELEMENT, TYPE={kind}\n2, {row}\n")
