"""Conjugate gradients with one reduction in each step."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.vector_space import LocalSpace, VectorSpace
from softway.kernels.linalg.gradient_steps import shared_step
from softway.solve.linear.interface import Factor

ONE = LocalSpace(())


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Descent:
    """Result of conjugate gradients: solution ``x`` (f,), its product ``Ax`` (f,), the squared norm ``first`` of the
    preconditioned right side, and the number of steps (products).
    """

    x: Array
    Ax: Array
    first: float
    steps: int


@runtime_checkable
class Descending(Protocol):
    """Conjugate gradients, wherever their vectors are."""

    @property
    def preconditioner(self) -> Factor:
        """Approximation of the matrix that is solved with."""
        ...

    def times(self, x: Array, /) -> Array:
        """Product (f,) with the matrix."""
        ...

    def descend(
        self, b: Array, precondition: Callable[[Array], tuple[Array, Array]], reference: float = 0.0
    ) -> Descent:
        """Solution in the range of a preconditioner, see :meth:`Gradients.descend`."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Gradients:
    """Conjugate gradients with a product ``times`` and a ``preconditioner``.

    Each step is one product, one application of the preconditioner and one reduction of two numbers (Chronopoulos and
    Gear).  The residual is known before the step that its product allows: the last step is taken where its residual
    meets the tolerance, so the solution is more accurate than asked for.

    Parameters
    ----------
    times
        Product with the symmetric matrix A (f, f).
    preconditioner
        Solves with an approximation of A.
    tolerance
        Residual at which the last step is taken, relative to the right side, both in the norm of the preconditioner.
    limit
        Greatest number of products.
    space
        Inner products of vectors (f,).

    References
    ----------
    Chronopoulos, Gear (1989), s-step iterative methods for symmetric linear systems, J. Comput. Appl. Math. 25,
    153-168; Hestenes, Stiefel (1952), J. Res. Nat. Bur. Standards 49, 409-436.

    Examples
    --------
    >>> from softway.solve.linear.backends.superlu import SuperLU
    >>> import scipy.sparse as sp
    >>> matrix = np.array([[2.0, 1.0], [1.0, 3.0]])
    >>> diagonal = SuperLU().factor(sp.csc_array(np.diag([2.0, 3.0])))
    >>> Gradients(matrix.dot, diagonal, 1e-12, 9).solve(np.array([3.0, 4.0])).round(12)
    array([1., 1.])
    """

    times: Callable[[Array], Array]
    preconditioner: Factor
    tolerance: float
    limit: int
    space: VectorSpace = ONE
    bytes: int = 0
    indefinite: bool = False

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k) to the tolerance; directions of negative curvature end the iteration."""
        if b.ndim == 2:
            return np.stack([self.solve(column) for column in b.T], axis=1)
        return self.descend(b, lambda r: (r, self.preconditioner.solve(r))).x

    def descend(
        self, b: Array, precondition: Callable[[Array], tuple[Array, Array]], reference: float = 0.0
    ) -> Descent:
        """Solution for b (f,) in the range of a preconditioner P, symmetric and positive semidefinite.

        ``precondition`` gives, for a residual r (f,), the residual without a part that P takes to zero, and P r (f,):
        kept in the residual, that part would let rounding in P r count (Gould, Hribar and Nocedal 2001, SIAM J. Sci.
        Comput. 23, 1376).  The tolerance is relative to the squared norm ``reference`` of another right side where that
        is greater.
        """
        r = np.array(b)
        x, Ax, p, Ap = (np.zeros(len(b)) for _ in range(4))
        first, last, alpha, steps = 0.0, np.inf, 1.0, 0
        while steps < self.limit:
            r, z = precondition(r)
            w = self.times(z)
            rho, curvature = self.space.products(np.stack((r, w), axis=1), z)
            first = rho if steps == 0 else first
            beta = rho / last
            bent = curvature - (beta * rho / alpha if steps else 0.0)
            if not (rho > 0.0 and bent > 0.0):
                break
            alpha, last, steps = rho / bent, rho, steps + 1
            shared_step(alpha, beta, z, w, p, Ap, x, Ax, r)
            if rho <= self.tolerance**2 * max(first, reference):
                break
        return Descent(x=x, Ax=Ax, first=first, steps=steps)
