"""Refined meshes follow a smooth surface through the boundary nodes of their base mesh."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, Section, Volume
from softway.bodies.inertia.mass_matrix import Consistent, nodal_mass
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.adaptive.rounded.volumes import cell_moments
from softway.meshes.adaptive.surfaces.surface import ROUND, rounded
from softway.meshes.adaptive.values_at_nodes import values_at_nodes
from softway.meshes.generators.graded import ring
from softway.meshes.generators.shapes import ball, box, cylinder, disc, rectangle
from softway.meshes.mesh import Mesh

ROUNDING = 1e-12
ELLIPSE = (1.0, 0.6)
SHAPES = {
    "tri3": (disc(1.0, 4, cell="tri3"), np.pi, 2e-8),
    "quad4": (disc(1.0, 4, cell="quad4"), np.pi, 1e-6),
    "tet4": (ball(1.0, 4, cell="tet4"), 4.0 / 3.0 * np.pi, 1e-4),
    "hex8": (ball(1.0, 4, cell="hex8"), 4.0 / 3.0 * np.pi, 1e-4),
    "ring": (ring(1.0, 2.0, (2, 16)), 3.0 * np.pi, 2e-8),
    "cylinder": (cylinder(1.0, 0.5, (4, 1), cell="hex8"), 0.5 * np.pi, 1e-6),
    "coin": (cylinder(1.0, 0.5, (4, 1), cell="tet4"), 0.5 * np.pi, 2e-4),
}


def section(mesh: Mesh) -> Section:
    return PlaneStrain() if mesh.dim == 2 else Volume()


def uniform(base: Mesh, halvings: int) -> AdaptedMesh:
    return refined(base, np.full(base.n_cells, halvings * base.dim))


def volume(mesh: Mesh) -> float:
    ((name, cells),) = mesh.blocks.items()
    return float(cell_moments(mesh.points[cells], name)[:, 0, 0].sum())


@pytest.mark.parametrize("name", list(SHAPES))
def test_volumes_tend_to_those_of_the_shape(name: str) -> None:
    mesh, exact, close = SHAPES[name]
    base = rounded(mesh, ROUND)
    errors = [exact - volume(uniform(base, k).mesh) for k in range(4 if mesh.dim == 2 else 3)]
    assert 3.5 < errors[-2] / errors[-1] < 4.1
    for k in (0, 1, 2):
        fine = uniform(base, k).mesh
        assert nodal_mass(fine, 1.0, section(mesh), Consistent()).sum() == pytest.approx(exact, rel=close)


@pytest.mark.parametrize("name", ["tri3", "quad4", "tet4", "cylinder", "coin"])
def test_new_nodes_lie_on_circles_spheres_and_cylinders(name: str) -> None:
    fine = uniform(rounded(SHAPES[name][0], ROUND), 2).mesh
    tag = "side" if name in ("cylinder", "coin") else "surface"
    points = fine.points[fine.nodes(tag)]
    radius = np.linalg.norm(points[:, :2] if tag == "side" else points, axis=1)
    assert len(radius) >= 32
    assert radius == pytest.approx(np.ones(len(radius)), abs=1e-12)


def test_nodes_in_the_middle_of_squares_are_nearly_on_a_sphere() -> None:
    errors = []
    for cells in (4, 8):
        fine = uniform(rounded(ball(1.0, cells), ROUND), 1).mesh
        errors.append(np.abs(np.linalg.norm(fine.points[fine.nodes("surface")], axis=1) - 1.0).max())
    assert errors[0] < 2e-5
    assert errors[0] / errors[1] > 15.0


@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_an_ellipse_without_a_formula(cell: str) -> None:
    def errors(cells: int) -> float:
        circle = disc(1.0, cells, cell=cell)
        fine = uniform(rounded(Mesh(points=circle.points * ELLIPSE, blocks=circle.blocks), ROUND), 2).mesh
        away = np.linalg.norm(fine.points[fine.nodes("surface")] / ELLIPSE, axis=1) - 1.0
        return float(np.abs(away).max())

    assert errors(16) < errors(8) / 7.0  # third order or better; facets are of second


def test_corners_and_flat_facets_stay() -> None:
    for mesh in (
        rectangle((1.0, 2.0), (2, 3)),
        box((1.0, 1.0, 1.0), (2, 1, 1), cell="tet4"),
        disc(1.0, 2, cell="tri3"),
    ):
        assert rounded(mesh) is mesh
    half = ring(1.0, 2.0, (2, 8), angle=np.pi)
    fine = uniform(rounded(half), 2).mesh
    assert fine.points[:, 1].min() == pytest.approx(0.0, abs=1e-15)
    radius = np.linalg.norm(fine.points[fine.nodes("outer")], axis=1)
    assert radius == pytest.approx(np.full(len(radius), 2.0), abs=1e-12)


def test_a_curve_that_would_squeeze_thin_cells_is_left_out() -> None:
    thin, thick = ring(1.0, 1.02, (2, 16)), ring(1.0, 1.5, (2, 16))
    assert rounded(thin) is thin
    assert rounded(thick).rounding is not None


@pytest.mark.parametrize("name", list(SHAPES))
def test_mass_and_centre_do_not_depend_on_the_cells(name: str) -> None:
    mesh = SHAPES[name][0]
    base, rng = rounded(mesh, ROUND), np.random.default_rng(1)
    found = []
    for _ in range(3):
        fine = refined(base, rng.integers(0, 2 + mesh.dim, mesh.n_cells)).mesh
        mass = nodal_mass(fine, 1.0, section(mesh), Consistent())
        found.append([float(mass.sum()), *(mass @ fine.points).sum(axis=0)])
    assert np.array(found[1:]) == pytest.approx(np.array([found[0]] * 2), abs=ROUNDING)


def test_a_body_of_revolution_keeps_its_mass() -> None:
    half = refined(rounded(ring(0.5, 1.0, (2, 8), start=-0.5 * np.pi, angle=np.pi), radial=True), np.zeros(16, int))
    some = refined(half.base, np.arange(16) % 5)
    masses = [float(nodal_mass(m.mesh, 1.0, Axisymmetric(), Consistent()).sum()) for m in (half, some)]
    assert masses[1] == pytest.approx(masses[0], rel=ROUNDING)
    assert masses[0] == pytest.approx(4.0 / 3.0 * np.pi * (1.0 - 0.125), rel=1e-5)


@pytest.mark.parametrize("name", list(SHAPES))
def test_affine_fields_pass_exactly(name: str) -> None:
    mesh = SHAPES[name][0]
    base, rng = rounded(mesh, ROUND), np.random.default_rng(2)
    one, other = (refined(base, rng.integers(0, 2 + 2 * mesh.dim, mesh.n_cells)) for _ in range(2))
    found = values_at_nodes(one, other)
    gradient = rng.random((mesh.dim, mesh.dim))

    def field(points: Array) -> Array:
        return 0.3 + points @ gradient

    assert found.forward @ field(one.mesh.points) == pytest.approx(field(other.mesh.points), abs=ROUNDING)
    assert found.back @ field(other.mesh.points) == pytest.approx(field(one.mesh.points), abs=ROUNDING)


def test_the_angle_of_corners_is_checked() -> None:
    with pytest.raises(sw.InputError, match="less than 90 degrees"):
        sw.meshes.Adapt(smooth=2.0)
