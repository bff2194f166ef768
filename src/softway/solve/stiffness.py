"""The matrix of a slab: inertia and stiffness of the free components."""

from dataclasses import dataclass

import scipy.sparse as sp

from softway.model import Model
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stiffness:
    """``M + share K(u)`` of a model, whose matter remembers what was before the slab; ``share`` is in s^2.

    What the mean rate makes of the stiffness counts ``again`` so often between nodes with inertia.
    """

    model: Model
    share: float
    again: float

    def operator(self, u: Array, secant: bool = False) -> sp.csc_array:
        """The matrix (f, f) at the displacement u (n, d), symmetric positive definite near equilibrium."""
        return self.model.inertia_and_stiffness(u, self.share, secant, self.again)
