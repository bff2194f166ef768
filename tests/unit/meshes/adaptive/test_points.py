"""A place of a body in its adapted meshes: the nodes around it and their shape functions."""

import numpy as np
import pytest
from adapted import BASES, adapted, cells_of

from softway.meshes.adaptive.overlay import embedding
from softway.meshes.adaptive.points import around
from softway.meshes.adaptive.refinement import refined
from softway.meshes.cells import CELLS
from softway.meshes.generators.shapes import interval


def places_inside(base, count=6):
    """Places (k, d) at random combinations of the corners of cells, which are inside of a convex body."""
    rng = np.random.default_rng(3)
    cells = cells_of(base)[rng.integers(0, base.n_cells, count)]
    corners = base.points[cells[:, : CELLS[next(iter(base.blocks))].corners]]
    return np.einsum("kc,kcd->kd", rng.dirichlet(np.full(corners.shape[1], 3.0), count), corners)


@pytest.mark.parametrize("name", BASES)
def test_shape_functions_give_the_place(name):
    found = adapted(name, 5)
    for point in places_inside(found.base):
        nodes, weights = around(found, point)
        assert weights.sum() == pytest.approx(1.0, abs=1e-13)
        np.testing.assert_allclose(weights @ found.mesh.points[nodes], point, atol=1e-12)


@pytest.mark.parametrize("name", BASES)
def test_a_field_has_the_same_value_on_a_refined_mesh(name):
    """Values have no jump where a mesh is refined."""
    coarse = refined(BASES[name](), np.zeros(BASES[name]().n_cells, int))
    fine = adapted(name, 7)
    field = np.random.default_rng(1).standard_normal(coarse.mesh.n_nodes)
    finer = embedding(coarse, fine) @ field
    for point in places_inside(coarse.base):
        values = [
            w @ values[nodes] for mesh, values in ((coarse, field), (fine, finer)) for nodes, w in [around(mesh, point)]
        ]
        assert values[0] == pytest.approx(values[1], abs=1e-11)


@pytest.mark.parametrize("name", BASES)
def test_a_node_of_the_base_mesh_is_itself(name):
    found = adapted(name, 2)
    for node in (0, found.base.n_nodes - 1):
        nodes, weights = around(found, found.base.points[node])
        assert nodes.tolist() == [node] and weights.tolist() == [1.0]


def test_a_place_outside_is_the_nearest_one_inside():
    nodes, weights = around(refined(interval(1.0, cells=2), np.array([1, 1])), np.array([1.4]))
    assert nodes[np.argmax(weights)] == 2 and weights.max() == pytest.approx(1.0)
