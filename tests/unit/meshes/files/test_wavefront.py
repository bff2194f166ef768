"""OBJ files of tools, and VTK files of several pieces."""

from pathlib import Path

import pytest

from softway.errors import InputError
from softway.meshes.files.mesh_files import read_facets

POINTS = "v 0 0 0\nv 1 0 0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 1\n"


@pytest.mark.parametrize(
    "facets",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f -4 -3 -2\nf -4 -2 -1\n",
        "vn 0 0 1\nvt 0 0\nf 1/1/1 2//1 3/1\ng other\nf 1 3 4\n",
        "o part\nf 1 \\\n 2 3\ns off\nf 1 3 4 # the second\nl 1 2\n",
    ],
)
def test_facets_of_an_obj_file(tmp_path: Path, facets: str) -> None:
    (tmp_path / "a.obj").write_text(POINTS + facets)
    points, cells = read_facets(tmp_path / "a.obj")
    assert points[2].tolist() == [1, 1, 0]
    assert cells.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("f 1 2 0\n", "line 5: a facet with a corner that is not there"),
        ("f 1 2 -5\n", "line 5: a facet with a corner that is not there"),
        ("f 1 2 3 4 1\n", "line 5: a polygon of 5 corners"),
        ("f 1 2 x\n", "line 5: invalid literal"),
        ("v 1 2\nf 1 2 3\n", "has points in the plane"),
        ("surf 0 1 0 1 1 2 3\n", "line 5: surf is not supported"),
        ("l 1 2\n", "has no facets"),
    ],
)
def test_obj_files_that_are_refused(tmp_path: Path, more: str, told: str) -> None:
    (tmp_path / "a.obj").write_text(POINTS + more)
    with pytest.raises(InputError, match=told):
        read_facets(tmp_path / "a.obj")


def test_pieces_of_a_vtk_file_are_not_lost(tmp_path: Path) -> None:
    (tmp_path / "a.vtu").write_text(
        '<VTKFile><UnstructuredGrid><Piece a="1"/><Piece a="2"/></UnstructuredGrid></VTKFile>'
    )
    with pytest.raises(InputError, match="several pieces"):
        read_facets(tmp_path / "a.vtu")
