"""Small dense systems of contact rows, which may be linearly dependent."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs, dpotrf, dpotri, dpotrs

from softway.arrays import Array, IntArray
from softway.errors import NoConvergence

LIFT = 1e-11
"""Regularisation of dependent rows, relative to the greatest compliance; refinement removes its effect on forces."""


@dataclass(frozen=True, slots=True, eq=False)
class DenseFactor:
    """Factored dense symmetric matrix (k, k); see :func:`solve_dense`."""

    matrix: Array
    factor: Array
    pivots: IntArray

    def solve(self, b: Array) -> Array:
        """Solution (k,), refined iteratively with the original matrix."""
        if not len(b):
            return np.zeros(0)
        x = self.once(b)
        for _ in range(3):
            x = x + self.once(b - self.matrix @ x)
        return x

    def once(self, b: Array) -> Array:
        """Solution (k,) without refinement."""
        return np.asarray(dgetrs(self.factor, self.pivots, b)[0], float) if len(b) else np.zeros(0)


def factored(matrix: Array) -> DenseFactor:
    """Factor a dense symmetric matrix whose rows may be linearly dependent.

    ``LIFT`` times the greatest diagonal entry is added to the diagonal, which separates dependent rows.  The matrix
    need not be positive definite: a body that is held by contact alone has an indefinite compliance.

    Raises
    ------
    NoConvergence
        If the matrix remains singular.
    """
    if not len(matrix):
        return DenseFactor(matrix, matrix, np.zeros(0, int))
    lifted = matrix + LIFT * np.abs(np.diag(matrix)).max() * np.eye(len(matrix))
    factor, pivots, failed = dgetrf(lifted)
    if failed:
        raise NoConvergence(f"the compliance of {len(matrix)} contact rows is singular")
    return DenseFactor(matrix, factor, pivots)


def solve_dense(matrix: Array, b: Array) -> Array:
    """Solution of a dense symmetric system.

    Redundant rows share the force.  Consistent systems are satisfied up to rounding.

    Examples
    --------
    >>> solve_dense(np.ones((2, 2)), np.ones(2)).round(12)
    array([0.5, 0.5])
    """
    return factored(matrix).solve(b)


@dataclass(frozen=True, slots=True, eq=False)
class NestedFactor:
    """Cholesky factor of a dense positive matrix (k, k), which contains those of its leading blocks."""

    matrix: Array
    lower: Array

    def solve(self, b: Array) -> Array:
        """Solution (j,) of the leading block of size j <= k, refined iteratively with the original matrix."""
        j = len(b)
        if not j:
            return np.zeros(0)
        lower, matrix = np.asfortranarray(self.lower[:j, :j]), self.matrix[:j, :j]
        x = np.asarray(dpotrs(lower, b, lower=1)[0], float)
        for _ in range(3):
            x = x + dpotrs(lower, b - matrix @ x, lower=1)[0]
        return x


def nested(matrix: Array) -> NestedFactor:
    """Factor a dense positive matrix whose rows may be linearly dependent, see :func:`factored`.

    Examples
    --------
    >>> factor = nested(np.array([[2.0, 1.0], [1.0, 2.0]]))
    >>> factor.solve(np.array([1.0])).round(12), factor.solve(np.array([3.0, 3.0])).round(12)
    (array([0.5]), array([1., 1.]))

    Raises
    ------
    NoConvergence
        If the matrix is not positive.
    """
    lift = LIFT * np.abs(np.diag(matrix)).max(initial=0.0)
    lower, failed = dpotrf(matrix + lift * np.eye(len(matrix)), lower=1, clean=1) if len(matrix) else (matrix, 0)
    if failed:
        raise NoConvergence(f"the compliance of {len(matrix)} contact rows is not positive")
    return NestedFactor(matrix, lower)


def inverse_positive(matrix: Array) -> Array | None:
    """Inverse of a dense symmetric positive definite matrix (k, k), which is overwritten; None if it is not positive.

    Examples
    --------
    >>> inverse_positive(np.array([[2.0, 1.0], [1.0, 2.0]])).round(12).tolist()
    [[0.666666666667, -0.333333333333], [-0.333333333333, 0.666666666667]]
    """
    lower, failed = dpotrf(matrix.T, lower=1, clean=1, overwrite_a=1)
    if failed:
        return None
    half, failed = dpotri(lower, lower=1, overwrite_c=1)
    return None if failed else np.asarray(half + np.tril(half, -1).T, float)
