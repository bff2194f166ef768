"""Walls one cell thick are found, and divided into conforming layers."""

import numpy as np
import pytest

from softway.bodies.elements.section import default_section
from softway.bodies.inertia.mass_matrix import Consistent, nodal_mass
from softway.meshes.generators.shapes import box, disc, interval, rectangle
from softway.meshes.mesh import Mesh
from softway.meshes.walls.division import divided_at
from softway.meshes.walls.wall_edges import wall_edges

STRIP = {cell: rectangle((2.0, 0.1), (8, 1), cell=cell) for cell in ("quad4", "tri3")}
PLATE = {cell: box((2.0, 1.0, 0.1), (4, 2, 1), cell=cell) for cell in ("hex8", "tet4")}


def volume(mesh: Mesh) -> float:
    return float(nodal_mass(mesh, 1.0, default_section(mesh), Consistent()).sum())


def divided(mesh: Mesh, tag: str = "surface") -> Mesh:
    return divided_at(mesh, wall_edges(mesh, mesh.nodes(tag))).mesh


def turned(mesh: Mesh, angle: float) -> Mesh:
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(mesh.dim)
    turn[:2, :2] = [[c, -s], [s, c]]
    return Mesh(points=mesh.points @ turn.T, blocks=mesh.blocks, tags=mesh.tags)


@pytest.mark.parametrize("mesh", [*STRIP.values(), *PLATE.values()], ids=[*STRIP, *PLATE])
@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize("tag", ["surface", "bottom"])
def test_every_cell_of_a_wall_gets_nodes_at_half_its_thickness(mesh: Mesh, angle: float, tag: str) -> None:
    mesh = turned(mesh, angle)
    found = divided(mesh, tag)
    assert volume(found) == pytest.approx(volume(mesh), rel=1e-13)
    assert np.array_equal(found.points[: mesh.n_nodes], mesh.points)
    across = turned(found, -angle).points[mesh.n_nodes :, -1]
    assert across == pytest.approx(0.05, abs=1e-14)
    new = np.arange(found.n_nodes) >= mesh.n_nodes
    assert all(new[cells].any(axis=1).all() for cells in found.blocks.values())
    assert not len(wall_edges(found, found.nodes("surface")))
    faces = set(found.boundary()) | set(mesh.boundary())
    for facet in faces:
        outside = found.points[found.boundary()[facet]].mean(axis=1)
        inside = np.abs(outside - found.points.mean(axis=0)).max(axis=1)
        assert inside.min() > 0.02, "no facet is left open inside"


@pytest.mark.parametrize("cell", ["quad4", "quad9", "tri3"])
@pytest.mark.parametrize("layers", [2, 3])
def test_what_is_thick_stays(cell: str, layers: int) -> None:
    mesh = rectangle((2.0, 0.1), (8, layers), cell=cell)
    assert not len(wall_edges(mesh, mesh.nodes("surface")))


def test_other_bodies_have_no_walls() -> None:
    for mesh in (
        rectangle((2.0, 0.1), (8, 1), cell="quad9"),
        rectangle((2.0, 0.1), (8, 1), cell="tri6"),
        box((1.0, 1.0, 0.1), (2, 2, 1), cell="hex20"),
        interval(1.0, 1),
        disc(1.0, 8),
    ):
        assert not len(wall_edges(mesh, mesh.nodes("surface")))
    assert not len(wall_edges(STRIP["quad4"], np.zeros(0, int)))
    assert not len(wall_edges(STRIP["quad4"], STRIP["quad4"].nodes("left"))), "the end alone is no wall"


def test_a_beam_one_cell_wide_and_high_is_cut_in_four() -> None:
    found = divided(box((3.0, 0.1, 0.1), (3, 1, 1)))
    assert found.n_cells == 12 and found.n_nodes == 4 * 9
    assert len(found.nodes("surface")) == found.n_nodes - 2


def test_the_cut_goes_on_through_a_thick_part() -> None:
    """A shelf on a block: the row of cells behind it is cut too, and no node hangs."""
    x, y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    number = np.arange(20).reshape(5, 4)
    every = [(i, j) for i in range(2) for j in range(3)] + [(2, 1), (3, 1)]
    cells = np.array([[number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]] for i, j in every])
    used, cells = np.unique(cells, return_inverse=True)
    mesh = Mesh(points=np.column_stack([x.ravel(), y.ravel()])[used], blocks={"quad4": cells.reshape(-1, 4)})
    found = divided(mesh)
    assert found.n_cells == mesh.n_cells + 4
    assert found.n_nodes == mesh.n_nodes + 5
    assert volume(found) == pytest.approx(8.0, rel=1e-14)
    assert len(found.boundary()["bar2"]) == len(mesh.boundary()["bar2"]) + 2


def test_quadrilaterals_and_triangles_in_one_wall() -> None:
    points = np.array([[0.0, 0], [1, 0], [2, 0], [3, 0], [0, 0.1], [1, 0.1], [2, 0.1], [3, 0.1]])
    quads = np.array([[0, 1, 5, 4], [2, 3, 7, 6]])
    mesh = Mesh(points=points, blocks={"quad4": quads, "tri3": np.array([[1, 2, 6], [1, 6, 5]])})
    found = divided(mesh)
    assert found.n_nodes == 8 + 5
    assert volume(found) == pytest.approx(0.3, rel=1e-14)
    assert len(found.boundary()["bar2"]) == len(mesh.boundary()["bar2"]) + 2


def test_a_cut_that_crosses_itself_gives_four_cells() -> None:
    """Three quadrilaterals around a node: an edge leads through two of them, and all edges through the three."""
    angle = np.pi * np.arange(6) / 3.0
    points = np.vstack([[0.0, 0.0], np.column_stack([np.cos(angle), np.sin(angle)])])
    mesh = Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 1]])})
    found = divided_at(mesh, np.array([[0, 1], [0, 3], [0, 5]])).mesh
    assert found.n_cells == 12 and found.n_nodes == 7 + 9 + 3
    assert volume(found) == pytest.approx(volume(mesh), rel=1e-14)


def test_tags_and_regions_go_to_the_new_nodes_and_cells() -> None:
    mesh = STRIP["quad4"].with_region("tip", lambda x: x[:, 0] > 1.5)
    mesh = mesh.with_tag("clamp", lambda x: x[:, 0] < 0.6)
    found = divided(mesh)
    assert found.points[found.nodes("clamp")][:, 0].max() < 0.6
    assert len(found.nodes("clamp")) == 9
    assert len(found.nodes("bottom")) == len(mesh.nodes("bottom"))
    assert found.nodes("left").tolist() == np.flatnonzero(found.points[:, 0] == 0.0).tolist()
    assert (found.centres()[found.cells("tip"), 0] > 1.5).all() and len(found.cells("tip")) == 4


def test_values_between_are_means() -> None:
    mesh = PLATE["hex8"]
    found = divided_at(mesh, wall_edges(mesh, mesh.nodes("surface")))
    assert (found.weights @ mesh.points) == pytest.approx(found.mesh.points, abs=1e-15)
