"""Distance of facets from the smooth surface: circles, cylinders, flat and sharp surfaces, and where two meet."""

import numpy as np
import pytest

from softway.arrays import Array
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.sagitta import misfit, nodal_curvature
from softway.meshes.generators.graded import ring
from softway.meshes.generators.shapes import KINDS, ball, box, rectangle
from softway.meshes.mesh import Mesh


def surface(mesh: Mesh, tag: str = "surface") -> ContactSurface:
    """Facets of a tag."""
    return ContactSurface(facets=mesh.facets_on(tag))


def middles(mesh: Mesh, tag: str) -> Array:
    """Distance (f,) of the facets from the smooth surface in the middle of the first edge of each facet."""
    side = surface(mesh, tag)
    made = nodal_curvature(side, mesh.points)
    ends = np.concatenate([f[:, :2] for f in side.facets.values()])
    corners = np.unique(np.concatenate([f[:, : 2 if mesh.dim == 2 else 4] for f in side.facets.values()]))
    half = 0.5 * (mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]])
    return made.off(np.searchsorted(corners, ends[:, 0]), half)


@pytest.mark.parametrize("cells", [16, 40, 100])
@pytest.mark.parametrize("tag", ["inner", "outer"])
def test_facets_on_a_circle_stand_off_by_their_sagitta(cells: int, tag: str) -> None:
    mesh = ring(1.0, 2.0, cells=(2, cells), angle=2.0 * np.pi)
    exact = {"inner": 1.0, "outer": 2.0}[tag] * (1.0 - np.cos(np.pi / cells))
    assert middles(mesh, tag) == pytest.approx(exact, rel=6e-2)


def test_quadratic_facets_do_not_stand_off() -> None:
    mesh = ring(1.0, 2.0, cells=(2, 40), angle=2.0 * np.pi, cell="quad9")
    assert (middles(mesh, "outer") == 0.0).all()


def tube(around: int, along: int, radius: float, thick: float) -> Mesh:
    """Quarter of a tube of unit length about z, with its inner surface at ``radius``."""
    mesh = box((thick, 0.5 * np.pi, 1.0), (2, around, along))
    r, turn, z = mesh.points.T
    points = np.column_stack([(radius + r) * np.cos(turn), (radius + r) * np.sin(turn), z])
    return Mesh(points=points, blocks=mesh.blocks, tags=mesh.tags)


@pytest.mark.parametrize("along", [1, 3, 20])
def test_cylinder_is_curved_around_and_straight_along_its_axis(along: int) -> None:
    mesh = tube(12, along, 1.0, 0.2)
    side = surface(mesh, "right")
    made = nodal_curvature(side, mesh.points)
    inner = np.flatnonzero((made.points[:, :2] > 0.3).all(axis=1))
    axis = np.tile([0.0, 0.0, 1.0], (len(inner), 1))
    around = np.cross(axis, made.normal[inner])
    edge = 2.0 * 1.2 * np.sin(np.pi / 48)
    sagitta = 1.2 * (1.0 - np.cos(np.pi / 48))
    assert made.off(inner, 0.5 / along * axis) == pytest.approx(0.0, abs=1e-9)
    assert made.off(inner, 0.5 * edge * around) == pytest.approx(sagitta, rel=1e-2)


@pytest.mark.parametrize("cell", [*KINDS[2], *KINDS[3]])
def test_flat_faces_and_sharp_edges_have_no_sagitta(cell: str) -> None:
    flat = rectangle((1.0, 2.0), (3, 4), cell=cell) if cell in KINDS[2] else box((1.0, 2.0, 1.0), (3, 4, 2), cell=cell)
    made = nodal_curvature(surface(flat), flat.points)
    assert np.abs(made.curvature).max() == 0.0


def test_sphere_has_the_same_curvature_in_all_directions() -> None:
    mesh = ball(1.0, 16)
    made = nodal_curvature(surface(mesh), mesh.points)
    trace = np.trace(made.curvature, axis1=1, axis2=2)
    assert np.median(trace) == pytest.approx(2.0, rel=0.05)


def pair(facets: tuple[int, int], gap: float, cell: str = "quad4") -> tuple[Mesh, Mesh]:
    """Quarter rings around each other."""
    inner = ring(0.01, 0.02 - gap, cells=(4, facets[0]), angle=0.5 * np.pi, cell=cell)
    return inner, ring(0.02, 0.04, cells=(4, facets[1]), angle=0.5 * np.pi, cell=cell)


@pytest.mark.parametrize("gap", [-1e-5, 1e-5])
def test_facets_that_do_not_match_stand_off_by_the_greater_sagitta(gap: float) -> None:
    inner, outer = pair((40, 32), gap)
    found = misfit(
        nodal_curvature(surface(inner, "outer"), inner.points),
        nodal_curvature(surface(outer, "inner"), outer.points),
        fit=gap < 0.0,
    )
    assert found is not None
    assert found.off == pytest.approx(0.02 * (1.0 - np.cos(np.pi / 128)), rel=0.06)
    assert found.gap == pytest.approx(gap, rel=0.06)


def test_facets_that_match_meet_without_misfit() -> None:
    inner, outer = pair((32, 32), -1e-5)
    sides = [nodal_curvature(surface(m, tag), m.points) for m, tag in ((inner, "outer"), (outer, "inner"))]
    found = misfit(sides[0], sides[1], fit=True)
    assert found is not None and found.off < 1e-3 * 6e-6 and found.gap == pytest.approx(-1e-5, rel=1e-3)


def test_tubes_with_other_cells_along_the_axis_only_meet_without_misfit() -> None:
    inner, outer = tube(12, 3, 0.8, 0.2002), tube(12, 5, 1.0, 0.5)
    sides = [nodal_curvature(surface(m, tag), m.points) for m, tag in ((inner, "right"), (outer, "left"))]
    found = misfit(sides[0], sides[1], fit=True)
    assert found is not None and found.off < 1e-6 and found.gap == pytest.approx(-2e-4, rel=0.1)
    other = tube(17, 5, 1.0, 0.5)
    found = misfit(sides[0], nodal_curvature(surface(other, "left"), other.points), fit=True)
    assert found is not None and found.off == pytest.approx(1.0 - np.cos(np.pi / 48), rel=0.1)


def test_ball_on_a_plane_does_not_conform() -> None:
    disc = ring(0.1, 1.0, cells=(4, 60), angle=2.0 * np.pi)
    floor = rectangle((4.0, 1.0), (30, 4))
    floor = Mesh(points=floor.points + np.array([-2.0, -2.0]), blocks=floor.blocks, tags=floor.tags)
    sides = [nodal_curvature(surface(m, tag), m.points) for m, tag in ((disc, "outer"), (floor, "top"))]
    assert misfit(sides[0], sides[1], fit=False) is None
