"""Text of a deck: keyword lines, included files and their bounds."""

import pytest
from deck_texts import CUBE, listed, read

from softway.errors import InputError
from softway.meshes.files.abaqus import lexer


def test_keyword_lines_of_many_forms(tmp_path):
    text = CUBE.replace("*NODE", "** a comment\n  * node ,\n nset = 'My nodes' ")
    text = text.replace("*ELEMENT, TYPE=C3D8", "*Element,type=c3d8 ,\n\n** another\nELSET=Body")
    text = text.replace("0,0,1", "0.D0,,1e0")
    mesh = read(tmp_path, text)
    assert mesh.tags["My nodes"].tolist() == mesh.tags["Body"].tolist() == list(range(8))
    assert mesh.points[4].tolist() == [0, 0, 1]


def test_cells_over_several_lines(tmp_path):
    mesh = read(tmp_path, CUBE.replace("1, 1,2,3,4,5,6,7,8", "1, 1,2,3,\n4,5,6,\n7,8\n2, 1,2,3,4,5,\n6,7,8"))
    assert mesh.blocks["hex8"].tolist() == [list(range(8))] * 2


def test_included_files(tmp_path):
    nodes, elements = CUBE.split("*ELEMENT")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "nodes.inp").write_text(nodes.removeprefix("*NODE\n"))
    (tmp_path / "sub" / "cells.inp").write_text("*ELEMENT" + elements + "*INCLUDE, INPUT=sets.inp\n*BOUNDARY\n1,1\n")
    (tmp_path / "sub" / "sets.inp").write_text("*NSET, NSET=A\n1,\n")
    mesh = read(tmp_path, '*NODE, INPUT="sub/nodes.inp"\n*INCLUDE, INPUT=sub/cells.inp\n')
    assert mesh.blocks["hex8"].shape == (1, 8) and mesh.tags["A"].tolist() == [0]
    assert mesh.left_out[0].lines == ("cells.inp:4",)


def test_a_tree_of_includes_ends(tmp_path):
    for k in range(7):
        (tmp_path / f"b{k}.inp").write_text(f"*INCLUDE, INPUT=b{k + 1}.inp\n" * 20)
    (tmp_path / "b7.inp").write_text("** nothing\n")
    with pytest.raises(InputError, match=f"deck.inp > b0.inp > .* > b7.inp: more than {lexer.FILES} files"):
        read(tmp_path, "*INCLUDE, INPUT=b0.inp\n")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("*INCLUDE, INPUT=deck.inp\n", "deck.inp > deck.inp: the file includes itself"),
        ("*INCLUDE, INPUT=none.inp\n", "deck.inp > none.inp: no such file"),
        ("*INCLUDE\n", "no INPUT=FILE"),
        ("*INCLUDE, INPUT=" + "x" * 5000, "no such file"),
        ("*INCLUDE, INPUT=/dev/zero", "no such file"),
        ("", "deck.inp has no cells of a body"),
        ("*ELEMENT\n1, 1\n", "no TYPE"),
        ("*NODE\n*, 1\n", "line 2: \\*, 1 has no keyword"),
    ],
)
def test_files_that_cannot_be_read(tmp_path, text, problem):
    with pytest.raises(InputError, match=problem):
        read(tmp_path, text)


def test_depth_and_lines_are_bounded(tmp_path, monkeypatch):
    for k in range(12):
        (tmp_path / f"c{k}.inp").write_text(f"*INCLUDE, INPUT=c{k + 1}.inp\n")
    with pytest.raises(InputError, match="more than 8 levels of included files"):
        read(tmp_path, "*INCLUDE, INPUT=c0.inp\n")
    monkeypatch.setattr(lexer, "LINES", 10)
    with pytest.raises(InputError, match="more than 10 lines"):
        read(tmp_path, CUBE)


def test_a_keyword_that_nobody_knows_is_listed(tmp_path):
    assert listed(read(tmp_path, CUBE + "*FLY ME, TO=THE MOON\n1\n")) == {"*FLY ME": 1}
