"""The indicator tends to the error, finds fronts, and the buffer surrounds what it has found."""

import numpy as np
import pytest
from turning import NONE, on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import adapted_solid
from softway.adaptivity.marking.indicator import indicator, wanted_levels
from softway.adaptivity.marking.neighbourhood import grown_near, marks_of
from softway.adaptivity.transfer import Motion
from softway.meshes.adaptive.refinement import adapted_mesh, refined
from softway.meshes.adaptive.tree import tree_of
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh


def test_the_indicator_tends_to_the_error() -> None:
    ratios = []
    for cells in (16, 64):
        on = on_levels(solid(interval(1.0, cells=cells), sw.LinearElastic(E=4.0, nu=0.0)), np.zeros(cells))
        x, h = on.points[:, 0], 1.0 / cells
        found = indicator(on, Motion(displacement=np.sin(3.0 * x)[:, None], velocity=np.zeros((cells + 1, 1))))
        middle = 0.5 * (x[1:] + x[:-1])
        exact = 4.0 * 81.0 * np.sin(3.0 * middle) ** 2 * h**3 / 12.0  # integral of E (u' - u_h')^2, to first order
        inner = slice(1, -1)  # nothing is recovered at an end
        ratios.append(np.sqrt((found[inner] ** 2).sum() / exact[inner].sum()))
    assert abs(np.array(ratios) - 1.0).tolist() == pytest.approx([0.0, 0.0], abs=0.02)
    assert abs(ratios[1] - 1.0) < abs(ratios[0] - 1.0)


@pytest.mark.parametrize(
    "mesh",
    [
        interval(1.0, cells=8),
        interval(1.0, cells=8, cell="bar3"),
        rectangle((1.0, 1.0), (4, 4), cell="tri3"),
        rectangle((1.0, 1.0), (4, 4), cell="tri6"),
        box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"),
    ],
    ids=lambda mesh: next(iter(mesh.blocks)),
)
def test_uniform_strain_and_rate_have_none(mesh: Mesh) -> None:
    on = on_levels(solid(mesh), np.arange(mesh.n_cells) % 3)
    gradient = 0.01 * np.arange(1.0, 1.0 + mesh.dim**2).reshape(mesh.dim, mesh.dim)
    found = indicator(on, Motion(displacement=on.points @ gradient, velocity=on.points @ gradient.T))
    assert found == pytest.approx(np.zeros(len(found)), abs=1e-14)


def test_a_front_is_found_in_stress_and_in_rate() -> None:
    on = on_levels(solid(rectangle((1.0, 0.5), (8, 4), cell="tri3")), np.full(64, 2))
    front = np.maximum(on.points[:, :1] - 0.5, 0.0) * np.array([1.0, 0.0])
    still = np.zeros(on.points.shape)
    centre = on.adapted.mesh.centres()[:, 0]
    for motion in (Motion(displacement=front, velocity=still), Motion(displacement=still, velocity=front)):
        found = indicator(on, motion)
        assert (found[abs(centre - 0.5) > 0.13] < 1e-14).all()
        assert (found[abs(centre - 0.5) < 0.05] > 0.0).all()


def test_another_material_is_no_front() -> None:
    mesh = interval(1.0, cells=8).with_region("a", lambda x: x[:, 0] < 0.5).with_region("b", lambda x: x[:, 0] > 0.5)
    body = sw.Solid(
        mesh=mesh, material={"a": sw.LinearElastic(E=1.0), "b": sw.LinearElastic(E=2.0)}, density={"a": 1.0, "b": 3.0}
    )
    on = adapted_solid("body", body, refined(mesh, np.zeros(8, dtype=int)), NONE)
    found = indicator(on, Motion(displacement=0.1 * on.points, velocity=0.0 * on.points))
    assert found == pytest.approx(np.zeros(8), abs=1e-15)


def test_wishes_do_not_pass_the_limits() -> None:
    found = refined(interval(1.0, cells=2), np.array([5, 0]))
    level = wanted_levels(found, np.full(found.mesh.n_cells, 9.0), 1.0, 6)
    assert level.max() == 6
    assert wanted_levels(found, np.zeros(found.mesh.n_cells), 1.0, 6).min() == 0


@pytest.mark.parametrize(("dim", "reach"), [(1, 0.05), (1, 0.3), (2, 0.1), (3, 0.2)])
def test_the_buffer_is_as_fine_within_its_reach(dim: int, reach: float) -> None:
    mesh = {
        1: interval(1.0, cells=4),
        2: rectangle((1.0, 1.0), (4, 4), cell="tri3"),
        3: box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"),
    }[dim]
    sharp = refined(mesh, np.where(np.arange(mesh.n_cells) == 1, 4, 0))
    tree = tree_of(mesh).grown(sharp.leaves, sharp.leaves.level)
    found = adapted_mesh(grown_near(tree, marks_of(tree), reach))
    for level in np.unique(sharp.leaves.level):
        cells = next(iter(sharp.mesh.blocks.values()))[sharp.leaves.level >= level]
        source = sharp.mesh.points[np.unique(cells)]
        rows = next(iter(found.mesh.blocks.values()))
        corners = found.mesh.points[rows]
        apart = np.linalg.norm(corners[:, :, None] - source, axis=3).min(axis=(1, 2))
        assert (found.leaves.level[apart < reach] >= level).all()
    assert len(grown_near(tree, marks_of(tree), 0.0).leaves.level) < found.mesh.n_cells
