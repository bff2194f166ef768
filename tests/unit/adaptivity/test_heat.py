"""Heat between adapted meshes: contents to rounding, ranges, entropies; exact where cells are only refined."""

import numpy as np
import pytest
from turning import on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.heat import Heated, carried_heat
from softway.adaptivity.projections.projection import projection
from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric
from softway.bodies.inertia.nodal_heat import cell_heat_masses, heat_masses
from softway.meshes.generators.shapes import box, disc, interval, rectangle
from softway.meshes.mesh import Mesh

MESHES = {
    "line2": interval(1.0, cells=6),
    "tri3": rectangle((1.0, 1.0), (3, 3), cell="tri3"),
    "tri6": disc(0.5, 4, cell="tri6"),
    "tet4": box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"),
}


def heated(on: AdaptedSolid) -> Heated:
    return Heated(adapted=on.adapted, shares=cell_heat_masses(on.adapted.mesh, on.part.internal.section, 3.0))


def capacities(on: AdaptedSolid) -> Array:
    return heat_masses(on.adapted.mesh, on.part.internal.section, 3.0)


def passed(before: AdaptedSolid, after: AdaptedSolid, values: Array) -> Array:
    at_nodes = projection(before, after).at_nodes  # type: ignore[union-attr]
    return carried_heat(heated(before), heated(after), at_nodes, values, np.log)


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
def test_contents_ranges_and_entropies(mesh: Mesh) -> None:
    rng, body = np.random.default_rng(3), solid(mesh)
    for _ in range(4):
        before, after = (on_levels(body, rng.integers(0, 4, mesh.n_cells)) for _ in range(2))
        values = 1.0 + rng.uniform(size=len(before.points)) + 2.0 * before.points[:, 0] ** 2
        found = passed(before, after, values)
        one, other = capacities(before), capacities(after)
        assert other @ found == pytest.approx(one @ values, rel=1e-13)
        assert values.min() - 1e-12 <= found.min()
        assert found.max() <= values.max() + 1e-12
        assert other @ np.log(found) >= one @ np.log(values) - 1e-12 * one.sum()


@pytest.mark.parametrize("name", ["line2", "tri3", "tet4"])
def test_refined_cells_interpolate(name: str) -> None:
    body = solid(MESHES[name])
    before, after = (on_levels(body, np.full(body.mesh.n_cells, level)) for level in (1, 3))
    values = np.random.default_rng(1).uniform(1.0, 2.0, len(before.points))
    at_nodes = projection(before, after).at_nodes  # type: ignore[union-attr]
    assert passed(before, after, values) == pytest.approx(at_nodes @ values, rel=1e-13)


def test_cells_that_stay_keep_their_temperatures() -> None:
    body = solid(MESHES["tri3"])
    levels = np.where(MESHES["tri3"].centres()[:, 0] < 0.5, 2, 3)
    before, after = on_levels(body, np.full(18, 2)), on_levels(body, levels)
    values = np.random.default_rng(1).uniform(1.0, 2.0, len(before.points))
    found = passed(before, after, values)
    for k, place in enumerate(after.points):
        if place[0] < 0.3:
            (same,) = np.flatnonzero((np.abs(before.points - place) < 1e-12).all(axis=1))
            assert found[k] == pytest.approx(values[same], rel=1e-14)


def test_a_linear_temperature_stays_inside_where_cells_grow() -> None:
    body = solid(interval(1.0, cells=8))
    before, after = (on_levels(body, np.full(8, level)) for level in (2, 1))
    found = passed(before, after, 300.0 + before.points[:, 0])
    inside = (after.points[:, 0] > 0.0) & (after.points[:, 0] < 1.0)
    assert found[inside] == pytest.approx(300.0 + after.points[inside, 0], rel=1e-9)


@pytest.mark.parametrize("cell", ["tri3", "tri6"])
def test_shares_of_the_cells_are_the_masses_of_the_nodes(cell: str) -> None:
    mesh = rectangle((1.0, 1.0), (3, 3), cell=cell)
    found, nodes = np.zeros(mesh.n_nodes), next(iter(mesh.blocks.values()))
    np.add.at(found, nodes, cell_heat_masses(mesh, Axisymmetric(), 2.0))
    assert found == pytest.approx(heat_masses(mesh, Axisymmetric(), 2.0), rel=1e-13)


def test_masses_depend_on_the_density_of_the_cell() -> None:
    bar = sw.meshes.Interval(length=2.0, cells=2).build()
    assert cell_heat_masses(bar, sw.bodies.Bar(), np.array([1.0, 3.0])).tolist() == [[0.5, 0.5], [1.5, 1.5]]
