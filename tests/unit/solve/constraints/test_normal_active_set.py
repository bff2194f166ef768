"""The contact problem on a frozen operator: optimality on random problems."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from softway.errors import NoConvergence
from softway.solve.constraints.compliance import FrozenOperator, RowBasis, frozen_operator
from softway.solve.constraints.normal_active_set import RowConditions, solve_normal_contact
from softway.solve.constraints.row_basis import CombinedRows
from softway.solve.linear.backends.superlu import SuperLU


@dataclass(frozen=True)
class Problem:
    """Least z^T A z / 2 - (A y)^T z with G z = c on equal rows, G z >= c on unilateral ones."""

    matrix: np.ndarray
    frozen: FrozenOperator
    coefficients: sp.csr_array
    rows: RowConditions
    free: np.ndarray
    guess: np.ndarray

    @property
    def G(self) -> np.ndarray:
        return (self.coefficients @ self.frozen.basis.directions.T).toarray()

    def solve(self, guess: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        guess = self.guess if guess is None else guess
        return solve_normal_contact(self.free, self.frozen, CombinedRows(self.coefficients), self.rows, guess)


def problem(
    matrix: np.ndarray, G: np.ndarray, rows: RowConditions, free: np.ndarray, guess: np.ndarray, turning: bool = False
) -> Problem:
    """Contact directions are the rows G themselves, or the components of which they are made."""
    m, f = G.shape
    basis = RowBasis(directions=sp.csc_array(G.T), component=None)
    coefficients = sp.csr_array(sp.eye_array(m, format="csr"))
    if turning:
        component = np.flatnonzero((G != 0.0).any(axis=0))
        basis = RowBasis(directions=sp.csc_array(np.eye(f)[:, component]), component=component)
        coefficients = sp.csr_array(G[:, component])
    return Problem(matrix, frozen_operator(sp.csc_array(matrix), basis, SuperLU()), coefficients, rows, free, guess)


@st.composite
def problems(draw: st.DrawFn, repeated: bool = False) -> Problem:
    f = draw(st.integers(2, 8))
    m = draw(st.integers(0, f))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    root = rng.normal(size=(f, f + 2))
    matrix = root @ root.T + 0.1 * np.eye(f)
    G, target = rng.normal(size=(m, f)), rng.normal(size=m)
    G[:, rng.permutation(f)[: rng.integers(0, f - m + 1)]] = 0.0
    if repeated:
        again = rng.integers(0, m, size=m) if m else np.zeros(0, int)
        factor = rng.uniform(0.5, 2.0, size=m)
        G, target = np.vstack([G, factor[:, None] * G[again]]), np.concatenate([target, factor * target[again]])
    status = rng.integers(0, 3, size=len(target))
    if repeated and m:
        status = np.where(status == 1, 2, status)  # repeated rows are all unilateral, or left out
    rows = RowConditions(target=target, equal=status == 1, unilateral=status == 2)
    free, guess = rng.normal(size=f), rng.random(len(target)) < 0.5
    return problem(matrix, G, rows, free, guess, turning=draw(st.booleans()))


def check(p: Problem) -> None:
    """Stationarity, admissibility of gaps and forces, and complementarity."""
    z, force, active = p.solve()
    G = p.G
    gap, tight = G @ z - p.rows.target, p.rows.equal
    size = 1.0 + np.abs(p.free).max() + np.abs(force).max(initial=0.0)
    np.testing.assert_allclose(p.matrix @ (z - p.free), G.T @ force, atol=1e-8 * size)
    np.testing.assert_allclose(gap[tight], 0.0, atol=1e-8 * size)
    assert gap[p.rows.unilateral].min(initial=0.0) >= -1e-8 * size
    assert force[p.rows.unilateral].min(initial=0.0) >= 0.0
    assert np.abs(force[~(p.rows.unilateral | tight)]).max(initial=0.0) == 0.0
    assert np.abs(force * gap).max(initial=0.0) <= 1e-8 * size**2
    assert not (force != 0.0)[~active].any()


@given(problems())
def test_the_solution_is_optimal(p: Problem) -> None:
    check(p)


@given(problems(repeated=True))
def test_repeated_rows_share_the_force(p: Problem) -> None:
    check(p)


@given(problems(), st.integers(0, 10**6))
def test_the_guess_does_not_matter(p: Problem, seed: int) -> None:
    guess = np.random.default_rng(seed).random(len(p.guess)) < 0.5
    first, *_ = p.solve()
    again, *_ = p.solve(guess)
    np.testing.assert_allclose(first, again, atol=1e-8 * (1.0 + np.abs(first).max()))


@pytest.mark.parametrize("offset", [0.0, 0.5, 1.0])
def test_of_two_parallel_obstacles_the_nearer_holds(offset: float) -> None:
    rows = RowConditions(target=np.array([0.0, offset]), equal=np.zeros(2, bool), unilateral=np.ones(2, bool))
    p = problem(np.eye(1), np.ones((2, 1)), rows, np.array([-1.0]), np.ones(2, bool))
    z, force, _ = p.solve()
    assert z[0] == pytest.approx(offset, abs=1e-14)
    assert force.sum() == pytest.approx(1.0 + offset)


def test_a_row_that_misses_its_target_by_rounding_stays_without_force() -> None:
    """As where blocks are flush: of two rows that say the same up to rounding one is enough, whichever it is."""
    for first in (0, 1):
        mine = np.arange(2) == first
        target, every = np.where(mine, 0.0, 1e-13), np.ones(2, bool)
        rows = RowConditions(target=target, equal=~every, unilateral=every, rounding=1e-12)
        z, force, active = problem(np.eye(1), np.ones((2, 1)), rows, np.array([-1.0]), mine).solve()
        assert active.tolist() == mine.tolist() == (force > 0.0).tolist()
        assert z[0] == pytest.approx(0.0, abs=1e-15)


def test_three_obstacles_around_one_node() -> None:
    """A plane corner with a third plane through its edge: two rows would do."""
    G = np.array([[1.0, 0.0], [0.0, 1.0], [np.sqrt(0.5), np.sqrt(0.5)]])
    rows = RowConditions(target=np.zeros(3), equal=np.zeros(3, bool), unilateral=np.ones(3, bool))
    for seed in range(20):
        rng = np.random.default_rng(seed)
        check(problem(np.diag(rng.uniform(0.5, 2.0, 2)), G, rows, rng.normal(size=2) - 1.0, rng.random(3) < 0.5))


def test_many_rows_of_one_chain() -> None:
    """An elastic string above a floor it is pressed on: the touching part is one interval."""
    n = 60
    matrix = (2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)) * (n + 1)
    load = np.full(n, -1.0 / (n + 1))
    rows = RowConditions(target=np.full(n, -0.05), equal=np.zeros(n, bool), unilateral=np.ones(n, bool))
    p = problem(matrix, np.eye(n), rows, np.linalg.solve(matrix, load), np.zeros(n, bool))
    check(p)
    touching = np.flatnonzero(p.solve()[2])
    assert np.all(np.diff(touching) == 1)
    edge = np.sqrt(2 * 0.05)  # y'' = 1 from the support, y = 0.05 with zero slope at the first contact
    assert (touching[0] + 1) / (n + 1) == pytest.approx(edge, abs=1.0 / n)


def test_an_operator_without_a_solution_is_a_failure_of_the_slab() -> None:
    rows = RowConditions(target=np.zeros(1), equal=np.zeros(1, bool), unilateral=np.ones(1, bool))
    p = problem(-np.eye(1), np.eye(1), rows, np.array([-1.0]), np.zeros(1, bool))
    with pytest.raises(NoConvergence):
        p.solve()


@given(problems(), st.integers(0, 10**6))
def test_rows_may_turn_on_one_operator(p: Problem, seed: int) -> None:
    """New rows along the old components: the answer is that of an operator made for them."""
    rng = np.random.default_rng(seed)
    f, m = len(p.free), len(p.guess)
    fresh = problem(p.matrix, rng.normal(size=(m, f)), p.rows, p.free, p.guess)
    frozen = problem(p.matrix, np.ones((1, f)), p.rows, p.free, p.guess, turning=True).frozen
    kept = replace(p, frozen=frozen)
    for G in (p.G, fresh.G):
        again = replace(kept, coefficients=sp.csr_array(G)).solve()
        expected = problem(p.matrix, G, p.rows, p.free, p.guess).solve()
        for a, b in zip(again, expected, strict=True):
            np.testing.assert_allclose(a, b, atol=1e-8 * (1.0 + np.abs(expected[1]).max(initial=0.0)))
