"""Conjugate gradients without a matrix, preconditioned by the diagonal blocks of the nodes."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.errors import NoConvergence
from softway.model.model import Model
from softway.solve.checks import check_products
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.conjugate_gradients import Gradients
from softway.solve.linear.interface import Analysis
from softway.solve.operators.interface import BuiltOperator


@dataclass(frozen=True, slots=True, kw_only=True)
class MatrixFree:
    """Jacobi-preconditioned conjugate gradients: no factor, no matrix.

    Best for compact bodies in short slabs, with few products per solution, and if a factor would not fit into memory.

    Parameters
    ----------
    tolerance
        Residual at which a solution ends, relative to the right side; the fixed point corrects the rest.
    limit
        Greatest number of products of a solution.

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

    def require(self, model: Model) -> None:
        """Accept every model."""

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        model, stiffness_factor, dofs = slab.model, slab.stiffness_factor, slab.model.dofs

        def times(x: Array) -> Array:
            field = dofs.nodes(x)
            force = model.mass @ field + stiffness_factor * model.tangent_product(u, field)
            return dofs.forces(model.space.filled(force))

        local = nodal(slab, u)
        return BuiltOperator(
            factor=Gradients(times, local, self.tolerance, self.limit, model.space.of_unknowns),
            local=local,
            analysis=None,
            price=1.0,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Blocks:
    """Block-diagonal matrix (f, f): inverse of the diagonal blocks."""

    matrix: sp.csr_array
    bytes: int = 0
    indefinite: bool = False

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k); sparse if b is sparse."""
        found: Array = self.matrix @ b
        return found


def nodal(slab: SlabMatrix, u: Array) -> Blocks:
    """Inverse of the nodal diagonal blocks of the operator at the displacement ``u`` (n, d).

    Raises
    ------
    NoConvergence
        If a block is singular.
    """
    model, unit = slab.model, np.eye(slab.model.shape[1])
    blocks = (
        slab.stiffness_factor * model.space.filled(model.tangent_blocks(u))
        + model.mass.diagonal()[:, None, None] * unit
    )
    inverse: sp.csr_array | None = None
    with suppress(np.linalg.LinAlgError):
        inverse = model.dofs.block_inverse(blocks)
    found = model.space.every(np.array([inverse is not None]))  # in all processes, or in none
    if inverse is None or not found:
        raise NoConvergence("a node has neither inertia nor stiffness")
    return Blocks(inverse)
