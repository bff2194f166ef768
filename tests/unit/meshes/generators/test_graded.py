"""Graded discs, rings and grids: areas, boundaries, quality, sizes of cells, tags."""

from itertools import pairwise

import numpy as np
import pytest

from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.laws.bulk import LinearElastic
from softway.meshes.element import CELLS, element, exact_degree, tabulate
from softway.meshes.generators.graded import geometric, graded_disc, grid, ring
from softway.meshes.generators.recipes import GradedDisc, Grid, Ring
from softway.meshes.generators.shapes import KINDS
from softway.meshes.mesh import Mesh
from softway.scenario.files import dumps, loads
from softway.scenario.scenario import Scenario, Time

PARTS = {"whole": 1.0, "lower": 0.5, "right": 0.5, "quarter": 0.25}
"""Share of the disc."""
SQUARES = ("quad4", "quad8", "quad9")


def area(mesh: Mesh) -> float:
    """By quadrature that is exact for the given nodes."""
    total = 0.0
    for name, cells in mesh.blocks.items():
        table = element(name, exact_degree(name, curved=True))
        jacobian = np.einsum("eai,qar->eqir", mesh.points[cells], table.dN)
        total += float((np.linalg.det(jacobian) @ table.weights).sum())
    return total


def quality(mesh: Mesh) -> tuple[float, float]:
    """Least sine of an angle between the sides of a cell, and greatest ratio of their lengths, at the nodes."""
    ((name, cells),) = mesh.blocks.items()
    jacobian = np.einsum("eai,qar->eqir", mesh.points[cells], tabulate(name, CELLS[name].nodes)[1])
    lengths = np.linalg.norm(jacobian, axis=-2)
    return float((np.linalg.det(jacobian) / lengths.prod(axis=-1)).min()), float(
        (lengths.max(-1) / lengths.min(-1)).max()
    )


@pytest.mark.parametrize("cell", SQUARES)
@pytest.mark.parametrize("part", PARTS)
def test_area_and_boundary_of_a_graded_disc(part: str, cell: str) -> None:
    """Chords miss the area by h^2, parabolas by h^4; no node but those of the outline is on the boundary."""
    errors = []
    for cells in (4, 8):
        mesh = graded_disc(2.0, 0.2, cells, part=part, centre=(1.0, 3.0), cell=cell)  # type: ignore[arg-type]
        errors.append(abs(area(mesh) / (4.0 * np.pi * PARTS[part]) - 1.0))
        boundary = np.unique(np.concatenate([f.ravel() for f in mesh.boundary().values()]))
        x, y = (mesh.points - (1.0, 3.0)).T
        outline = np.abs(np.hypot(x, y) - 2.0) < 1e-12
        outline |= (part in ("lower", "quarter")) & (y == 0.0)
        outline |= (part in ("right", "quarter")) & (x == 0.0)
        assert boundary.tolist() == np.flatnonzero(outline).tolist()
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0 * CELLS[cell].order, abs=0.35)


@pytest.mark.parametrize("cell", SQUARES)
@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("focus", [1e-4, 0.1, 1.0])
def test_cells_of_a_graded_disc_are_nearly_square(focus: float, part: str, cell: str) -> None:
    sine, ratio = quality(graded_disc(1.0, focus, 6, part=part, cell=cell))  # type: ignore[arg-type]
    assert sine > 0.6
    assert ratio < 1.7


@pytest.mark.parametrize("cells", [2, 3, 16])
def test_the_fine_part_has_equal_cells(cells: int) -> None:
    mesh = graded_disc(1.0, 0.1, cells, part="quarter")
    x, y = mesh.points[mesh.nodes("focus")].T
    arc = np.sort(np.arctan2(x, -y))
    assert len(arc) == cells + 1
    assert arc[-1] == pytest.approx(0.1, rel=1e-12)
    assert np.diff(arc) == pytest.approx(0.1 / cells, rel=3e-3)


def test_cells_grow_in_proportion_to_the_distance() -> None:
    """Along the axis the spacing is proportional to the distance, until the map bends it at the size of the disc."""
    mesh = graded_disc(1.0, 1e-4, 8, part="quarter")
    height = np.sort(mesh.points[mesh.nodes("axis"), 1]) + 1.0
    ratio = np.diff(height) / (0.5 * (height[1:] + height[:-1]))
    away = (height[1:] > 3e-4) & (height[1:] < 0.1)
    assert np.ptp(ratio[away]) < 0.12 * ratio[away].mean()
    assert ratio[away].mean() == pytest.approx(np.pi / 32, rel=0.1)


@pytest.mark.parametrize("part", ["whole", "lower"])
def test_a_graded_disc_is_its_mirror_image(part: str) -> None:
    mesh = graded_disc(1.0, 0.2, 4, part=part, cell="quad9")  # type: ignore[arg-type]
    points = {tuple(p) for p in (mesh.points + 0.0).tolist()}
    assert points == {tuple(p) for p in (mesh.points * (-1.0, 1.0) + 0.0).tolist()}


def test_tags_of_a_graded_disc() -> None:
    half = graded_disc(1.0, 0.2, 4, part="right")
    assert half.points[half.nodes("bottom")].tolist() == [[0.0, -1.0]]
    assert half.points[half.nodes("centre")].tolist() == [[0.0, 0.0]]
    assert (half.points[half.nodes("axis"), 0] == 0.0).all()
    assert np.abs(np.linalg.norm(half.points[half.nodes("boundary")], axis=1) - 1.0).max() < 1e-15
    assert set(half.nodes("focus")) < set(half.nodes("boundary"))
    assert "diameter" not in half.tags
    quarter = graded_disc(1.0, 0.2, 4, part="quarter")
    assert (quarter.points[quarter.nodes("diameter"), 1] == 0.0).all()
    assert set(graded_disc(1.0, 0.2, 4).tags) == {"boundary", "focus", "bottom", "centre"}


