"""Maps from unknowns to nodal velocities: forces are adjoint to velocities, matrices are congruent."""

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from softway.bodies.dof_map import CombinedDofs, DofMap, NodalDofs
from softway.model.ties import joined


@st.composite
def maps(draw: st.DrawFn) -> tuple[DofMap, np.random.Generator]:
    """Maps of both kinds over a few nodes."""
    n, d = draw(st.integers(2, 5)), draw(st.integers(1, 3))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    if draw(st.booleans()):
        free = rng.random((n, d)) < 0.7
        free[0] = True
        return NodalDofs(free), rng
    f = draw(st.integers(1, n * d - 1))
    jacobian = rng.normal(size=(n * d, f)) * (rng.random((n * d, f)) < 0.5)
    jacobian[:f] += 3.0 * np.eye(f)
    return CombinedDofs(sp.csr_array(jacobian), d), rng


@given(maps())
def test_forces_do_the_same_power_on_unknowns_and_nodes(case) -> None:
    dofs, rng = case
    w, force = rng.normal(size=dofs.size), rng.normal(size=dofs.free.shape)
    assert dofs.forces(force) @ w == pytest.approx(np.sum(force * dofs.nodes(w)), abs=1e-12)


@given(maps())
def test_unknowns_are_found_from_their_nodes(case) -> None:
    dofs, rng = case
    w = rng.normal(size=dofs.size)
    np.testing.assert_allclose(dofs.unknowns(dofs.nodes(w)), w, atol=1e-9)


@given(maps())
def test_supported_components_have_the_given_values(case) -> None:
    dofs, rng = case
    given_values = rng.normal(size=dofs.free.shape)
    field = dofs.nodes(rng.normal(size=dofs.size), given_values)
    np.testing.assert_array_equal(field[~dofs.free], given_values[~dofs.free])


@given(maps())
def test_matrices_and_rows_are_those_of_the_jacobian(case) -> None:
    dofs, rng = case
    size = dofs.free.size
    J = dofs.jacobian.toarray()
    np.testing.assert_allclose(J @ np.ones(dofs.size), dofs.nodes(np.ones(dofs.size)).ravel(), atol=1e-14)
    root = rng.normal(size=(size, size))
    K = root + root.T
    np.testing.assert_allclose(dofs.matrix(sp.csc_array(K)).toarray(), J.T @ K @ J, atol=1e-12)
    G = rng.normal(size=(3, size))
    np.testing.assert_allclose(dofs.rows(sp.csr_array(G)).toarray(), G @ J, atol=1e-13)
    np.testing.assert_allclose(dofs.squares(sp.csr_array(G)), ((G @ J) ** 2).sum(axis=1), atol=1e-12)
    other = sp.csc_array(K)
    whole = dofs.sum(sp.csc_array(np.eye(size)), other)
    np.testing.assert_allclose(whole.of(2.0 * other.data, 0.5).toarray(), J.T @ (np.eye(size) + K) @ J, atol=1e-12)


@given(maps())
def test_nodes_are_moved_by_the_unknowns_in_their_rows(case) -> None:
    dofs, rng = case
    n, d = dofs.free.shape
    chosen = np.flatnonzero(rng.random(n) < 0.5)
    J = dofs.jacobian.toarray().reshape(n, d, -1)
    np.testing.assert_array_equal(dofs.moving(chosen), np.flatnonzero(np.abs(J[chosen]).sum(axis=(0, 1)) > 0.0))
    inside = dofs.only(np.isin(np.arange(n), chosen))
    kept = np.abs(np.delete(J, chosen, axis=0)).sum(axis=(0, 1)) == 0.0
    np.testing.assert_array_equal(inside.jacobian.toarray(), J.reshape(n * d, -1)[:, kept])


@given(maps())
def test_the_block_inverse_of_a_diagonal_is_exact(case) -> None:
    """For components of nodes also that of full blocks."""
    dofs, rng = case
    n, d = dofs.free.shape
    root = rng.normal(size=(n, d, d))
    blocks = root @ root.transpose(0, 2, 1) + np.eye(d)
    if dofs.components is None:
        blocks = blocks * np.eye(d)
    matrix = dofs.matrix(sp.csc_array(sp.block_diag(list(blocks))))
    product = (dofs.block_inverse(blocks) @ matrix).toarray()
    if dofs.components is None:
        np.testing.assert_allclose(product.diagonal(), 1.0, atol=1e-12)
    else:
        np.testing.assert_allclose(product, np.eye(dofs.size), atol=1e-9)
    with pytest.raises(np.linalg.LinAlgError):
        dofs.block_inverse(0.0 * blocks)


def test_maps_of_bodies_are_joined() -> None:
    nodal = NodalDofs(np.array([[True, False]]))
    rigid = CombinedDofs(sp.csr_array(np.ones((4, 1))), 2)
    assert isinstance(joined([nodal, nodal]), NodalDofs)
    both = joined([nodal, rigid])
    assert both.nodes(np.array([1.0, 2.0])).tolist() == [[1.0, 0.0], [2.0, 2.0], [2.0, 2.0]]
