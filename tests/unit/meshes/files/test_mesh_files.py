"""Mesh files, written through meshio and read back."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from softway.errors import InputError
from softway.meshes.element import CELLS
from softway.meshes.files.mesh_files import NAMES, read_facets, read_mesh
from softway.meshes.generators.shapes import KINDS, box, disc, rectangle
from softway.meshes.mesh import Mesh

MESHIO = {ours: theirs for theirs, ours in NAMES.items()}
BRACKET = Path(__file__).parents[4] / "scenarios" / "bracket.msh"


def gmsh_file(path: Path, mesh: Mesh, version: str, groups: dict[str, str]) -> None:
    """Write a mesh with the facets of some tags as physical groups: name of the group -> tag."""
    blocks = [(MESHIO[name], cells) for name, cells in mesh.blocks.items()]
    marks = [np.full(len(cells), 1) for cells in mesh.blocks.values()]
    names = {"body": np.array([1, mesh.cell_dim])}
    for number, (group, tag) in enumerate(groups.items(), start=2):
        for name, facets in mesh.facets_on(tag).items():
            blocks.append((MESHIO[name], facets))
            marks.append(np.full(len(facets), number))
        names[group] = np.array([number, mesh.cell_dim - 1])
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dim)))
    data = {"gmsh:physical": marks, "gmsh:geometrical": marks}
    raw = meshio.Mesh(points, blocks, cell_data=data, field_data=names)
    meshio.write(path, raw, file_format="gmsh22" if version == "2.2" else "gmsh", binary=False)


@pytest.mark.parametrize("cell", [*KINDS[2], *KINDS[3]])
def test_gmsh_round_trip(tmp_path: Path, cell: str) -> None:
    made = rectangle((2.0, 1.0), (2, 2), cell=cell) if cell in KINDS[2] else box((2.0, 1.0, 1.0), (2, 1, 1), cell=cell)
    gmsh_file(tmp_path / "a.msh", made, "2.2", {"floor": "bottom", "wall": "left"})
    mesh = read_mesh(tmp_path / "a.msh", scale=1e-3)
    assert mesh.dim == made.dim
    assert np.abs(mesh.points - 1e-3 * made.points).max() < 1e-15
    assert mesh.blocks[cell].tolist() == made.blocks[cell].tolist()
    assert mesh.nodes("floor").tolist() == made.nodes("bottom").tolist()
    assert mesh.nodes("wall").tolist() == made.nodes("left").tolist()
    assert mesh.nodes("body").tolist() == made.nodes("all").tolist()


@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8", "tet4", "tet10", "hex8", "hex20"])
def test_abaqus_round_trip(tmp_path: Path, cell: str) -> None:
    made = disc(1.0, 4, cell=cell) if cell in KINDS[2] else box((2.0, 1.0, 1.0), (2, 1, 1), cell=cell)
    tag = next(iter(made.tags))
    kinds = {"tri3": "CPE3", "tri6": "CAX6", "quad4": "CPE4", "quad8": "CPS8R"}
    kinds |= {"tet4": "C3D4", "tet10": "C3D10", "hex8": "C3D8", "hex20": "C3D20R"}
    lines = ["*NODE"]
    lines += [
        f"{k + 1}, " + ", ".join(repr(float(v)) for v in row)
        for k, row in enumerate(np.pad(made.points, ((0, 0), (0, 3 - made.dim))))
    ]
    lines += [f"*ELEMENT, TYPE={kinds[cell]}, ELSET=Body"]
    for k, row in enumerate(made.blocks[cell]):
        numbers = [str(n) for n in (k + 1, *(row + 1))]
        lines += [", ".join(numbers[i : i + 16]) + "," * (i + 16 < len(numbers)) for i in range(0, len(numbers), 16)]
    lines += ["*NSET, NSET=Some", ", ".join(str(a + 1) for a in made.nodes(tag)[:8]), "*ELSET, ELSET=First", "1,"]
    (tmp_path / "a.inp").write_text("\n".join(lines) + "\n")
    mesh = read_mesh(tmp_path / "a.inp")
    assert mesh.dim == made.dim
    assert mesh.blocks[cell].tolist() == made.blocks[cell].tolist()
    assert mesh.nodes("Some").tolist() == made.nodes(tag)[:8].tolist()
    assert mesh.nodes("Body").tolist() == made.nodes("all").tolist()
    assert mesh.nodes("First").tolist() == sorted(made.blocks[cell][0].tolist())


# Ends of the edges of a hexahedron in the order of the middle nodes 9 to 20, as the manuals number the corners.
GMSH_EDGES = "12 14 15 23 26 34 37 48 56 58 67 78"
ABAQUS_EDGES = "12 23 34 41 56 67 78 85 15 26 37 48"


@pytest.mark.parametrize(("ending", "edges"), [("msh", GMSH_EDGES), ("inp", ABAQUS_EDGES)])
def test_the_middle_nodes_of_a_hexahedron_are_found_in_the_order_of_each_format(
    tmp_path: Path, ending: str, edges: str
) -> None:
    corners = np.array([1.0, 2.0, 3.0]) * CELLS["hex8"].nodes
    points = [*corners, *(corners[[int(end) - 1 for end in edge]].mean(axis=0) for edge in edges.split())]
    places = [" ".join(map(str, [k, *x])) for k, x in enumerate(points, start=1)]
    nodes = " ".join(map(str, range(1, 21)))
    if ending == "msh":
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", "20", *places, "$EndNodes"]
        lines += ["$Elements", "1", f"1 17 2 1 1 {nodes}", "$EndElements"]
    else:
        places = [line.replace(" ", ", ") for line in places]
        lines = [
            "*NODE",
            *places,
            "*ELEMENT, TYPE=C3D20",
            ", ".join(["1", *nodes.split()[:15]]) + ",",
            "16,17,18,19,20",
        ]
    (tmp_path / f"a.{ending}").write_text("\n".join(lines) + "\n")
    mesh = read_mesh(tmp_path / f"a.{ending}")
    assert mesh.points[mesh.blocks["hex20"][0]].tolist() == (np.array([1.0, 2.0, 3.0]) * CELLS["hex20"].nodes).tolist()


def test_deck_written_by_gmsh_style_tools(tmp_path: Path) -> None:
    """Surface elements beside the volume, an included file, blocks that share a set, sets by range."""
    points = "*Node\n1, 0,0,0\n2, 1,0,0\n3, 0,1,0\n4, 0,0,1\n5, 1,1,1\n6, 0,0,-1\n"
    (tmp_path / "more.inp").write_text("*Element, type=CPS3, elset=Face\n10, 1,3,2\n11, 1,2,4\n")
    deck = "*ELEMENT, type=C3D4\n1, 1,2,3,4\n*ELEMENT, type=c3d4t, ELSET=Both\n2, 2,5,3,4\n"
    deck += "*Element, type=C3D4, ELSET=Both\n3, 2,5,3,4\n"
    deck = deck.replace("3, 2,5,3,4\n", "3, 1,3,2,6\n") + "*NSET, NSET=Line, GENERATE\n1, 5, 2\n*STEP\n*END STEP\n"
    (tmp_path / "a.inp").write_text(points + "*INCLUDE, INPUT=more.inp\n" + deck)
    mesh = read_mesh(tmp_path / "a.inp")
    assert list(mesh.blocks) == ["tet4"] and mesh.n_cells == 3
    assert mesh.nodes("Face").tolist() == [0, 1, 2, 3]
    assert mesh.nodes("Both").tolist() == [0, 1, 2, 3, 4, 5]
    assert mesh.nodes("Line").tolist() == [0, 2, 4]


def test_unused_points_are_dropped_and_cells_chosen(tmp_path: Path) -> None:
    points = np.array([[9.0, 9, 0], [0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]])
    raw = meshio.Mesh(points, [("quad", np.array([[1, 2, 3, 4]])), ("triangle", np.array([[2, 5, 3]]))])
    meshio.write(tmp_path / "a.msh", raw, file_format="gmsh22", binary=False)
    assert read_mesh(tmp_path / "a.msh").n_nodes == 5
    assert read_mesh(tmp_path / "a.msh", cells=("quad4",)).n_nodes == 4
    with pytest.raises(InputError, match="none of the wanted cells among quad, triangle"):
        read_mesh(tmp_path / "a.msh", cells=("hex8",))


def test_cells_of_some_physical_groups(tmp_path: Path) -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
    marks = [np.array([1, 2])]
    raw = meshio.Mesh(
        points,
        [("quad", np.array([[0, 1, 2, 3], [1, 4, 5, 2]]))],
        cell_data={"gmsh:physical": marks, "gmsh:geometrical": marks},
        field_data={"steel": np.array([1, 2]), "rubber": np.array([2, 2])},
    )
    meshio.write(tmp_path / "a.msh", raw, file_format="gmsh22", binary=False)
    mesh = read_mesh(tmp_path / "a.msh", only=("rubber",))
    assert mesh.points[:, 0].min() == 1 and mesh.n_cells == 1
    with pytest.raises(InputError, match="no cells in the groups glass") as caught:
        read_mesh(tmp_path / "a.msh", only=("glass",))
    assert caught.value.remedy == "one of: rubber, steel"


@pytest.mark.parametrize("ending", [".msh", ".inp", ""])
def test_a_name_that_no_file_system_admits(tmp_path: Path, ending: str) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_mesh(tmp_path / ("x" * 300 + ending))
    with pytest.raises(InputError, match="no such file"):
        read_facets(tmp_path / ("x" * 300 + ".stl"))


def test_bad_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file") as caught:
        read_mesh(tmp_path / "none.msh")
    assert caught.value.where == "path"
    (tmp_path / "a.msh").write_text("rubbish\n")
    with pytest.raises(InputError, match="cannot be read"):
        read_mesh(tmp_path / "a.msh")
    (tmp_path / "a.inp").write_text("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=NOPE\n1, 1\n")
    with pytest.raises(InputError):
        read_mesh(tmp_path / "a.inp")
    (tmp_path / "a.stl").write_text("")
    with pytest.raises(InputError, match="'.stl'"):
        read_mesh(tmp_path / "a.stl")


def test_unknown_and_inverted_cells_are_refused(tmp_path: Path) -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    raw = meshio.Mesh(points, [("quad", np.array([[0, 3, 2, 1]]))])
    meshio.write(tmp_path / "a.msh", raw, file_format="gmsh22", binary=False)
    with pytest.raises(InputError, match="inverted cell number 0"):
        read_mesh(tmp_path / "a.msh")
    wedge = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]])
    meshio.write(
        tmp_path / "b.msh", meshio.Mesh(wedge, [("wedge", np.arange(6)[None])]), file_format="gmsh22", binary=False
    )
    with pytest.raises(InputError, match="'wedge'"):
        read_mesh(tmp_path / "b.msh")


def test_file_that_lists_a_corner_cell_twice_is_refused(tmp_path: Path) -> None:
    """Facets that occur twice would be no boundary: the corner would sink into the floor."""
    mesh = box((1.0, 1.0, 1.0), (3, 3, 3))
    raw = meshio.Mesh(mesh.points, [("hexahedron", mesh.blocks["hex8"][[*range(27), 0]])])
    meshio.write(tmp_path / "a.msh", raw, file_format="gmsh22", binary=False)
    with pytest.raises(InputError, match="cell number 27 has the corners of cell number 0"):
        read_mesh(tmp_path / "a.msh")


def test_the_shipped_bracket() -> None:
    """Volume of the ideal part: two legs, a fillet, four rounded corners and two holes, 49 738 mm^3."""
    mesh = read_mesh(BRACKET, scale=1e-3)
    assert 3000 <= mesh.n_nodes <= 4500
    assert np.abs(np.ptp(mesh.points, axis=0) - [0.08, 0.04, 0.06]).max() < 1e-9
    assert np.abs(mesh.points[mesh.nodes("base"), 2]).max() < 1e-9
    assert {"bracket", "base", "holes"} <= set(mesh.tags)
    from softway.meshes.element import element, exact_degree

    table = element("tet10", exact_degree("tet10", curved=True))
    det = np.linalg.det(np.einsum("eai,qar->eqir", mesh.points[mesh.blocks["tet10"]], table.dN))
    assert det.min() > 0.0
    round_ = (1 - np.pi / 4) * 64
    exact = 52000 + round_ * 40 - 4 * round_ * 10 - 2 * np.pi * 36 * 10
    assert (det @ table.weights).sum() == pytest.approx(1e-9 * exact, rel=2e-4)
    assert CELLS["tet10"].order == 2
