"""Operators that have to be positive definite."""

import numpy as np
import pytest
import scipy.sparse as sp

from softway.errors import NoConvergence
from softway.solve.linear.backends.choice import best_solver
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import LinearSolver
from softway.solve.operators.positive_definite import SHIFTS, positive_definite_factor

SOLVERS = [SuperLU(), best_solver()]


def symmetric(seed: int, size: int = 12) -> sp.csc_array:
    """Random symmetric matrix with eigenvalues of both signs, a zero and small ones on its diagonal."""
    rng = np.random.default_rng(seed)
    full = rng.normal(size=(size, size)) * (rng.random((size, size)) < 0.4)
    full = full + full.T + np.diag(rng.normal(size=size) * 10.0 ** rng.uniform(-6.0, 1.0, size))
    out = sp.csc_array(full + np.diag(np.full(size, 1e-300)))
    out.sort_indices()
    return out


def shift_of(found: np.ndarray, matrix: sp.csc_array) -> float:
    """The multiple s in ``found = (A + s D)^-1``."""
    full = matrix.toarray()
    sums = np.abs(full).sum(axis=0)
    return float(np.mean(np.diag(np.linalg.inv(found) - full) / sums))


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda s: type(s).__name__)
@pytest.mark.parametrize("seed", range(20))
def test_the_least_shift_that_suffices_is_taken(solver: LinearSolver, seed: int) -> None:
    matrix = symmetric(seed)
    found = positive_definite_factor(solver.analyse(matrix), matrix).solve(np.eye(12))
    assert np.linalg.eigvalsh(0.5 * (found + found.T)).min() > 0.0
    sums = np.diag(np.abs(matrix.toarray()).sum(axis=0))
    enough = [s for s in (0.0, *SHIFTS) if np.linalg.eigvalsh(matrix.toarray() + s * sums).min() > 0.0]
    assert shift_of(found, matrix) == pytest.approx(enough[0], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda s: type(s).__name__)
def test_a_positive_definite_matrix_is_left_as_it_is(solver: LinearSolver) -> None:
    full = symmetric(3).toarray()
    matrix = sp.csc_array(full @ full + np.eye(12))
    matrix.sort_indices()
    b = np.arange(12.0)
    np.testing.assert_array_equal(
        positive_definite_factor(solver.analyse(matrix), matrix).solve(b), solver.factor(matrix).solve(b)
    )


def test_what_cannot_be_shifted_is_refused() -> None:
    broken = symmetric(1)
    broken.data[0] = np.nan
    for matrix in (broken, sp.csc_array((4, 4))):
        with pytest.raises(NoConvergence, match="cannot be factored"):
            positive_definite_factor(SuperLU(), matrix)
