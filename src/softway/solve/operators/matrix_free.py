"""Conjugate gradients without a matrix, preconditioned by the diagonal blocks of the nodes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.errors import NoConvergence
from softway.solve.linear import Analysis, Factor
from softway.solve.operators.operator import Made
from softway.solve.settings import check_products
from softway.solve.stiffness import Stiffness
from softway.typing import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class MatrixFree:
    """Jacobi-preconditioned conjugate gradients: no factor, no matrix.

    Best for compact bodies in short slabs, where it takes a few products with the stiffness, and where a factor would
    not fit into memory.

    Parameters
    ----------
    tolerance
        Residual at which a solution ends, relative to the right side; the fixed point makes up for what is left.
    limit
        Products after which it ends in any case.

    References
    ----------
    Hestenes, Stiefel (1952), J. Res. Nat. Bur. Standards 49, 409-436.

    Examples
    --------
    >>> MatrixFree().tolerance
    0.01
    """

    tolerance: float = 1e-2
    limit: int = 500

    def __post_init__(self) -> None:
        check_products(self.tolerance, self.limit)

    def make(self, slab: Stiffness, u: Array, analysis: Analysis | None) -> Made:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        model, share, free = slab.model, slab.share, slab.model.free

        def times(x: Array) -> Array:
            field = np.zeros(free.shape)
            field[free] = x
            return np.asarray((model.mass @ field + share * model.tangent_product(u, field))[free])

        local = nodal(slab, u)
        return Made(factor=Gradients(times, local, self.tolerance, self.limit), local=local, analysis=None, price=1.0)


@dataclass(frozen=True, slots=True, eq=False)
class Blocks:
    """Inverse (f, f) of diagonal blocks, block-diagonal itself."""

    matrix: sp.csr_array
    bytes: int = 0

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k); sparse where b is."""
        found: Array = self.matrix @ b
        return found


def nodal(slab: Stiffness, u: Array) -> Blocks:
    """Inverse of the diagonal blocks of the operator at the displacement ``u`` (n, d), one for each node.

    Raises
    ------
    NoConvergence
        If a block is singular.
    """
    model, free = slab.model, slab.model.free
    n, d = free.shape
    blocks = slab.share * model.tangent_blocks(u) + model.mass.diagonal()[:, None, None] * np.eye(d)
    both = free[:, :, None] & free[:, None, :]
    try:
        inverse = np.linalg.inv(np.where(both, blocks, np.eye(d)))
    except np.linalg.LinAlgError:
        raise NoConvergence("a node has neither inertia nor stiffness") from None
    whole = sp.bsr_array((inverse, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d)).tocsr()
    keep = np.flatnonzero(free.ravel())
    return Blocks(sp.csr_array(whole[keep][:, keep]))


@dataclass(frozen=True, slots=True, eq=False)
class Gradients:
    """Conjugate gradients with a product ``times`` and a ``preconditioner``."""

    times: Callable[[Array], Array]
    preconditioner: Factor
    tolerance: float
    limit: int
    bytes: int = 0

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k) to the tolerance; directions of negative curvature end the iteration."""
        if b.ndim == 2:
            return np.stack([self.solve(column) for column in b.T], axis=1)
        x, r = np.zeros_like(b), b.copy()
        z = self.preconditioner.solve(r)
        p, rho = z, float(r @ z)
        goal = self.tolerance**2 * rho
        for _ in range(self.limit):
            if rho <= goal or rho <= 0.0:
                break
            Ap = self.times(p)
            curvature = float(p @ Ap)
            if curvature <= 0.0:
                break
            alpha = rho / curvature
            x += alpha * p
            r -= alpha * Ap
            z = self.preconditioner.solve(r)
            rho, last = float(r @ z), rho
            p = z + (rho / last) * p
        return x
