"""Protocol of operators of the fixed point: approximate inverses of ``M + h^2/2 mu2 K``, kept for many slabs."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from softway.arrays import Array
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator, RowBasis
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.interface import Analysis, Factor


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BuiltOperator:
    """Operator for use in slabs.

    Parameters
    ----------
    factor
        Solves linear systems.
    local
        Solves for contact forces if solutions with ``factor`` are not reproducible to machine precision.
    analysis
        Symbolic work, kept for the next operator.
    price
        Cost of making the operator, in iterations of the fixed point.
    kind
        Number type that represents its solutions without loss.
    """

    factor: Factor
    local: Factor | None
    analysis: Analysis | None
    price: float
    kind: type[np.floating[Any]] = np.float64

    def frozen(self, directions: RowBasis) -> FrozenOperator:
        """Frozen operator with the given contact directions."""
        return FrozenOperator(self.factor, directions, local=self.local, kind=self.kind)


class Operator(Protocol):
    """Declared kind of operator."""

    def require(self, model: Model) -> None:
        """Refuse a model for which the operator cannot be made on this machine.

        Raises
        ------
        InputError
            With the parameter.
        """
        ...

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """Make the operator of a slab at the displacement ``u`` (n, d), with the symbolic work of the last operator.

        Raises
        ------
        NoConvergence
            If the operator cannot be made.
        """
        ...
