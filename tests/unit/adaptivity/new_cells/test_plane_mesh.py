"""New triangles of bodies in the plane: shape, tags, quality, and the same cells on every processor."""

from collections.abc import Callable

import numpy as np
import pytest

from softway.adaptivity.new_cells.outline import outline
from softway.adaptivity.new_cells.plane_mesh import NewMesh, plane_mesh
from softway.adaptivity.new_cells.sizes import edge_lengths
from softway.adaptivity.new_cells.triangulation import triangulated
from softway.adaptivity.rezoning.quality import cell_quality
from softway.arrays import Array
from softway.meshes.generators.shapes import rectangle
from softway.meshes.mesh import Mesh

Shape = Callable[[Array], Array]


def square(x: Array) -> Array:
    return x


def lens(x: Array) -> Array:
    return np.stack([x[:, 0] * (2.4 - 0.4 * x[:, 1] ** 2), 0.25 * x[:, 1]], axis=1)


def ring(x: Array) -> Array:
    angle, radius = 1.9 * np.pi * (1.0 - x[:, 1]), 0.3 + 0.7 * x[:, 0]
    return np.stack([radius * np.cos(angle), -radius * np.sin(angle)], axis=1)


def wave(x: Array) -> Array:
    return np.stack([x[:, 0], x[:, 1] * (1.0 + 0.25 * np.sin(6.0 * x[:, 0]))], axis=1)


SHAPES = [square, lens, ring, wave]
AREA = {
    square: 1.0,
    lens: 0.25 * (2.4 - 0.4 / 3.0),
    ring: 0.95 * np.pi * 0.91,
    wave: 1.0 + 0.25 * (1.0 - np.cos(6.0)) / 6.0,
}


def base(cell: str = "tri3", cells: int = 12) -> Mesh:
    return rectangle((1.0, 1.0), cells=(cells, cells), cell=cell)


def meshed(mesh: Mesh, places: Array) -> NewMesh:
    none = np.zeros(mesh.n_nodes, dtype=bool)
    sizes = edge_lengths(Mesh(points=places, blocks=mesh.blocks))
    found = plane_mesh(mesh, places, np.full(mesh.n_nodes, np.median(sizes)), none, none)
    assert found is not None
    return found


def area(mesh: Mesh, points: Array) -> float:
    (cells,) = mesh.blocks.values()
    x = points[cells[:, :3]]
    return 0.5 * float(np.linalg.det(x[:, 1:] - x[:, :1]).sum())


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("cell", ["tri3", "tri6"])
def test_quality_number_area_and_tags(shape: Shape, cell: str) -> None:
    mesh = base(cell)
    places = shape(mesh.points)
    new = meshed(mesh, places).mesh
    assert cell_quality(new.blocks, new.points).worst[0] > 0.4
    assert new.n_cells == pytest.approx(mesh.n_cells, rel=0.4)
    assert area(new, new.points) == pytest.approx(AREA[shape], rel=2e-2)  # chords of the curved sides
    for tag in ("left", "right", "bottom", "top"):
        ends = mesh.nodes(tag)
        corners = places[ends[np.isin(mesh.points[ends], [0.0, 1.0]).all(axis=1)]]
        assert len(corners) == 2
        away = np.linalg.norm(new.points[new.nodes(tag)][:, None] - corners, axis=2).min(axis=0)
        assert away.max() < 1e-14
    tagged = np.unique(np.concatenate([new.nodes(tag) for tag in ("left", "right", "bottom", "top")]))
    assert np.array_equal(tagged, new.nodes("surface"))


@pytest.mark.parametrize("shape", SHAPES)
def test_rounding_changes_no_cell(shape: Shape) -> None:
    mesh = base()
    places = shape(mesh.points)
    first = meshed(mesh, places).mesh.blocks["tri3"]
    for seed in range(3):
        noise = 1.0 + 4e-16 * np.random.default_rng(seed).integers(-2, 3, places.shape)
        assert np.array_equal(meshed(mesh, places * noise).mesh.blocks["tri3"], first)


def test_a_side_through_a_slot_is_recovered() -> None:
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.02, 1.0], [2.0, 0.1], [1.98, 1.0], [0.0, 1.0]])
    sides = np.stack([np.arange(7), (np.arange(7) + 1) % 7], axis=1)
    found = triangulated(corners, sides)
    assert found is not None
    assert len(found) == 5
    edges = {(a, b) for t in found.tolist() for a, b in zip(t, t[1:] + t[:1], strict=True)}
    assert {tuple(side) for side in sides.tolist()} <= edges


def test_crossing_sides_have_no_triangles() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])
    assert triangulated(corners, np.array([[0, 1], [1, 2], [2, 3], [3, 0]])) is None


def test_nodes_that_may_not_move_stay_corners() -> None:
    mesh = base()
    kept = np.isin(np.arange(mesh.n_nodes), mesh.nodes("top"))
    found = outline(mesh, mesh.points, np.full(mesh.n_nodes, 0.3), ~kept & False, kept)
    assert np.array_equal(np.sort(found.points[found.node_tags["top"], 0]), np.sort(mesh.points[kept, 0]))
    assert found.kept.sum() == kept.sum()
    assert found.node_tags["bottom"].sum() == 4


def test_ends_of_contacts_are_corners() -> None:
    mesh = base()
    closed = np.isin(np.arange(mesh.n_nodes), mesh.nodes("top")) & (mesh.points[:, 0] < 0.6)
    found = outline(mesh, mesh.points, np.full(mesh.n_nodes, 0.3), closed, ~closed & False)
    end = mesh.points[closed, 0].max()
    assert np.abs(found.points[found.touching, 0] - end).min() == pytest.approx(0.0, abs=1e-15)
    assert found.points[found.touching, 0].max() == pytest.approx(end, abs=1e-15)


def test_thin_parts_get_shorter_edges() -> None:
    mesh = rectangle((1.0, 0.1), cells=(10, 2), cell="tri3")
    none = np.zeros(mesh.n_nodes, dtype=bool)
    found = outline(mesh, mesh.points, np.full(mesh.n_nodes, 0.1), none, none)
    top = found.points[found.sides[found.side_tags["top"]]]
    assert np.abs(np.diff(top[:, :, 0])).max() == pytest.approx(0.1 / 1.5, rel=1e-12)
