"""Ties of a deck: glued in a body or between bodies; what is not glued is listed by name."""

from pathlib import Path

import pytest
from deck_texts import CUBE, listed, read

import softway as sw
from softway.apps.cli import main
from softway.scenario.built import built_and_left_out

PARTS = f"""*PART, NAME=Plate
{CUBE}*ELSET, ELSET=All
1
*SURFACE, NAME=Up
1, S2
*SURFACE, NAME=Down
1, S1
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=Low, PART=Plate
*END INSTANCE
*INSTANCE, NAME=High, PART=Plate
0, 0, 1
*END INSTANCE
*SURFACE, NAME=Glued
High.All, S1
*END ASSEMBLY
"""
TIE = "*TIE, NAME=Glue, TYPE=SURFACE TO SURFACE\nGlued, Low.Up\n"
HEAD = """
[time]
end = 0.1
step = 0.01
"""
SOLID = """
[bodies.{name}]
kind = "Solid"
mesh = {{ kind = "MeshFile", path = "deck.inp"{more} }}
material = {{ kind = "NeoHookean", E = 10, nu = 0.3 }}
density = 1
velocity = {{ kind = "Affine", gradient = [[0, -0.5, 0], [0.5, 0, 0], [0, 0, 0.2]] }}
"""
ONE = HEAD + SOLID.format(name="stack", more="")
TWO = HEAD + "".join(SOLID.format(name=name.lower(), more=f', only = "{name}"') for name in ("Low", "High"))


def scenario(folder: Path, text: str, deck: str) -> Path:
    """File of a scenario beside its deck."""
    (folder / "deck.inp").write_text(deck)
    (folder / "s.toml").write_text(text)
    return folder / "s.toml"


def test_tags_of_a_tie(tmp_path: Path) -> None:
    mesh = read(tmp_path, PARTS + TIE)
    (tie,) = mesh.ties
    assert tie.title == "*TIE, NAME=Glue" and tie.between == ("Glued", "Low.Up") and listed(mesh) == {}
    assert mesh.tags["Glued"].tolist() == [8, 9, 10, 11] and mesh.tags["Low.Up"].tolist() == [4, 5, 6, 7]


def test_a_tie_in_a_part_is_in_each_instance(tmp_path: Path) -> None:
    mesh = read(tmp_path, PARTS.replace("*END PART", "*TIE\nUp, Down\n*END PART"))
    assert [t.between for t in mesh.ties] == [("Low.Up", "Low.Down"), ("High.Up", "High.Down")]


def test_a_surface_with_the_name_of_a_node_set(tmp_path: Path) -> None:
    mesh = read(tmp_path, PARTS + "*NSET, NSET=Glued, INSTANCE=Low\n1\n" + TIE)
    assert mesh.ties[0].between == ("SURFACE=Glued", "Low.Up")


@pytest.mark.parametrize("text", [ONE, TWO], ids=["one body", "a body of each instance"])
def test_cubes_glued_by_a_deck_move_like_one_body(tmp_path: Path, text: str) -> None:
    whole = CUBE.split("*ELEMENT")[0] + "9, 0,0,2\n10, 1,0,2\n11, 1,1,2\n12, 0,1,2\n"
    whole += "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n2, 5,6,7,8,9,10,11,12\n"
    ends = []
    for name, deck in (("glued", PARTS + TIE), ("whole", whole)):
        (tmp_path / name).mkdir()
        file = scenario(tmp_path / name, text if name == "glued" else ONE, deck)
        run = sw.run(sw.load(file), tmp_path / name / "run")
        ends.append([run.history[c][-1] for c in ("energy_kinetic", "energy_strain")])
        assert run.summary["notes"] == []
    assert ends[0] == pytest.approx(ends[1], rel=1e-9) and ends[0][1] > 1e-3


def test_a_tie_of_the_scenario_takes_its_place(tmp_path: Path) -> None:
    mine = '\n[[ties]]\nbetween = ["low.Low.Up", "high.Glued"]\ntolerance = 0.1\n'
    (tie,) = sw.check(sw.load(scenario(tmp_path, TWO + mine, PARTS + TIE))).model.scene.ties
    assert tie.tolerance == 0.1  # as given


def test_a_gap_is_refused_with_remedies_that_work(tmp_path: Path) -> None:
    apart = PARTS.replace("0, 0, 1\n*END INSTANCE", "0, 0, 1.2\n*END INSTANCE")
    with pytest.raises(sw.InputError, match=r"0.2 edges \(a tie of a mesh file\)") as caught:
        sw.check(sw.load(scenario(tmp_path, TWO, apart + TIE)))
    assert caught.value.where == "ties" and "tolerance = 0.202; a tie of the scenario" in caught.value.remedy
    mine = '\n[[ties]]\nbetween = ["high.Glued", "low.Low.Up"]\ntolerance = 0.202\n'
    sw.check(sw.load(scenario(tmp_path, TWO + mine, apart + TIE)))
    sw.check(sw.load(scenario(tmp_path, TWO, PARTS + TIE)))


@pytest.mark.parametrize(
    ("card", "told", "glued"),
    [
        ("*TIE, NAME=Glue, ADJUST=NO\nGlued, Low.Up\n", "*TIE, NAME=Glue, ADJUST=NO (1; line 29)", 1),
        ("*TIE, NAME=Glue, POSITION TOLERANCE=0.1\nGlued, Low.Up\n", "*TIE, NAME=Glue, POSITION TOLERANCE (1;", 1),
        ("*TIE, NAME=Glue, CYCLIC SYMMETRY\nGlued, Low.Up\n", "CYCLICSYMMETRY is not honoured: nothing is glued", 0),
        ("*TIE, NAME=Glue, TIED NSET=All\nGlued, Low.Up\n", "TIEDNSET is not honoured: nothing is glued", 0),
        ("*TIE, NAME=Glue\nGlued, Nowhere\n", "surface Nowhere has no nodes: nothing is glued", 0),
        ("*TIE\nGlued\n", "*TIE (1; line 29): 'Glued' does not name two surfaces: nothing is glued", 0),
    ],
)
def test_what_is_not_honoured_is_listed(tmp_path: Path, card: str, told: str, glued: int) -> None:
    mesh = read(tmp_path, PARTS + card)
    (entry,) = [entry for entry in mesh.left_out if entry.matters]
    assert told in str(entry) and len(mesh.ties) == glued


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HEAD + SOLID.format(name="low", more=', only = "Low"'), "no body has facets on Glued: nothing is glued"),
        (
            TWO + SOLID.format(name="copy", more=', only = "Low"'),
            "several bodies have its surfaces: nothing is glued",
        ),
    ],
    ids=["no body", "several bodies"],
)
def test_a_tie_without_its_bodies_is_listed(tmp_path: Path, text: str, told: str, capsys) -> None:
    file = scenario(tmp_path, text, PARTS + TIE)
    scene, left_out = built_and_left_out(sw.load(file))
    assert scene.ties == () and [str(card) for cards in left_out.values() for card in cards if told in str(card)]
    assert main(["check", str(file), "--strict"]) == 2
    assert f"*TIE, NAME=Glue (1; line 29): {told}" in " ".join(capsys.readouterr().err.split())
