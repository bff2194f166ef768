"""Conjugate gradients with a stored matrix, preconditioned by the diagonal blocks of the nodes."""

from dataclasses import dataclass
from functools import partial

from softway.arrays import Array
from softway.kernels.linalg.gradient_steps import shared_product
from softway.model.model import Model
from softway.solve.checks import check_products
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.conjugate_gradients import Gradients
from softway.solve.linear.interface import Analysis
from softway.solve.operators.interface import BuiltOperator
from softway.solve.operators.matrix_free import nodal


@dataclass(frozen=True, slots=True, kw_only=True)
class ConjugateGradients:
    """Jacobi-preconditioned conjugate gradients with the matrix of the slab, but without a factor.

    A product with the stored matrix takes less than half of the time of one with the cells
    (:class:`~softway.solve.MatrixFree`), for 2 kB a node of hexahedra.  Best for large compact bodies in short slabs.
    Closed contact rows are eliminated inside the iteration (docs/theory/solver/elimination.md).

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
    >>> ConjugateGradients().limit
    500
    """

    tolerance: float = 1e-2
    limit: int = 500

    def __post_init__(self) -> None:
        check_products(self.tolerance, self.limit)

    def require(self, model: Model) -> None:
        """Accept every model."""

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        matrix, local = slab.operator(u), nodal(slab, u)
        times = partial(shared_product, matrix.indptr, matrix.indices, matrix.data)  # symmetric: columns are rows
        gradients = Gradients(times, local, self.tolerance, self.limit, slab.model.space.of_unknowns)
        return BuiltOperator(factor=gradients, local=local, analysis=None, price=PRICE)


PRICE = 4.0
"""Cost of the matrix, in iterations."""
