"""Small dense systems of contact rows, which may be linearly dependent."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

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
        x = np.asarray(dgetrs(self.factor, self.pivots, b)[0], float)
        for _ in range(3):
            x = x + dgetrs(self.factor, self.pivots, b - self.matrix @ x)[0]
        return x


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
