"""Matrices whose unknowns are weakly coupled: conjugate gradients in place of a factor."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import cg

from softway.arrays import Array
from softway.solve.linear.interface import Factor, LinearSolver

WEAK = 0.5
"""Greatest sum of the magnitudes beside the diagonal, relative to it, of a matrix for conjugate gradients: with the
diagonal as preconditioner the error falls to a quarter in an iteration."""
ACCURATE = 1e-15
"""Residual of a solution, relative to the right-hand side."""
LIMIT = 60
"""Greatest number of iterations."""


@dataclass(frozen=True, slots=True, eq=False)
class WeaklyCoupled:
    """Symmetric matrix (f, f) with a great diagonal, as that of heat in the short slabs of an impact.

    Examples
    --------
    >>> WeaklyCoupled(sp.csr_array(np.array([[2.0, -0.5], [-0.5, 2.0]]))).solve(np.array([1.5, 1.5])).round(12).tolist()
    [1.0, 1.0]
    """

    matrix: sp.csr_array

    @property
    def bytes(self) -> int:
        """Bytes of the entries."""
        return int(self.matrix.data.nbytes)

    @property
    def indefinite(self) -> bool:
        """False: the diagonal is positive and great."""
        return False

    def solve(self, b: Array) -> Array:
        """Solution of A x = b for b (f,), up to rounding."""
        inverse = sp.diags_array(1.0 / self.matrix.diagonal())
        return np.asarray(cg(self.matrix, b, rtol=ACCURATE, maxiter=LIMIT, M=inverse)[0])


def factor_unless_weak(matrix: sp.csc_array, linear: LinearSolver) -> Factor:
    """Factor of a symmetric matrix (f, f), or conjugate gradients if its unknowns are weakly coupled."""
    diagonal = matrix.diagonal()
    beside = np.asarray(abs(matrix).sum(axis=1)).ravel() - np.abs(diagonal)
    if diagonal.min(initial=np.inf) > 0.0 and (beside <= WEAK * diagonal).all():
        return WeaklyCoupled(sp.csr_array(matrix))
    return linear.factor(matrix)
