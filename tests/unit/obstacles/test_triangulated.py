"""Surfaces of facets: exact distances, orientation, files, and what they refuse."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from softway.errors import InputError
from softway.kernels.geometry.closest_points import on_triangles
from softway.meshes.generators.shapes import ball, box, disc, rectangle
from softway.obstacles.primitives import Block, Cavity, Sphere
from softway.obstacles.triangulated import Facets, Surface
from softway.testing import check_obstacle

CUBE = Block(low=(-0.5, -0.4, -0.3), high=(0.5, 0.6, 0.2))
SQUARE = Block(low=(-0.5, -0.4), high=(0.5, 0.6))


def octants(level):
    """Unit sphere: the faces of an octahedron divided into four, again and again."""
    points = np.concatenate([np.eye(3), -np.eye(3)])
    cells = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    for _ in range(level):
        a, b, c = points[cells].swapaxes(0, 1)
        middle = [(u + v) / np.linalg.norm(u + v, axis=1, keepdims=True) for u, v in ((a, b), (b, c), (c, a))]
        ab, bc, ca = (len(points) + k * len(cells) + np.arange(len(cells)) for k in range(3))
        i, j, k = cells.T
        points = np.concatenate([points, *middle])
        cells = np.concatenate([np.stack(t, axis=1) for t in ((i, ab, ca), (ab, j, bc), (ca, bc, k), (ab, bc, ca))])
    return points, cells


def circle(count):
    angle = 2.0 * np.pi * np.arange(count) / count
    number = np.arange(count)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1), np.stack([number, (number + 1) % count], axis=1)


def triangles(mesh):
    """Corners and triangles of the boundary of a mesh of hexahedra."""
    quads = mesh.boundary()["quad4"]
    return mesh.points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def cube_facets(**options):
    points, cells = triangles(box((1.0, 1.0, 0.5), (1, 1, 1), origin=(-0.5, -0.4, -0.3)))
    return Facets(points=points, cells=cells, **options)


def square_facets():
    mesh = rectangle((1.0, 1.0), (1, 1), origin=(-0.5, -0.4))
    return Facets(points=mesh.points, cells=mesh.boundary()["bar2"])


def directions(count, dim=3, seed=0):
    d = np.random.default_rng(seed).standard_normal((count, dim))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


@pytest.mark.parametrize(("facets", "block"), [(cube_facets(), CUBE), (square_facets(), SQUARE)], ids=["3D", "2D"])
def test_a_cube_of_facets_is_the_block(facets, block):
    """Outside everywhere, at corners and edges too; inside wherever the nearest face is the same."""
    x = np.random.default_rng(0).uniform(-1.5, 1.5, (3000, block.dim))
    assert facets.closed and np.abs(facets.gap(x) - block.gap(x)).max() < 1e-13
    assert np.abs(facets.normal_at(x) - block.normal_at(x)).max() < 1e-12
    assert (block.gap(x) < 0.0).sum() > 50


@pytest.mark.parametrize("height", [1e-3, 1e-9, 1e-13, 0.0, -1e-13, -1e-9])
def test_near_a_face_the_normal_is_that_of_the_face(height):
    """Also above the diagonal of a square, where the closest point lies on an edge between two triangles."""
    t = np.linspace(0.05, 0.95, 50)
    x = np.stack([t - 0.5, t - 0.4, np.full(50, 0.2 + height)], axis=1)
    gap, normal = cube_facets().gap_and_normal(x)
    assert np.abs(gap - height).max() < 1e-16 + 1e-15 and (normal == [0.0, 0.0, 1.0]).all()


def test_a_triangulated_sphere_converges_at_second_order():
    errors, slopes = [], []
    d = directions(500)
    for level in (2, 3, 4):
        points, cells = octants(level)
        surface = Facets(points=points, cells=cells)
        errors.append(np.abs(surface.gap(1.1 * d) - 0.1).max())
        slopes.append(np.abs(surface.normal_at(1.1 * d) - d).max())
    assert 3.5 < errors[0] / errors[1] < 4.5 and 3.5 < errors[1] / errors[2] < 4.5
    assert 1.6 < slopes[0] / slopes[1] < 2.4 and 1.6 < slopes[1] / slopes[2] < 2.4


def test_bulging_facets_meet_a_sphere_at_fourth_order():
    errors, slopes = [], []
    d = directions(500)
    for level in (2, 3, 4):
        points, cells = octants(level)
        surface = Facets(points=points, cells=cells, smooth=True)
        errors.append(np.abs(surface.gap(d)).max())
        slopes.append(np.abs(surface.normal_at(d) - d).max())
    assert errors[0] / errors[1] > 12.0 and errors[1] / errors[2] > 12.0 and errors[2] < 1e-5
    assert slopes[0] / slopes[1] > 6.0 and slopes[1] / slopes[2] > 6.0 and slopes[2] < 2e-4


@pytest.mark.parametrize(("points", "cells"), [octants(2), circle(24)], ids=["3D", "2D"])
def test_the_normal_of_bulging_facets_is_the_gradient_where_they_are_touched(points, cells):
    surface = Facets(points=points, cells=cells, smooth=True)
    x = directions(300, points.shape[1])
    for _ in range(6):
        x = x - surface.gap(x)[:, None] * surface.normal_at(x)
    assert np.abs(surface.gap(x)).max() < 1e-15
    step = 1e-5
    arms = step * np.eye(surface.dim)
    slope = np.stack([(surface.gap(x + arm) - surface.gap(x - arm)) / (2.0 * step) for arm in arms], axis=1)
    smooth = np.abs(surface.normal_at(x + step) - surface.normal_at(x - step)).max(axis=1) < 1e-3
    assert smooth.sum() > 200 and np.abs(slope - surface.normal_at(x))[smooth].max() < 1e-8


def test_bulging_facets_keep_what_is_flat():
    flat = Facets(
        points=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), cells=[[0, 1, 2], [0, 2, 3]], smooth=True
    )
    x = np.random.default_rng(0).uniform(0.1, 0.9, (50, 3))
    gap, normal = flat.gap_and_normal(x)
    assert np.abs(gap - x[:, 2]).max() < 1e-14 and np.abs(normal - [0.0, 0.0, 1.0]).max() < 1e-14


def test_the_nearest_facet_is_found_among_facets_of_very_different_size():
    """Against all pairs, on a box whose cells shrink to one end by a factor of a thousand."""
    mesh = box((1.0, 1.0, 1.0), (12, 9, 6))
    points, cells = triangles(mesh)
    points = points**6 + 0.0
    facets = Facets(points=points, cells=cells)
    x = np.concatenate([np.random.default_rng(3).uniform(-0.5, 1.5, (200, 3)), 1e-3 * directions(100), directions(20)])
    a, b, c = facets.points[facets.cells].swapaxes(0, 1)
    count = len(facets.cells)
    for point, gap in zip(x, facets.gap(x), strict=True):
        w = on_triangles(np.repeat(point[None], count, axis=0), a, b, c)
        foot = w[:, :1] * a + w[:, 1:2] * b + w[:, 2:] * c
        assert abs(abs(gap) - np.linalg.norm(point - foot, axis=1).min()) < 1e-15
    unit = Block(low=(0.0, 0.0, 0.0), high=(1.0, 1.0, 1.0))
    assert np.abs(facets.gap(x) - unit.gap(x)).max() < 1e-12


def test_many_points_that_are_near_to_all_facets_are_taken_in_parts(monkeypatch):
    monkeypatch.setattr("softway.obstacles.triangulated.PAIRS", 3000)
    points, cells = octants(3)
    x = 1e-3 * directions(60)
    split = Facets(points=points, cells=cells).gap(x)
    monkeypatch.undo()
    assert np.array_equal(split, Facets(points=points, cells=cells).gap(x))


def test_it_is_examined_as_every_obstacle():
    points, cells = octants(2)
    surface = Facets(points=points, cells=cells)
    facet = surface.points[surface.cells]
    centre, normal = facet.mean(axis=1), surface.pseudo[:, -1]
    for height in (0.3, 1e-3, -1e-3):
        check_obstacle(surface, centre + height * normal)
    check_obstacle(Cavity(of=surface), centre - 1e-2 * normal)
    check_obstacle(cube_facets(), np.array([[1.0, 0.9, 0.1], [0.2, 0.1, 0.15], [0.9, 0.9, 0.9]]))


def test_a_closed_surface_that_faces_inward_is_refused():
    for points, cells in (octants(1), circle(12)):
        assert Cavity(of=Facets(points=points, cells=cells)).gap(np.zeros(points.shape[1])) > 0.0
        with pytest.raises(InputError, match="inside out"):
            Facets(points=points + 1e3, cells=cells[:, ::-1])


def test_a_wall_of_no_thickness_is_refused():
    one, two = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0, 3, 1], [1, 3, 2]])
    square = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]])
    for back in (one[:, ::-1], two):
        with pytest.raises(InputError, match="no thickness"):
            Facets(points=square, cells=np.concatenate([one, back]))
    with pytest.raises(InputError, match="no thickness"):
        Facets(points=square[:, :2], cells=np.array([[0, 1], [1, 0]]))


def test_a_void_inside_a_solid_stays_free():
    """A shell with an inner surface that faces the hollow."""
    points, cells = octants(3)
    shell = Facets(
        points=np.concatenate([points, 0.5 * points]), cells=np.concatenate([cells, len(points) + cells[:, ::-1]])
    )
    d = directions(100)
    assert (shell.gap(0.3 * d) > 0.0).all() and (shell.gap(0.75 * d) < 0.0).all() and (shell.gap(1.2 * d) > 0.0).all()


def test_an_open_surface_has_a_front_a_back_and_free_space_beside():
    sheet = Facets(
        points=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), cells=np.array([[0, 1, 2], [0, 2, 3]])
    )
    x = np.array([[0.5, 0.4, 0.2], [0.5, 0.4, -0.2], [1.3, 0.5, -0.4], [1.3, 0.5, 0.4], [1.0, 1.0, 0.5]])
    assert not sheet.closed
    np.testing.assert_allclose(sheet.gap(x), [0.2, -0.2, 0.5, 0.5, 0.5], atol=1e-15)
    np.testing.assert_allclose(sheet.normal_at(x)[1:3], [[0.0, 0.0, 1.0], [0.6, 0.0, -0.8]], atol=1e-15)
    curved = Facets(points=sheet.points, cells=sheet.cells, smooth=True)
    np.testing.assert_allclose(curved.gap(x), [0.2, -0.2, 0.5, 0.5, 0.5], atol=1e-15)


def test_double_vertices_and_collapsed_facets_are_merged():
    points, cells = octants(2)
    exact = Facets(points=points, cells=cells)
    soup = points[cells].reshape(-1, 3) * (1.0 + 1e-8 * np.random.default_rng(0).standard_normal((3 * len(cells), 1)))
    numbers = np.arange(len(soup)).reshape(-1, 3)
    merged = Facets(points=soup, cells=np.concatenate([numbers, [[0, 0, 1]]]))
    assert merged.closed and len(merged.points) == len(exact.points) == 66 and len(merged.cells) == len(cells)


def test_points_nowhere_have_no_distance():
    points, cells = octants(1)
    surface = Facets(points=points, cells=cells)
    gap, normal = surface.gap_and_normal(np.array([[np.nan, 0.0, 0.0], [np.inf, 0.0, 0.0], [2.0, 0.0, 0.0]]))
    assert np.isnan(gap[:2]).all() and np.isnan(normal[:2]).all() and gap[2] == 1.0
    assert surface.gap(np.zeros((0, 3))).shape == (0,) and surface.normal_at(np.zeros((2, 5, 3))).shape == (2, 5, 3)


TWO = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])


@pytest.mark.parametrize(
    ("points", "cells", "problem"),
    [
        (TWO, [[0, 1, 2], [1, 2, 3]], "opposite sides"),
        (np.concatenate([TWO, [[0.5, 0.5, 1.0]]]), [[0, 1, 2], [2, 1, 3], [1, 2, 4]], "more than two facets"),
        (np.array([[0, 0, 0], [1, 0, 0], [0.4, 0, 0], [0, 1, 0.0]]), [[0, 1, 2], [0, 2, 3]], "no area"),
        (TWO, np.zeros((0, 3), int), "shape"),
        (TWO, [[0, 1]], "shape"),
        (TWO, [[0, 1, 7]], "0 to 3"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], "finite"),
        (np.zeros((3, 1)), [[0]], "finite"),
        (TWO, [[0, 0, 1]], "two different"),
        (np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), [[0, 1], [2, 1]], "opposite sides"),
    ],
)
def test_what_is_no_surface_is_refused(points, cells, problem):
    with pytest.raises(InputError, match=problem):
        Facets(points=points, cells=cells)


def test_points_of_another_dimension_are_refused():
    with pytest.raises(InputError, match="2D for a body in 3D"):
        square_facets().gap(np.zeros(3))


# ------------------------------------------------------------------------------------------------------------- files


def written(path: Path, points, cells, **options) -> Path:
    meshio.write(path, meshio.Mesh(points, cells), **options)
    return path


@pytest.mark.parametrize("binary", [True, False])
def test_an_stl_file_is_the_block(tmp_path, binary):
    """Coordinates in single precision: eighths of a metre are exact."""
    points, cells = triangles(box((1.0, 1.5, 0.5), (2, 3, 1), origin=(-0.5, -0.25, 0.125)))
    file = written(tmp_path / "cube.stl", points, [("triangle", cells)], binary=binary)
    surface, block = Surface(file=file), Block(low=(-0.5, -0.25, 0.125), high=(0.5, 1.25, 0.625))
    x = np.random.default_rng(0).uniform(-1.0, 2.0, (500, 3))
    assert surface.facets.closed and surface.dim == 3
    assert np.abs(surface.gap(x) - block.gap(x)).max() < 1e-12
    assert np.abs(surface.normal_at(x) - block.normal_at(x)).max() < 1e-12


def test_the_scale_is_the_length_unit_of_the_file(tmp_path):
    points, cells = octants(2)
    file = written(tmp_path / "ball.obj", 20.0 * points, [("triangle", cells)])
    assert Surface(file=file, scale=1e-3).gap(np.array([0.0, 0.0, 0.05])) == pytest.approx(0.03, abs=1e-15)
    assert Surface(file=file, scale=1e-3, smooth=True).facets.smooth


@pytest.mark.parametrize("cell", ["quad4", "tri3", "tri6", "quad8", "quad9"])
def test_the_boundary_of_a_plane_mesh_is_taken(tmp_path, cell):
    mesh = rectangle((1.0, 1.0), (3, 2), origin=(-0.5, -0.4), cell=cell)
    names = {"quad4": "quad", "tri3": "triangle", "tri6": "triangle6", "quad8": "quad8", "quad9": "quad9"}
    points = np.pad(mesh.points, ((0, 0), (0, 1)))
    file = written(tmp_path / "a.msh", points, [(names[cell], mesh.blocks[cell])], file_format="gmsh22", binary=False)
    x = np.random.default_rng(0).uniform(-1.0, 1.0, (200, 2))
    assert np.abs(Surface(file=file).gap(x) - SQUARE.gap(x)).max() < 1e-15


@pytest.mark.parametrize(
    ("cell", "name"),
    [
        ("hex8", "hexahedron"),
        ("tet4", "tetra"),
        ("tet10", "tetra10"),
        ("hex20", "hexahedron20"),
        ("hex27", "hexahedron27"),
    ],
)
def test_the_boundary_of_a_solid_mesh_is_taken(tmp_path, cell, name):
    mesh = box((1.0, 1.0, 0.5), (2, 2, 1), origin=(-0.5, -0.4, -0.3), cell=cell)
    file = written(tmp_path / "a.vtu", mesh.points, [(name, mesh.blocks[cell])])
    x = np.random.default_rng(0).uniform(-1.0, 1.0, (200, 3))
    assert np.abs(Surface(file=file).gap(x) - CUBE.gap(x)).max() < 1e-14


def test_lines_in_the_plane(tmp_path):
    points, cells = circle(400)
    file = written(tmp_path / "c.vtu", np.pad(points, ((0, 0), (0, 1)), constant_values=3.0), [("line", cells)])
    x, round_one = np.random.default_rng(0).uniform(-2.0, 2.0, (100, 2)), Sphere(centre=(0.0, 0.0), radius=1.0)
    assert Surface(file=file).dim == 2 and np.abs(Surface(file=file).gap(x) - round_one.gap(x)).max() < 4e-5
    bent = points[:, [0, 1, 1]]
    with pytest.raises(InputError, match="not in a plane"):
        Surface(file=written(tmp_path / "d.vtu", bent, [("line", cells)]))


def test_curved_cells_are_taken_at_all_their_nodes(tmp_path):
    errors = []
    for cells in (4, 8):
        mesh = ball(1.0, cells, cell="hex27")
        file = written(tmp_path / "b.vtu", mesh.points, [("hexahedron27", mesh.blocks["hex27"])])
        errors.append(np.abs(Surface(file=file).gap(2.0 * directions(100)) - 1.0).max())
    assert 3.5 < errors[0] / errors[1] < 4.5
    mesh = disc(1.0, 8, cell="tri6")
    file = written(tmp_path / "d.vtu", np.pad(mesh.points, ((0, 0), (0, 1))), [("triangle6", mesh.blocks["tri6"])])
    assert Surface(file=file).facets.closed


def test_what_is_no_file_of_facets_is_refused(tmp_path):
    (tmp_path / "a.step").write_text("ISO-10303-21;")
    (tmp_path / "a.stl").write_text("solid nothing\nendsolid\n")
    (tmp_path / "b.stl").write_bytes(b"\0" * 200)
    (tmp_path / "e.obj").write_text("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4 5\nf 1 2 6\n")
    points, cells = octants(1)
    written(tmp_path / "c.obj", points, [("triangle", np.concatenate([cells[1:], cells[:1, ::-1]]))])
    written(tmp_path / "d.vtu", points, [("vertex", np.arange(6)[:, None])])
    known = {
        "none.stl": "no such file",
        "a.step": "ending",
        "a.stl": "a.stl",
        "b.stl": "b.stl",
        "c.obj": "opposite",
        "d.vtu": "no facets",
        "e.obj": "polygon",
    }
    for name, problem in known.items():
        with pytest.raises(InputError, match=problem) as found:
            Surface(file=tmp_path / name)
        assert found.value.where == "file" and found.value.remedy
    with pytest.raises(InputError) as found:
        Surface(file=tmp_path / "c.obj", scale=0.0)
    assert found.value.where == "scale"
