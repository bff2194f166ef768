"""Conjugate gradients: exact solutions, one reduction in a step, negative curvature."""

from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.assembled.vector_space import LocalSpace
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.conjugate_gradients import Gradients


class Counting(LocalSpace):
    """Space that counts its reductions."""

    def products(self, a: Array, b: Array) -> Array:
        REDUCTIONS.append(a.shape)
        return LocalSpace.products(self, a, b)

    def dot(self, a: Array, b: Array) -> float:
        raise AssertionError("a second reduction")


REDUCTIONS: list[tuple[int, ...]] = []


@dataclass(frozen=True)
class Problem:
    """A symmetric positive definite matrix with its diagonal as preconditioner."""

    matrix: Array
    right: Array

    def gradients(self, tolerance: float, space: LocalSpace) -> Gradients:
        diagonal = SuperLU().factor(sp.csc_array(np.diag(np.diag(self.matrix))))
        return Gradients(self.matrix.dot, diagonal, tolerance, 100, space)


@pytest.fixture
def problem() -> Problem:
    rng = np.random.default_rng(3)
    root = rng.normal(size=(12, 12))
    return Problem(root @ root.T + np.diag(np.arange(1.0, 13.0)), rng.normal(size=12))


def test_it_solves_and_gives_the_product_of_its_solution(problem: Problem) -> None:
    found = problem.gradients(1e-13, LocalSpace(())).descend(problem.right, lambda r: (r, r))
    np.testing.assert_allclose(found.x, np.linalg.solve(problem.matrix, problem.right), rtol=1e-9)
    np.testing.assert_allclose(found.Ax, problem.matrix @ found.x, atol=1e-12)


def test_a_step_has_one_reduction_of_two_numbers(problem: Problem) -> None:
    REDUCTIONS.clear()
    gradients = problem.gradients(1e-6, Counting(()))
    found = gradients.descend(problem.right, lambda r: (r, gradients.preconditioner.solve(r)))
    assert 3 < found.steps <= 13
    assert [(12, 2)] * found.steps == REDUCTIONS


def test_the_last_step_is_taken_where_its_residual_meets_the_tolerance(problem: Problem) -> None:
    """The residual after k steps is that of textbook conjugate gradients."""
    gradients = problem.gradients(0.1, LocalSpace(()))
    found = gradients.descend(problem.right, lambda r: (r, gradients.preconditioner.solve(r)))
    diagonal = np.diag(problem.matrix)
    krylov = [problem.right / diagonal]
    for _ in range(found.steps - 1):
        krylov.append(problem.matrix @ krylov[-1] / diagonal)
    basis = np.linalg.qr(np.stack(krylov, axis=1))[0]
    best = basis @ np.linalg.solve(basis.T @ problem.matrix @ basis, basis.T @ problem.right)
    np.testing.assert_allclose(found.x, best, rtol=1e-6, atol=1e-9)


def test_negative_curvature_ends_the_iteration(problem: Problem) -> None:
    saddle = Problem(problem.matrix - 20.0 * np.eye(12), problem.right)
    found = saddle.gradients(1e-10, LocalSpace(())).descend(saddle.right, lambda r: (r, r))
    assert np.isfinite(found.x).all() and found.steps < 12
    assert found.x @ (saddle.matrix @ found.x) >= 0.0
