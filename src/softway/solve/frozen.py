"""The frozen operator of a slab with the compliance of the contact rows, and the carry that keeps it."""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.solve.linear import Factor, LinearSolver
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Frozen:
    """A factored operator A and the columns ``A^-1 G^T`` of the contact rows, computed when first asked for.

    The columns are a cache: they depend on A and G only, so the answer does not depend on when they were made.
    """

    factor: Factor
    rows: sp.csr_array
    columns: dict[int, Array] = field(default_factory=dict)

    def solve(self, b: Array) -> Array:
        """A^-1 b."""
        return self.factor.solve(b)

    def compliance(self, active: IntArray) -> Array:
        """Columns A^-1 G^T (f, k) of the active rows."""
        missing = [i for i in active.tolist() if i not in self.columns]
        if missing:
            new = self.factor.solve(np.ascontiguousarray(self.rows[missing].toarray().T))
            self.columns.update({i: new[:, k] for k, i in enumerate(missing)})
        if not len(active):
            return np.zeros((self.rows.shape[1], 0))
        return np.stack([self.columns[i] for i in active.tolist()], axis=1)


def freeze(matrix: sp.csc_array, rows: sp.csr_array, solver: LinearSolver) -> Frozen:
    """Factor an operator for slabs of one length."""
    return Frozen(solver.factor(matrix), rows)


@dataclass(frozen=True, slots=True, eq=False)
class Carry:
    """What is kept between slabs besides the state, all of it disposable: one frozen operator for a slab length.

    ``span`` is the length that ``frozen`` belongs to; ``stale`` asks for a new factor at the next slab.
    """

    frozen: Frozen | None = None
    span: float = 0.0
    stale: bool = False
    factorisations: int = 0
