"""Matrices whose unknowns are weakly coupled, or on several ranks: conjugate gradients in place of a factor."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.assembled.vector_space import LocalSpace, VectorSpace
from softway.solve.linear.interface import Factor, LinearSolver

WEAK = 0.5
"""Greatest sum of the magnitudes beside the diagonal, relative to it, of a matrix for conjugate gradients: with the
diagonal as preconditioner the error falls to a quarter in an iteration."""
ACCURATE = 1e-15
"""Residual of a solution, relative to the right-hand side."""
LIMIT = 60
"""Greatest number of iterations."""
LONG = 2000
"""The same where the unknowns are not weakly coupled, and on several ranks."""
ONE = LocalSpace(())


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
class DiagonalGradients:
    """Symmetric matrix (f, f) with a great diagonal, as that of heat in the short slabs of an impact.

    Parameters
    ----------
    matrix
        The matrix.
    diagonal, beside
        (f,) its diagonal, and sums of the magnitudes beside it.
    links
        Further links of its unknowns.
    weak
        True if the unknowns are weakly coupled.
    space
        Sums over the unknowns, of which rows of other ranks are empty.

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
    weak: bool = True
    space: VectorSpace = ONE

    @property
    def bytes(self) -> int:
        """Bytes of the entries."""
        return int(self.matrix.data.nbytes)

    @property
    def indefinite(self) -> bool:
        """False: the diagonal is positive and great."""
        return False

    def linked(self, links: Links) -> "DiagonalGradients | None":
        """Sum with the matrix of some ``links``; None in one process if its unknowns are not weakly coupled."""
        own = links.diagonal
        diagonal, beside = self.diagonal + own, self.beside + links.sums - own
        weak = self.space.every(beside <= WEAK * diagonal)
        if not weak and isinstance(self.space, LocalSpace):
            return None
        return replace(self, diagonal=diagonal, beside=beside, links=links, weak=weak)

    def solve(self, b: Array) -> Array:
        """Solution of A x = b for b (f,), up to rounding, by conjugate gradients."""
        space, x, r = self.space, np.zeros_like(b), self.space.filled(b.copy())
        goal = ACCURATE * space.norm(b)
        z = r / self.diagonal
        p, rho = z, space.dot(r, z)
        for _ in range(LIMIT if self.weak else LONG):
            if space.norm(r) <= goal:
                break
            q = self._product(p)
            alpha = rho / space.dot(p, q)
            x += alpha * p
            r -= alpha * q
            z = r / self.diagonal
            last, rho = rho, space.dot(r, z)
            p = z + (rho / last) * p
        return x

    def _product(self, x: Array) -> Array:
        """Product (f,) with a vector (f,)."""
        out = self.matrix @ x
        if self.links is not None:
            out += self.links.back @ (self.links.weights * (self.links.jump @ x))
        return self.space.filled(np.asarray(out))


def factor_unless_weak(matrix: sp.csc_array, linear: LinearSolver, space: VectorSpace = ONE) -> Factor:
    """Factor of a symmetric matrix (f, f), or conjugate gradients if its unknowns are weakly coupled.

    On several ranks, whose ``space`` knows the rows of each, there are conjugate gradients alone.
    """
    diagonal = space.filled(matrix.diagonal())
    beside = np.asarray(abs(matrix).sum(axis=1)).ravel() - np.abs(matrix.diagonal())
    weak = space.least(diagonal) > 0.0 and space.every(beside <= WEAK * diagonal)
    if weak or not isinstance(space, LocalSpace):
        return DiagonalGradients(matrix=sp.csr_array(matrix), diagonal=diagonal, beside=beside, weak=weak, space=space)
    return linear.factor(matrix)
