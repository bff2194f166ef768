"""Contact directions, and the compliance along them, against dense inverses."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from single import single
from softway.bodies.dof_map import NodalDofs
from softway.bodies.solid import Fixed
from softway.contact.contact_rows import ContactRows
from softway.contact.impact_rule import Impulse
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator, RowBasis, frozen_operator, row_basis
from softway.solve.constraints.normal_active_set import delassus, multipliers
from softway.solve.constraints.row_basis import UnitRows
from softway.solve.linear.backends.superlu import SuperLU

kinds = pytest.mark.parametrize("kind", ["rows", "components", "both"])
NODES = 5


@st.composite
def cases(draw: st.DrawFn) -> tuple[ContactRows, np.ndarray, np.random.Generator]:
    """Rows among random nodes, some with deformable opponents, and supports."""
    d, m = draw(st.integers(1, 3)), draw(st.integers(1, 6))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    normal = rng.normal(size=(m, d))
    unit = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    masters = draw(st.booleans()) * sp.random_array((m, NODES), density=0.3, rng=rng).toarray()
    rows = single(rng.integers(0, NODES, m), unit, 0.0, NODES, masters=masters)
    free = rng.random((NODES, d)) < 0.7
    free[0] = True
    return rows, free, rng


def directions(rows: ContactRows, free: np.ndarray, kind: str) -> RowBasis:
    """Directions of rows of which all, none or every second one never changes."""
    nodes = np.unique(rows.gradient.tocoo().coords[1] // free.shape[1])
    known = np.arange(len(rows.node)) % 2 == 0 if kind == "both" else None
    return row_basis(rows, NodalDofs(free), kind == "rows", nodes, known)


def frozen(
    rows: ContactRows, free: np.ndarray, kind: str, rng: np.random.Generator
) -> tuple[FrozenOperator, np.ndarray]:
    """A factored operator and its dense inverse."""
    f = int(free.sum())
    root = rng.normal(size=(f, f + 2))
    matrix = root @ root.T + np.eye(f)
    return frozen_operator(sp.csc_array(matrix), directions(rows, free, kind), SuperLU()), np.linalg.inv(matrix)


@kinds
@given(case=cases())
def test_the_coefficients_lead_back_to_the_rows(kind: str, case) -> None:
    rows, free, _ = case
    found = directions(rows, free, kind)
    product = found.coefficients(rows, NodalDofs(free)) @ found.directions.T
    np.testing.assert_array_equal(product.toarray(), rows.matrix(NodalDofs(free)).toarray())


@kinds
@given(case=cases())
def test_answer_and_compliance(kind: str, case) -> None:
    rows, free, rng = case
    operator, inverse = frozen(rows, free, kind, rng)
    B = operator.basis.directions.toarray()
    b = B.shape[1]
    y = rng.normal(size=len(B))
    np.testing.assert_allclose(operator.solve(y), inverse @ y, atol=1e-12)
    np.testing.assert_allclose(operator.restrict(y), B.T @ y, atol=1e-13)
    for _ in range(3):
        which = np.flatnonzero(rng.random(b) < 0.5)
        np.testing.assert_allclose(operator.square(which), B[:, which].T @ inverse @ B[:, which], atol=1e-12)
        push = np.zeros(b)
        push[which] = rng.normal(size=len(which))
        np.testing.assert_allclose(operator.solve_push(push), inverse @ B @ push, atol=1e-11)
        np.testing.assert_allclose(operator.compliance_times(push), B.T @ inverse @ B @ push, atol=1e-11)


@kinds
@given(case=cases())
def test_the_compliance_of_rows(kind: str, case) -> None:
    rows, free, rng = case
    operator, inverse = frozen(rows, free, kind, rng)
    G = rows.matrix(NodalDofs(free)).toarray()
    active = operator.coefficients(rows, NodalDofs(free))
    np.testing.assert_allclose(delassus(operator, active), G @ inverse @ G.T, atol=1e-11)


@kinds
@given(case=cases())
def test_balanced_rows_move_as_wanted(kind: str, case) -> None:
    """Of independent rows exactly; the push is ``G^T force``, and what it moves along the directions is told."""
    rows, free, rng = case
    operator, inverse = frozen(rows, free, kind, rng)
    G = rows.matrix(NodalDofs(free)).toarray()
    least = [np.linalg.svd(G[:k], compute_uv=False)[-1] if k <= G.shape[1] else 0.0 for k in range(1, len(G) + 1)]
    index = np.arange(np.sum(np.minimum.accumulate(least) > 1e-2))
    wanted = rng.normal(size=len(index))
    force, push = multipliers(operator, operator.coefficients(rows, NodalDofs(free)).subset(index), wanted)
    B = operator.basis.directions.toarray()[:, : len(push.directions)]
    size = 1.0 + np.abs(force).max(initial=0.0)
    np.testing.assert_allclose(B @ push.directions, G[index].T @ force, atol=1e-12 * size)
    np.testing.assert_allclose(G[index] @ inverse @ B @ push.directions, wanted, atol=1e-7)
    np.testing.assert_allclose(push.sensed, B.T @ inverse @ B @ push.directions, atol=1e-7)


@kinds
def test_rows_that_change_keep_no_forces_of_others(kind: str) -> None:
    """One operator balances one pair of rows after another, as in slabs where other nodes touch."""
    rng = np.random.default_rng(3)
    rows = single(np.arange(4), np.ones((4, 1)), 0.0, NODES)
    operator, inverse = frozen(rows, np.ones((NODES, 1), bool), kind, rng)
    G = rows.matrix(NodalDofs(np.ones((NODES, 1), bool))).toarray()
    every = operator.coefficients(rows, NodalDofs(np.ones((NODES, 1), bool)))
    for index in ([0, 1], [0, 2], [2, 3], [0, 1]):
        force, _ = multipliers(operator, every.subset(np.array(index)), np.array([1.0, -2.0]))
        np.testing.assert_allclose((G @ inverse @ G.T)[np.ix_(index, index)] @ force, [1.0, -2.0], rtol=1e-10)


@given(case=cases())
def test_where_the_others_are_open_the_known_rows_are_alone(case) -> None:
    """Forces and motions along the known rows only: no values along the unknowns of the others are computed."""
    rows, free, rng = case
    operator, inverse = frozen(rows, free, "both", rng)
    offset = np.where(np.arange(len(rows.node)) % 2 == 0, rows.offset, np.inf)
    found = operator.coefficients(replace(rows, offset=offset), NodalDofs(free))
    assert isinstance(found, UnitRows)
    assert found.count == operator.basis.known
    G = rows.matrix(NodalDofs(free)).toarray()[::2]
    forces = np.zeros(len(rows.node))
    forces[::2] = rng.normal(size=len(G)) * (np.abs(G).max(axis=1) > 0.0)
    push = found.spread(forces)
    np.testing.assert_allclose(operator.prolong(push), G.T @ forces[::2], atol=1e-13)
    np.testing.assert_allclose(operator.solve_push(push), inverse @ G.T @ forces[::2], atol=1e-11)
    moved = found.from_basis(operator.compliance_times(push))[::2]
    np.testing.assert_allclose(moved, G @ inverse @ G.T @ forces[::2], atol=1e-11)


def test_directions_of_half_spaces_at_rest_are_their_rows_that_can_move(block: Callable[..., Model]) -> None:
    model = block(timing=Impulse(), supports=(Fixed(on="left"),))
    rows = model.rows(model.displacement)
    found = row_basis(rows, model.dofs, model.contacts.fixed, model.touchable)
    assert found.component is None
    matrix = rows.matrix(model.dofs).toarray()
    assert found.place.tolist().count(-1) == 1, "the corner is held"
    np.testing.assert_array_equal(found.coefficients(rows, model.dofs) @ found.directions.toarray().T, matrix)


def test_directions_of_rows_that_turn_are_the_free_components_of_their_nodes(block: Callable[..., Model]) -> None:
    model = block(timing=Impulse(), supports=(Fixed(on="left"),))
    found = row_basis(model.rows(model.displacement), model.dofs, False, model.touchable)
    touchable = np.zeros(model.shape, bool)
    touchable[model.touchable] = True
    assert found.component.tolist() == np.flatnonzero(touchable[model.free]).tolist()
    np.testing.assert_array_equal(found.directions.sum(axis=0), np.ones(len(found.component)))
