"""Quadrilaterals and hexahedra on balanced trees: hanging nodes, their parents, and the boundary."""

import numpy as np
import pytest
from adapted import HANGING, adapted, cells_of, some_levels, surface_measure

from softway.meshes.adaptive.nodes.leaf_nodes import node_places, shape_functions
from softway.meshes.adaptive.overlay import embedding
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.cells import CELLS, linear
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

EPS = np.finfo(float).eps


@pytest.fixture(scope="module", params=HANGING)
def found(request: pytest.FixtureRequest) -> AdaptedMesh:
    return adapted(request.param, 3)


def on_leaves(mesh: Mesh, field: np.ndarray) -> np.ndarray:
    """Values (h, k) of a field (n, k) at the hanging nodes, as the larger cell beside has them."""
    assert mesh.hanging is not None
    return np.einsum("hp,hpk->hk", mesh.hanging.weights, field[mesh.hanging.parents])


def test_hanging_nodes_lie_between_parents_that_do_not_hang(found: AdaptedMesh) -> None:
    mesh = found.mesh
    assert mesh.hanging is not None
    assert not np.isin(mesh.hanging.parents, mesh.hanging.node).any()
    size = abs(mesh.points).max()
    assert on_leaves(mesh, mesh.points) == pytest.approx(mesh.points[mesh.hanging.node], abs=8 * EPS * size)
    assert mesh.hanging.following(mesh.points) == pytest.approx(mesh.points, abs=8 * EPS * size)


def test_all_nodes_on_edges_and_faces_of_larger_cells_hang(found: AdaptedMesh) -> None:
    """A node in the closed cell, by the places in the base cell, is a corner of the cell or hangs."""
    mesh, cells = found.mesh, cells_of(found.mesh)
    assert mesh.hanging is not None
    corners = CELLS[linear(found.cell)].nodes
    for root in range(found.base.n_cells):
        own = np.flatnonzero(found.leaves.root == root)
        places = node_places(found.cell, found.place[own]) @ corners
        nodes, points = cells[own].ravel(), places.reshape(-1, corners.shape[1])
        for leaf, place in zip(own, places, strict=True):
            inside = (points >= place.min(axis=0)).all(axis=1) & (points <= place.max(axis=0)).all(axis=1)
            assert np.isin(np.setdiff1d(nodes[inside], cells[leaf]), mesh.hanging.node).all()


def test_neighbours_differ_by_one_cut(found: AdaptedMesh) -> None:
    """Ends of the halves of cut edges: the parents of a hanging node are corners of one leaf, of twice the size."""
    mesh, cells, step = found.mesh, cells_of(found.mesh), found.step
    assert mesh.hanging is not None
    for node, parents in zip(mesh.hanging.node, mesh.hanging.parents, strict=True):
        beside = [set(parents[parents >= 0]) <= set(row) for row in cells]
        coarse = found.leaves.level[beside]
        fine = found.leaves.level[(cells == node).any(axis=1)]
        assert set(fine) == {coarse[0] + step}
        assert set(coarse) == {coarse[0]}


def test_a_field_that_follows_is_continuous(found: AdaptedMesh) -> None:
    """In the uniform mesh of the finest cells every leaf around a node gives the same value."""
    fine = refined(found.base, np.full(found.base.n_cells, found.leaves.level.max()))
    mesh = found.mesh
    assert mesh.hanging is not None
    field = mesh.hanging.following(np.random.default_rng(0).normal(size=(mesh.n_nodes, 1)))
    into = embedding(found, fine)
    at = cells_of(fine.mesh)
    around = found.leaves.around(fine.leaves.start)
    shares = fine.place @ np.linalg.inv(found.place[around])
    values = shape_functions(found.cell, node_places(found.cell, shares))
    every = np.einsum("eca,ea->ec", values, field[cells_of(mesh)[around], 0])
    assert every == pytest.approx((into @ field)[at, 0], abs=1e-13)


@pytest.mark.parametrize("cell", ["quad4", "quad8", "quad9", "hex8", "hex20", "hex27"])
def test_inner_facets_of_two_sizes_are_no_boundary(cell: str) -> None:
    cube = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell) if cell[:3] == "hex" else rectangle((1.0, 1.0), (4, 4), cell=cell)
    found = refined(cube, some_levels(cube.n_cells, 1, 6))
    assert found.mesh.hanging is not None
    assert surface_measure(found.mesh) == pytest.approx(2.0 * cube.dim, rel=1e-13)
    x = found.mesh.points[found.mesh.nodes("surface")]
    assert ((x % 1.0 == 0.0).any(axis=1)).all()


def test_levels_are_rounded_up_to_whole_cuts() -> None:
    for base, levels in ((rectangle((1.0, 1.0), (2, 1)), [4, 2]), (box((1.0, 1.0, 1.0), (2, 1, 1)), [6, 3])):
        wanted = levels[0] - 1
        found = refined(base, np.array([wanted, 1]))
        assert [int(found.leaves.level[found.leaves.root == k].max()) for k in (0, 1)] == levels
        assert refined(base, np.zeros(2, int)).mesh.hanging is None
