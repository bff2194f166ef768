"""What an operator of the fixed point is: a crude inverse of ``M + h^2/2 mu2 K``, kept for many slabs."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from softway.solve.frozen import Basis, Frozen
from softway.solve.linear import Analysis, Factor
from softway.solve.stiffness import Stiffness
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Made:
    """An operator that was made.

    ``factor`` solves; ``local`` answers contact pushes where the answers of ``factor`` are not alike to the last digit;
    ``analysis`` is kept for the next time; ``price`` is what making it costs, in iterations of the fixed point;
    ``kind`` is the type of number that carries all its digits.
    """

    factor: Factor
    local: Factor | None
    analysis: Analysis | None
    price: float
    kind: type[np.floating[Any]] = np.float64

    def frozen(self, directions: Basis) -> Frozen:
        """The operator with contact along some directions."""
        return Frozen(self.factor, directions, local=self.local, kind=self.kind)


class Operator(Protocol):
    """A way to make operators."""

    def make(self, slab: Stiffness, u: Array, analysis: Analysis | None) -> Made:
        """The operator of a slab at the displacement ``u`` (n, d), with the symbolic work of the last one.

        Raises
        ------
        NoConvergence
            If it cannot be made.
        """
        ...
