"""Conjugate gradients over ranks with the stored rows of the own nodes."""

from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from softway.arrays import Array
from softway.cluster.rank_force import stored_rows
from softway.marching.rules.slab_rule import Method
from softway.model.model import Model
from softway.solve.checks import check_products
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.conjugate_gradients import Gradients
from softway.solve.linear.interface import Analysis
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.operators import ConjugateGradients, Operator
from softway.solve.operators.interface import BuiltOperator
from softway.solve.operators.matrix_free import nodal

PRICE = 4.0
"""Cost of the matrix, in iterations."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnGradients:
    """:class:`~softway.solve.ConjugateGradients` on a model of a rank, with the same parameters.

    Examples
    --------
    >>> OwnGradients().limit
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
        model, dofs = slab.model, slab.model.dofs
        rows = stored_rows(model.parts, u, slab.stiffness_factor, slab.viscous_factor)

        def times(x: Array) -> Array:
            field = dofs.nodes(x)
            force = model.mass @ field
            for part, own in zip(model.parts, rows, strict=True):
                force[part.nodes] += np.asarray(own @ field[part.nodes].ravel()).reshape(-1, field.shape[1])
            return dofs.forces(model.space.filled(force))

        local = nodal(slab, u)
        gradients = Gradients(times, local, self.tolerance, self.limit, model.space.of_unknowns)
        return BuiltOperator(factor=gradients, local=local, analysis=None, price=PRICE)


def owned(operator: Operator) -> Operator:
    """Operator of a rank in place of a declared one."""
    if not isinstance(operator, ConjugateGradients):
        return operator
    return OwnGradients(tolerance=operator.tolerance, limit=operator.limit)


def declared(operator: Operator) -> Operator:
    """Operator that a rank has replaced by its own."""
    if not isinstance(operator, OwnGradients):
        return operator
    return ConjugateGradients(tolerance=operator.tolerance, limit=operator.limit)


def method_of_ranks(method: Method) -> FixedPoint:
    """Method over ranks: conjugate gradients, and no other method takes over."""
    assert isinstance(method, FixedPoint)
    given = ConjugateGradients() if method.operator == "auto" else method.operator
    return replace(method, operator=cast(Any, owned(given)), handover=False)
