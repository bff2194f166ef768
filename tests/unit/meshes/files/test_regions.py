"""Regions of mesh files: element sets, materials of sections, physical groups."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.meshes.files.mesh_files import read_file, read_mesh

NODES = "*NODE\n1,0,0\n2,1,0\n3,2,0\n4,3,0\n5,0,1\n6,1,1\n7,2,1\n8,3,1\n"
CELLS = (
    "*ELEMENT, TYPE=CPE4, ELSET=Left\n1, 1,2,6,5\n*ELEMENT, TYPE=CPE4, ELSET=Middle\n2, 2,3,7,6\n"
    "*ELEMENT, TYPE=CPE4, ELSET=Right\n3, 3,4,8,7\n"
)
SECTIONS = (
    "*SOLID SECTION, ELSET=Left, MATERIAL=Steel\n*SOLID SECTION, ELSET=Middle, MATERIAL=Rubber\n"
    "*SOLID SECTION, ELSET=Right, MATERIAL=STEEL\n"
)


def deck(tmp_path: Path, text: str) -> Path:
    (tmp_path / "a.inp").write_text(text)
    return tmp_path / "a.inp"


def test_a_deck_with_several_sections_is_one_body_with_several_materials(tmp_path: Path) -> None:
    read = read_file(deck(tmp_path, NODES + CELLS + SECTIONS))
    found = {name: cells.tolist() for name, cells in read.mesh.regions.items()}
    assert found == {"Left": [0], "Middle": [1], "Right": [2], "Steel": [0, 2], "Rubber": [1]}
    assert 'material = { "Steel" = ..., "Rubber" = ... }' in "".join(str(card) for card in read.left_out)
    laws = {"Steel": sw.LinearElastic(E=210e9, nu=0.3), "Rubber": sw.NeoHookean(E=1e6, nu=0.4)}
    solid = sw.Solid(mesh=read.mesh, material=laws, density={"Steel": 7850.0, "Rubber": 1000.0})
    model = sw.build(sw.Scene(bodies={"a": solid}))
    assert float(model.mass.sum()) == pytest.approx(2 * 7850.0 + 1000.0)
    assert [term.region for term in model.parts[0].internal.terms] == ["Steel", "Rubber"]


def test_regions_of_instances(tmp_path: Path) -> None:
    part = f"*PART, NAME=P\n{NODES}{CELLS}{SECTIONS}*END PART\n*ASSEMBLY, NAME=A\n"
    one = part + "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n"
    both = one + "*INSTANCE, NAME=J, PART=P\n0,5\n*END INSTANCE\n"
    found = read_mesh(deck(tmp_path, one + "*END ASSEMBLY\n")).regions
    assert found["Middle"].tolist() == found["I.Middle"].tolist() == [1] and found["I"].tolist() == [0, 1, 2]
    found = read_mesh(deck(tmp_path, both + "*END ASSEMBLY\n")).regions
    assert "Middle" not in found and found["J.Middle"].tolist() == [4] and found["Steel"].tolist() == [0, 2, 3, 5]
    kept = read_mesh(deck(tmp_path, both + "*END ASSEMBLY\n"), only=("J",)).regions
    assert kept["Steel"].tolist() == [0, 2] and "I" not in kept


def test_a_material_with_the_name_of_another_set_keeps_both(tmp_path: Path) -> None:
    sections = SECTIONS.replace("MATERIAL=Rubber", "MATERIAL=Left")
    found = read_mesh(deck(tmp_path, NODES + CELLS + sections)).regions
    assert found["Left"].tolist() == [0] and found["MATERIAL=Left"].tolist() == [1]


def test_a_mesh_of_two_kinds_of_cells_numbers_them_by_blocks(tmp_path: Path) -> None:
    cells = "*ELEMENT, TYPE=CPE3, ELSET=Tri\n4, 1,2,6\n*ELEMENT, TYPE=CPE4, ELSET=Quad\n2, 2,3,7,6\n"
    cells += "*ELEMENT, TYPE=CPE3, ELSET=Tri\n5, 1,6,5\n*ELEMENT, TYPE=CPE4, ELSET=End\n3, 3,4,8,7\n"
    mesh = read_mesh(deck(tmp_path, NODES + cells))
    assert list(mesh.blocks) == ["tri3", "quad4"]
    assert {name: c.tolist() for name, c in mesh.regions.items()} == {"Tri": [0, 1], "Quad": [2], "End": [3]}
    centres = mesh.centres()
    assert np.allclose(centres[mesh.cells("End")], [[2.5, 0.5]])


def test_physical_groups_are_regions(tmp_path: Path) -> None:
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    text += '$PhysicalNames\n3\n2 1 "core"\n2 2 "skin"\n1 3 "foot"\n$EndPhysicalNames\n'
    text += "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n$EndNodes\n"
    text += "$Elements\n4\n1 2 2 2 1 1 2 3\n2 3 2 1 1 2 5 6 3\n3 2 2 2 1 1 3 4\n4 1 2 3 1 1 2\n$EndElements\n"
    (tmp_path / "a.msh").write_text(text)
    mesh = read_mesh(tmp_path / "a.msh")
    assert {name: c.tolist() for name, c in mesh.regions.items()} == {"skin": [0, 1], "core": [2]}
    with pytest.raises(InputError, match="no region 'foot'"):
        mesh.cells("foot")
    divided = sw.meshes.Divided(
        mesh=sw.meshes.MeshFile(path=tmp_path / "a.msh"), regions={"weld": sw.meshes.InBox(low=(0.5, 0.0), high=(1.0,))}
    ).build()
    assert {name: c.tolist() for name, c in divided.regions.items()} == {"skin": [1], "core": [2], "weld": [0]}
