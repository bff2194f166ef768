"""Small dense systems of contact rows, some of which may depend on others."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from softway.errors import NoConvergence
from softway.typing import Array, IntArray

LIFT = 1e-11
"""Share of the greatest compliance by which dependent rows are told apart; it leaves no trace in the forces."""


@dataclass(frozen=True, slots=True, eq=False)
class Shared:
    """A dense symmetric matrix (k, k), factored; see :func:`shared`."""

    matrix: Array
    factor: Array
    pivots: IntArray

    def solve(self, b: Array) -> Array:
        """Solution (k,), refined on the matrix itself."""
        if not len(b):
            return np.zeros(0)
        x = np.asarray(dgetrs(self.factor, self.pivots, b)[0], float)
        for _ in range(3):
            x = x + dgetrs(self.factor, self.pivots, b - self.matrix @ x)[0]
        return x


def factored(matrix: Array) -> Shared:
    """The factors of a dense symmetric matrix whose rows may depend on each other.

    The diagonal is lifted by ``LIFT`` so that dependent rows can be told apart.  The matrix need not be positive: a
    part that only the contact holds has an indefinite compliance.

    Raises
    ------
    NoConvergence
        If the lifted matrix is singular.
    """
    if not len(matrix):
        return Shared(matrix, matrix, np.zeros(0, int))
    lifted = matrix + LIFT * np.abs(np.diag(matrix)).max() * np.eye(len(matrix))
    factor, pivots, failed = dgetrf(lifted)
    if failed:
        raise NoConvergence(f"the compliance of {len(matrix)} contact rows is singular")
    return Shared(matrix, factor, pivots)


def shared(matrix: Array, b: Array) -> Array:
    """Solution of a dense symmetric system; redundant rows share the force, consistent systems are met to rounding.

    Examples
    --------
    >>> shared(np.ones((2, 2)), np.ones(2)).round(12)
    array([0.5, 0.5])
    """
    return factored(matrix).solve(b)
