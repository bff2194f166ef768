"""The frozen operator of a slab with the compliance of the contact rows, and the carry that keeps it."""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from softway.solve.linear import Factor, LinearSolver
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Compliance:
    """Columns ``A^-1 G^T`` (f, k) of the active rows and their Delassus matrix ``G A^-1 G^T`` (k, k)."""

    columns: Array
    delassus: Array


@dataclass(frozen=True, slots=True, eq=False)
class Frozen:
    """A factored operator A and the compliance of the contact rows, computed when first asked for.

    ``columns`` (of each row: ``A^-1 G^T`` (f,) and ``G A^-1 G^T`` (m,)) and ``latest`` are caches of values that depend
    on A and G only, so the answer does not depend on when they were made.
    """

    factor: Factor
    rows: sp.csr_array
    columns: dict[int, tuple[Array, Array]] = field(default_factory=dict)
    latest: dict[bytes, Compliance] = field(default_factory=dict)

    def solve(self, b: Array) -> Array:
        """A^-1 b."""
        return self.factor.solve(b)

    def compliance(self, active: IntArray) -> Compliance:
        """Compliance of the active rows (k,), kept until it is asked for other rows."""
        key = active.tobytes()
        if key not in self.latest:
            delassus = self.delassus(active)
            columns = np.empty((len(active), self.rows.shape[1]))
            for k, i in enumerate(active.tolist()):
                columns[k] = self.columns[i][0]
            self.latest.clear()
            self.latest[key] = Compliance(columns=columns.T, delassus=delassus)
        return self.latest[key]

    def delassus(self, active: IntArray) -> Array:
        """``G A^-1 G^T`` (k, k) of the active rows; new columns are solved for in one batch."""
        missing = [i for i in active.tolist() if i not in self.columns]
        if missing:
            new = np.ascontiguousarray(self.factor.solve(np.ascontiguousarray(self.rows[missing].toarray().T)).T)
            self.columns.update({i: (column, self.rows @ column) for i, column in zip(missing, new, strict=True)})
        out = np.empty((len(active), len(active)))
        for k, i in enumerate(active.tolist()):
            out[:, k] = self.columns[i][1][active]
        return out


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
