"""Common matrices and embeddings of two adapted meshes are exact to rounding."""

import numpy as np
import pytest
import scipy.sparse as sp
from adapted import BASES, adapted, cells_of, follow, masses

from softway.errors import InputError
from softway.meshes.adaptive.leaves import same
from softway.meshes.adaptive.overlay import common_matrix, embedding, overlay, united
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.generators.shapes import interval

EPS = np.finfo(float).eps


def mass(found: AdaptedMesh) -> sp.csr_array:
    cells, values = cells_of(found.mesh), masses(found.mesh)
    a = cells.shape[1]
    places = np.repeat(cells, a, axis=1).ravel(), np.tile(cells, (1, a)).ravel()
    return sp.csr_array((values.ravel(), places), shape=(found.mesh.n_nodes,) * 2)


@pytest.fixture(scope="module", params=BASES)
def two(request: pytest.FixtureRequest) -> tuple[AdaptedMesh, AdaptedMesh]:
    return adapted(request.param, 3), adapted(request.param, 4)


def test_the_common_matrix_keeps_mass_and_first_moments(two: tuple[AdaptedMesh, AdaptedMesh]) -> None:
    one, other = two
    found = overlay(one, other)
    common = common_matrix(found, masses(one.mesh), masses(other.mesh))
    own, others = mass(one), mass(other)
    scale = own.sum() * 64 * EPS
    assert common @ np.ones(other.mesh.n_nodes) == pytest.approx(own @ np.ones(one.mesh.n_nodes), abs=scale)
    assert common.T @ np.ones(one.mesh.n_nodes) == pytest.approx(others @ np.ones(other.mesh.n_nodes), abs=scale)
    assert common @ other.mesh.points == pytest.approx(own @ one.mesh.points, abs=scale)
    assert common.T @ one.mesh.points == pytest.approx(others @ other.mesh.points, abs=scale)


def test_a_mesh_with_itself(two: tuple[AdaptedMesh, AdaptedMesh]) -> None:
    one = two[0]
    common = common_matrix(overlay(one, one), masses(one.mesh), masses(one.mesh))
    assert abs(common - mass(one)).max() <= 8 * EPS * abs(mass(one)).max()
    assert abs(embedding(one, one) - sp.eye_array(one.mesh.n_nodes)).max() <= 0.0


def test_both_are_embedded_in_the_united_mesh(two: tuple[AdaptedMesh, AdaptedMesh]) -> None:
    one, other = two
    both = united(one, other)
    assert same(both.leaves, united(other, one).leaves)
    into, others = embedding(one, both), embedding(other, both)
    size = abs(both.mesh.points).max()
    assert into @ one.mesh.points == pytest.approx(both.mesh.points, abs=8 * EPS * size)
    assert others @ other.mesh.points == pytest.approx(both.mesh.points, abs=8 * EPS * size)
    common = common_matrix(overlay(one, other), masses(one.mesh), masses(other.mesh))
    product = into.T @ mass(both) @ others
    apart = follow(one.mesh).T @ (common - product) @ follow(other.mesh)
    assert abs(apart).max() <= 64 * EPS * abs(mass(one)).max()


def test_the_united_mesh_has_the_finer_leaf_everywhere(two: tuple[AdaptedMesh, AdaptedMesh]) -> None:
    one, other = two
    both = united(one, other)
    levels = [m.leaves.level[m.leaves.around(both.leaves.start)] for m in (one, other)]
    assert np.array_equal(both.leaves.level, np.maximum(*levels))


def test_the_projection_on_a_refinement_is_the_embedding(two: tuple[AdaptedMesh, AdaptedMesh]) -> None:
    one, other = two
    both = united(one, other)
    common = common_matrix(overlay(one, both), masses(one.mesh), masses(both.mesh))
    into = embedding(one, both)
    values = follow(one.mesh) @ np.random.default_rng(0).normal(size=one.mesh.n_nodes)
    apart = follow(both.mesh).T @ (common.T @ values - mass(both) @ (into @ values))
    assert abs(apart).max() <= 64 * EPS * abs(mass(one)).max()


def test_a_coarser_mesh_is_no_refinement() -> None:
    base = interval(1.0, cells=2)
    one, other = refined(base, np.array([0, 1])), refined(base, np.array([1, 0]))
    with pytest.raises(InputError, match="larger"):
        embedding(one, other)


def test_meshes_of_other_bases_are_refused() -> None:
    one, other = (refined(interval(1.0, cells=n), np.zeros(n, int)) for n in (2, 3))
    with pytest.raises(InputError, match="different bases"):
        overlay(one, other)
