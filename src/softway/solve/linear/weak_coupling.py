"""Matrices whose unknowns are weakly coupled: conjugate gradients in place of a factor."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.solve.linear.interface import Factor, LinearSolver

WEAK = 0.5
"""Greatest sum of the magnitudes beside the diagonal, relative to it, of a matrix for conjugate gradients: with the
diagonal as preconditioner the error falls to a quarter in an iteration."""
ACCURATE = 1e-15
"""Residual of a solution, relative to the right-hand side."""
LIMIT = 60
"""Greatest number of iterations."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Links:
    """Symmetric matrix ``J^T diag(w) J`` of differences J (p, f) of few unknowns, with weights w (p,) above zero."""

    jump: sp.csr_array
    back: sp.csr_array
    weights: Array

    @property
    def diagonal(self) -> Array:
        """Its diagonal (f,)."""
        return np.asarray(self.back.power(2) @ self.weights)

    @property
    def sums(self) -> Array:
        """Bound (f,) of the sums of the magnitudes of its rows."""
        return np.asarray(abs(self.back) @ (self.weights * np.asarray(abs(self.jump).sum(axis=1)).ravel()))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WeaklyCoupled:
    """Symmetric matrix (f, f) with a great diagonal, as that of heat in the short slabs of an impact.

    Parameters
    ----------
    matrix
        The matrix.
    diagonal, beside
        (f,) its diagonal, and sums of the magnitudes beside it.
    links
        Further links of its unknowns.

    Examples
    --------
    >>> found = factor_unless_weak(sp.csc_array(np.array([[2.0, -0.5], [-0.5, 2.0]])), None)
    >>> found.solve(np.array([1.5, 1.5])).round(12).tolist()
    [1.0, 1.0]
    """

    matrix: sp.csr_array
    diagonal: Array
    beside: Array
    links: Links | None = None

    @property
    def bytes(self) -> int:
        """Bytes of the entries."""
        return int(self.matrix.data.nbytes)

    @property
    def indefinite(self) -> bool:
        """False: the diagonal is positive and great."""
        return False

    def linked(self, links: Links) -> "WeaklyCoupled | None":
        """Sum with the matrix of some ``links``; None if its unknowns are not weakly coupled."""
        own = links.diagonal
        diagonal, beside = self.diagonal + own, self.beside + links.sums - own
        if (beside > WEAK * diagonal).any():
            return None
        return WeaklyCoupled(matrix=self.matrix, diagonal=diagonal, beside=beside, links=links)

    def solve(self, b: Array) -> Array:
        """Solution of A x = b for b (f,), up to rounding, by conjugate gradients."""
        x, r = np.zeros_like(b), b.copy()
        goal = ACCURATE * float(np.linalg.norm(b))
        z = r / self.diagonal
        p, rho = z, float(r @ z)
        for _ in range(LIMIT):
            if float(np.linalg.norm(r)) <= goal:
                break
            q = self._product(p)
            alpha = rho / float(p @ q)
            x += alpha * p
            r -= alpha * q
            z = r / self.diagonal
            last, rho = rho, float(r @ z)
            p = z + (rho / last) * p
        return x

    def _product(self, x: Array) -> Array:
        """Product (f,) with a vector (f,)."""
        out = self.matrix @ x
        if self.links is not None:
            out += self.links.back @ (self.links.weights * (self.links.jump @ x))
        return np.asarray(out)


def factor_unless_weak(matrix: sp.csc_array, linear: LinearSolver) -> Factor:
    """Factor of a symmetric matrix (f, f), or conjugate gradients if its unknowns are weakly coupled."""
    diagonal = matrix.diagonal()
    beside = np.asarray(abs(matrix).sum(axis=1)).ravel() - np.abs(diagonal)
    if diagonal.min(initial=np.inf) > 0.0 and (beside <= WEAK * diagonal).all():
        return WeaklyCoupled(matrix=sp.csr_array(matrix), diagonal=diagonal, beside=beside)
    return linear.factor(matrix)
