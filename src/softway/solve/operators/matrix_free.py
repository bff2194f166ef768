"""Conjugate gradients without a matrix, preconditioned by the diagonal blocks of the nodes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.errors import InputError, NoConvergence
from softway.solve.linear import Analysis, Factor
from softway.solve.operators.operator import Made
from softway.solve.system import SlabSystem
from softway.typing import Array, BoolArray


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
    0.001
    """

    tolerance: float = 1e-3
    limit: int = 500

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance < 1.0:
            raise InputError("tolerance", f"{self.tolerance:g}", "a number between 0 and 1")
        if self.limit < 1:
            raise InputError("limit", f"{self.limit} products", "at least 1")

    def make(self, system: SlabSystem, u: Array, analysis: Analysis | None) -> Made:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        model, share, free = system.model, system.share, system.model.free

        def times(x: Array) -> Array:
            field = np.zeros(free.shape)
            field[free] = x
            return np.asarray((model.mass @ field + share * model.tangent_product(u, field))[free])

        d = free.shape[1]
        blocks = share * model.tangent_blocks(u) + model.mass.diagonal()[:, None, None] * np.eye(d)
        local = blocks_inverted(blocks, free)
        return Made(factor=Gradients(times, local, self.tolerance, self.limit), local=local, analysis=None, price=1.0)


@dataclass(frozen=True, slots=True, eq=False)
class Blocks:
    """Inverse (n, d, d) of diagonal blocks on the ``free`` components (n, d)."""

    inverse: Array
    free: BoolArray
    bytes: int = 0

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k)."""
        field = np.zeros((*self.free.shape, *b.shape[1:]))
        field[self.free] = b
        return np.einsum("nij,nj...->ni...", self.inverse, field)[self.free]


def blocks_inverted(blocks: Array, free: BoolArray) -> Blocks:
    """Inverse of the diagonal blocks (n, d, d) restricted to the free components (n, d).

    Raises
    ------
    NoConvergence
        If a block is singular.
    """
    both = free[:, :, None] & free[:, None, :]
    regular = np.where(both, blocks, np.eye(free.shape[1]))
    try:
        inverse = np.linalg.inv(regular)
    except np.linalg.LinAlgError:
        raise NoConvergence("a node has neither inertia nor stiffness") from None
    return Blocks(inverse=np.where(both, inverse, 0.0), free=free)


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