@pytest.mark.parametrize("cell", KINDS[2])
@pytest.mark.parametrize("angle", [0.5 * np.pi, 2.0 * np.pi])
def test_area_and_sides_of_a_ring(angle: float, cell: str) -> None:
    errors = []
    for n in (8, 16):
        mesh = ring(1.0, 2.0, (2, n), angle=angle, start=0.3, centre=(5.0, 6.0), cell=cell)
        errors.append(abs(area(mesh) / (1.5 * angle) - 1.0))
        radius = np.linalg.norm(mesh.points - (5.0, 6.0), axis=1)
        assert np.abs(radius[mesh.nodes("inner")] - 1.0).max() < 1e-14
        assert np.abs(radius[mesh.nodes("outer")] - 2.0).max() < 1e-14
        sides = [set(nodes.tolist()) for nodes in mesh.tags.values()]
        boundary = {int(i) for f in mesh.boundary().values() for i in f.ravel()}
        assert set.union(*sides) == boundary
        assert len(mesh.tags) == (4 if angle < 6.0 else 2)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0 * CELLS[cell].order, abs=0.35)


def test_a_closed_ring_has_no_seam() -> None:
    mesh = ring(1.0, 2.0, (2, 12))
    assert mesh.n_nodes == 3 * 12
    assert len(np.unique(mesh.points.round(12), axis=0)) == mesh.n_nodes
    assert len(mesh.facets_on("inner")["bar2"]) == len(mesh.facets_on("outer")["bar2"]) == 12


def test_grids() -> None:
    x, y, z = (0.0, 0.3, 1.0), (-1.0, 0.0, 0.1, 2.0), (0.0, 5.0)
    for cell in KINDS[2]:
        flat = grid(x, y, cell=cell)
        assert area(flat) == pytest.approx(3.0, rel=1e-14)
        assert set(np.unique(flat.points[:, 1])) >= set(y)
        assert flat.points[flat.nodes("right"), 0].tolist() == [1.0] * len(flat.nodes("right"))
    solid = grid(x, y, z)
    assert (solid.n_cells, solid.n_nodes, solid.dim) == (6, 24, 3)
    assert solid.points[solid.nodes("top"), 2].tolist() == [5.0] * 12
    middles = grid(x, y, cell="quad9").points[:5, 0]
    assert middles == pytest.approx([0.0, 0.15, 0.3, 0.65, 1.0], rel=1e-14)


def test_geometric_spacing() -> None:
    places = geometric(1.0, 3.0, 5, 16.0)
    sizes = np.diff(places)
    assert (places[0], places[-1]) == (1.0, 3.0)
    assert sizes[-1] / sizes[0] == pytest.approx(16.0)
    assert [b / a for a, b in pairwise(sizes.tolist())] == pytest.approx([2.0] * 4)
    assert geometric(0.0, 1.0, 1, 3.0) == (0.0, 1.0)


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: graded_disc(-1.0, 0.1, 4), "radius"),
        (lambda: graded_disc(1.0, 1.1, 4), "focus"),
        (lambda: graded_disc(1.0, 0.1, 1), "cells"),
        (lambda: graded_disc(1.0, 0.1, 4, part="left"), "part"),  # type: ignore[arg-type]
        (lambda: graded_disc(1.0, 0.1, 4, cell="tri3"), "cell"),
        (lambda: graded_disc(1.0, 0.1, 4, centre=(0.0, 0.0, 0.0)), "centre"),
        (lambda: ring(2.0, 1.0, (1, 8)), "inner"),
        (lambda: ring(1.0, 2.0, (1, 2)), "cells"),
        (lambda: ring(1.0, 2.0, (0, 8)), "cells"),
        (lambda: ring(1.0, 2.0, (1, 8), angle=7.0), "angle"),
        (lambda: ring(1.0, 2.0, (1, 8), cell="hex8"), "cell"),
        (lambda: grid((0.0, 1.0)), "x"),
        (lambda: grid((0.0, 1.0), (0.0, 0.0, 1.0)), "y"),
        (lambda: geometric(0.0, 1.0, 0, 2.0), "cells"),
    ],
)
def test_what_cannot_be_built_is_refused(make, where: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.where == where


RECIPES = (
    Grid(x=(0.0, 0.3, 1.0), y=(0.0, 0.5), cell="tri6"),
    Grid(x=(0.0, 1.0), y=(0.0, 0.5), z=(0.0, 0.1, 1.0)),
    Ring(inner=1.0, outer=2.0, cells=(2, 8), angle=1.5, start=0.1, centre=(1.0, 1.0)),
    GradedDisc(radius=1.0, focus=0.1, cells=3, part="right", cell="quad9"),
)


def test_recipes_build_and_are_written_and_read() -> None:
    *others, disc = (recipe.build() for recipe in RECIPES)
    assert [mesh.n_nodes for mesh in others] == [15, 12, 27]
    assert np.array_equal(disc.points, graded_disc(1.0, 0.1, 3, part="right", cell="quad9").points)
    material = LinearElastic(E=1.0)
    bodies = {f"b{k}": Solid(mesh=recipe, material=material, density=1.0) for k, recipe in enumerate(RECIPES)}
    scenario = Scenario(title="", bodies=bodies, time=Time(end=1.0))
    assert loads(dumps(scenario)) == scenario
