"""Contact rows: gap, normal component, and its adjoint, with and without a deformable opponent."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from single import single
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.dof_map import NodalDofs
from softway.contact.contact_rows import ContactRows
from softway.solve.equations.spin_balance import moment


@st.composite
def cases(draw: st.DrawFn) -> tuple[ContactRows, np.ndarray, np.random.Generator]:
    """Rows on random nodes, several on one node, random supports, some opponents deformable and some out of reach."""
    d, n, m = draw(st.integers(1, 3)), draw(st.integers(1, 6)), draw(st.integers(0, 8))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    normal = rng.normal(size=(m, d))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    offset = np.where(rng.random(m) < 0.8, rng.normal(size=m), np.inf)
    masters = rng.random((m, n)) * (rng.random((m, n)) < 0.6) * draw(st.booleans())
    rows = single(
        rng.integers(0, n, m), normal, offset, n, tool_motion=rng.normal(size=m), contact=rng.integers(0, 2, m),
        labels=("a", "b"), masters=masters,
    )  # fmt: skip
    return rows, rng.random((n, d)) < 0.7, rng


@given(cases())
def test_the_normal_component_is_relative_to_the_opponent(case) -> None:
    rows, free, rng = case
    n, d = free.shape
    field, slopes = rng.normal(size=free.shape), rows.gradient.toarray().reshape(-1, n, d)
    np.testing.assert_allclose(rows.normal_component(field), np.einsum("mnd,nd->m", slopes, field), atol=1e-13)


@given(cases())
def test_the_matrix_gives_the_normal_component_of_supported_fields(case) -> None:
    rows, free, rng = case
    field = rng.normal(size=free.shape) * free
    np.testing.assert_allclose(rows.matrix(NodalDofs(free)) @ field[free], rows.normal_component(field), atol=1e-13)


@given(cases())
def test_spreading_is_the_adjoint_of_the_normal_component(case) -> None:
    rows, free, rng = case
    field, force = rng.normal(size=free.shape), rng.normal(size=len(rows.node))
    spread = rows.spread(force, free.shape)
    np.testing.assert_allclose(np.sum(spread * field), force @ rows.normal_component(field), atol=1e-13)
    np.testing.assert_allclose(rows.matrix(NodalDofs(free)).T @ force, spread[free], atol=1e-13)


@given(cases())
def test_the_gap_is_affine(case) -> None:
    rows, free, rng = case
    u, w = rng.normal(size=(2, *free.shape))
    near = rows.near
    np.testing.assert_allclose((rows.gap(u + w) - rows.normal_component(w))[near], rows.gap(u)[near], atol=1e-13)
    np.testing.assert_array_equal(rows.gap(np.zeros(free.shape)), rows.offset)
    assert np.isposinf(rows.gap(u)[~near]).all()


@given(cases())
def test_rows_that_can_be_moved(case) -> None:
    """Those with an opponent in reach and an entry in the matrix."""
    rows, free, _ = case
    entries = (rows.matrix(NodalDofs(free)).toarray() ** 2).sum(axis=1) > 1e-12
    np.testing.assert_array_equal(rows.reachable(NodalDofs(free)), entries & rows.near)


@given(cases())
def test_every_row_belongs_to_one_contact(case) -> None:
    rows, _, _ = case
    assert (rows.of_contact(0) ^ rows.of_contact(1)).all()


@given(cases())
def test_a_motion_has_the_normal_components_asked_for(case) -> None:
    """Of nodes with one row; the components of supports stay."""
    rows, free, rng = case
    rows = replace(rows, gradient=single(rows.node, rows.normal, 0.0, len(free)).gradient)
    values, which = rng.normal(size=len(rows.node)), rng.random(len(rows.node)) < 0.7
    field = rows.motion(values, which, free)
    assert not field[~free].any()
    movable = which & rows.reachable(NodalDofs(free))
    alone = movable & (np.bincount(rows.node[movable], minlength=len(free))[rows.node] == 1)
    np.testing.assert_allclose(rows.normal_component(field)[alone], values[alone], atol=1e-9)
    assert not field[~np.isin(np.arange(len(free)), rows.node[movable])].any()


def test_nearly_parallel_rows_do_not_move_their_node_aside() -> None:
    """Two edges of a body at the corner 0 that lies on a facet of the other: the opponents move too."""
    angle = 1e-3
    normal = [[0.0, 1.0], [np.sin(angle), np.cos(angle)]]
    rows = single([0, 0], normal, 0.0, 3, masters=[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    values = np.array([1e-7, -1e-7])
    field = rows.motion(values, np.ones(2, bool), np.ones((3, 2), bool))
    np.testing.assert_allclose(rows.normal_component(field), values, rtol=1e-9)
    assert np.abs(field).max() < 2e-7


def test_travel_bounds_the_motion_of_a_node_against_a_facet_or_a_tool() -> None:
    rows = single([0, 0, 1], [[0.0, 1.0]] * 3, [0.0, 0.0, np.inf], 3, masters=[[0.0, 0.5, 0.5], [0.0] * 3, [0.0] * 3])
    bound = rows.travel(np.array([1.0, 2.0, 4.0]), 4.0)
    assert bound[:2] == pytest.approx([1.0 + 3.0, 1.0 + 4.0])


def test_a_pair_of_bodies_pushes_with_opposite_forces() -> None:
    """A node on the middle of a bar of the other body: forces and moments cancel, at the gap zero."""
    x = np.array([[0.5, 0.0], [0.0, 0.0], [1.0, 0.0]])
    rows = single([0], [[0.0, 1.0]], 0.0, 3, masters=[[0.0, 0.5, 0.5]])
    push = rows.spread(np.array([3.0]), x.shape)
    assert push[0].tolist() == [0.0, 3.0]
    np.testing.assert_allclose(push.sum(axis=0), 0.0, atol=1e-15)
    assert moment(LocalSpace(()), x, push) == pytest.approx([0.0], abs=1e-15)
    rigid = np.tile([7.0, -2.0], (3, 1)) + 0.3 * (x - x[0])[:, ::-1] * [-1.0, 1.0]
    assert rows.normal_component(rigid) == pytest.approx([0.0], abs=1e-15)


def test_a_row_whose_node_is_held_is_moved_by_the_opponent() -> None:
    rows = single([0], [[1.0]], 0.1, 2, masters=[[0.0, 1.0]])
    free = np.array([[False], [True]])
    assert rows.reachable(NodalDofs(free)).tolist() == [True]
    assert rows.matrix(NodalDofs(free)).toarray().tolist() == [[-1.0]]
    assert not rows.reachable(NodalDofs(free & False)).any()
