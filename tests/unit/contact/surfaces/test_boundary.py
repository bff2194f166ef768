"""Nodes, normals and sharp edges of a side."""

import numpy as np
import pytest

from softway.contact.surfaces.boundary import ContactSurface, outward
from softway.errors import InputError
from softway.meshes.generators.shapes import ball, box, disc, interval, rectangle


def test_facets_are_numbered_kind_after_kind() -> None:
    side = ContactSurface(facets={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2], [7, 8, 9]])})
    assert side.nodes.tolist() == [0, 1, 2, 3, 4, 7, 8, 9]
    assert [(kind, first, len(found)) for kind, first, found in side.numbers] == [("quad4", 0, 1), ("tri3", 1, 2)]
    assert side.table.tolist() == [[0, 1, 2, 3], [1, 4, 2, 1], [7, 8, 9, 7]]


def test_facets_of_different_dimensions_are_refused() -> None:
    with pytest.raises(InputError, match="one dimension"):
        ContactSurface(facets={"bar2": np.array([[0, 1]]), "tri3": np.array([[0, 1, 2]])})
    with pytest.raises(InputError, match="none"):
        ContactSurface(facets={"bar2": np.zeros((0, 2), dtype=int)})
    with pytest.raises(InputError, match="outward"):
        ContactSurface(facets={"point1": np.array([[0]])})


@pytest.mark.parametrize("cell", ["bar2", "bar3"])
def test_ends_of_a_bar_have_outward_normals(cell: str) -> None:
    mesh = interval(2.0, 3, cell=cell)
    points = mesh.boundary()["point1"]
    side = ContactSurface(facets={"point1": points}, ends=outward(mesh.blocks[cell], points))
    assert side.dim == 1
    assert side.nodal_normals(mesh.points).ravel().tolist() == [-1.0, 1.0]


@pytest.mark.parametrize(
    ("make", "cell"),
    [(disc, "quad4"), (disc, "quad9"), (ball, "hex8"), (ball, "hex20"), (ball, "hex27"), (ball, "tet10")],
)
def test_nodal_normals_of_a_ball_are_radial(make, cell: str) -> None:
    errors = []
    for cells in (6, 12):
        mesh = make(1.0, cells, cell=cell)
        side = ContactSurface(facets=mesh.boundary())
        radial = mesh.points[side.nodes]
        errors.append(np.linalg.norm(side.nodal_normals(mesh.points) - radial, axis=1).max())
    assert errors[1] < 0.02
    assert errors[0] > 1.9 * errors[1] or errors[0] < 1e-12


@pytest.mark.parametrize("cell", ["hex8", "hex20", "hex27", "tet4", "tet10"])
def test_nodal_normals_of_a_box_corner_are_the_diagonal(cell: str) -> None:
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell)
    side = ContactSurface(facets=mesh.boundary())
    corner = np.searchsorted(side.nodes, mesh.nearest((1.0, 1.0, 1.0)))
    middle = np.searchsorted(side.nodes, mesh.nearest((1.0, 0.5, 0.5)))
    normals = side.nodal_normals(mesh.points)
    assert normals[corner] == pytest.approx(np.full(3, 3.0**-0.5), abs=1e-13)
    assert normals[middle] == pytest.approx(np.array([1.0, 0.0, 0.0]), abs=1e-13)


@pytest.mark.parametrize("cell", ["hex8", "hex20", "hex27", "tet4", "tet10"])
def test_sharp_edges_of_a_box(cell: str) -> None:
    mesh = box((1.0, 2.0, 3.0), (1, 2, 3), cell=cell)
    edges = ContactSurface(facets=mesh.boundary()).sharp_edges(mesh.points)
    x = mesh.points[edges.ends]
    lengths = np.linalg.norm(x[:, 1] - x[:, 0], axis=1)
    assert len(lengths) == 4 * (1 + 2 + 3)
    assert lengths == pytest.approx(np.ones(24), abs=1e-14)
    for normal in edges.normals(mesh.points):
        middle = x.mean(axis=1)
        assert np.abs(normal).max(axis=1) == pytest.approx(np.ones(24), abs=1e-13)
        outside = middle + 1e-3 * normal
        assert ((outside < 0.0) | (outside > np.array([1.0, 2.0, 3.0]))).any(axis=1).all()


@pytest.mark.parametrize("cell", ["tet10", "hex20", "hex27"])
def test_nodes_in_the_middle_of_edges_are_on_them(cell: str) -> None:
    mesh = box((1.0, 1.0, 1.0), (2, 3, 1), cell=cell)
    side = ContactSurface(facets=mesh.boundary())
    outer = np.isclose(mesh.points, 0.0) | np.isclose(mesh.points, 1.0)
    assert side.nodes_on(side.sharp_edges(mesh.points)).tolist() == np.flatnonzero(outer.sum(axis=1) >= 2).tolist()


def test_a_ball_and_a_notch_have_no_sharp_convex_edges() -> None:
    mesh = ball(1.0, 8)
    assert len(ContactSurface(facets=mesh.boundary()).sharp_edges(mesh.points).ends) == 0
    x = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]])
    valley, ridge = np.array([[1, 0, 3], [0, 1, 2]]), np.array([[0, 1, 3], [1, 0, 2]])
    count = [len(ContactSurface(facets={"tri3": facets}).sharp_edges(x).ends) for facets in (valley, ridge)]
    assert count == [0, 1]


def test_sharp_corners_of_a_rectangle() -> None:
    for cell in ("quad4", "tri6"):
        mesh = rectangle((2.0, 1.0), (3, 2), cell=cell)
        corners = ContactSurface(facets=mesh.boundary()).sharp_corners(mesh.points)
        assert sorted(mesh.points[corners].tolist()) == [[0.0, 0.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]]
    assert len(ContactSurface(facets=disc(1.0, 16).boundary()).sharp_corners(disc(1.0, 16).points)) == 0


@pytest.mark.parametrize(
    ("degrees", "sharp"), [(25.0, False), (29.0, False), (31.0, True), (60.0, True), (120.0, True)]
)
def test_edges_and_corners_are_sharp_from_a_turn_of_30_degrees_on(degrees: float, sharp: bool) -> None:
    """A roof whose second side falls off by an angle; from inside it is a groove, which is not sharp at any angle."""
    angle = np.deg2rad(degrees)
    profile = np.array([[1.0, 0.0], [0.0, 0.0], [-np.cos(angle), -np.sin(angle)]])  # outside is above, facets turn left
    roof = ContactSurface(facets={"bar2": np.array([[0, 1], [1, 2]])})
    groove = ContactSurface(facets={"bar2": np.array([[2, 1], [1, 0]])})
    assert roof.sharp_corners(profile).tolist() == ([1] if sharp else [])
    assert groove.sharp_corners(profile).tolist() == []
    x = np.concatenate([np.insert(profile, 1, y, axis=1) for y in (0.0, 1.0)])
    quads = np.array([[0, 3, 4, 1], [1, 4, 5, 2]])
    outward_ = ContactSurface(facets={"quad4": quads}).sharp_edges(x)
    assert np.sort(outward_.ends, axis=1).tolist() == ([[1, 4]] if sharp else [])
    assert len(ContactSurface(facets={"quad4": quads[:, ::-1]}).sharp_edges(x).ends) == 0
