"""Rows that depend on each other: which of them to close, so that those that are closed are independent.

Where all edges of two surfaces have rows, many of these hold the same motion, with gaps that differ by their rounding
or more.  Sets that are exchanged row by row then go round in circles.  The rows to close next are those that press in
the step of least energy against the nodal blocks alone (docs/theory/solver/elimination.md).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray, greatest
from softway.errors import NoConvergence
from softway.kernels.linalg.active_set import one_by_one
from softway.kernels.linalg.dense import solve_dense

MISSED = 1e-6
"""Distance of closed rows from their targets, relative to the greatest one without forces: no forces reach these."""


@dataclass(frozen=True, slots=True, eq=False)
class LocalContact:
    """Contact of some ``rows`` (m,) against the nodal blocks alone.

    Parameters
    ----------
    compliance
        (m, m) sparse ``S = G D^-1 G^T`` of all rows.
    rows
        (m,) rows that may press.
    floor
        Overlap that is rounding.
    """

    compliance: sp.csr_array
    rows: BoolArray
    floor: float

    def pressing(self, bare: Array, start: Array) -> BoolArray:
        """Independent rows (m,) with a force p > 0 where ``p >= 0``, ``b + S p >= 0`` and ``p (b + S p) = 0``.

        Parameters
        ----------
        bare
            (m,) distances b from the targets without forces.
        start
            (m,) forces whose positive ones are tried first.

        Raises
        ------
        NoConvergence
            If there are no such forces.

        Examples
        --------
        >>> twice = LocalContact(sp.csr_array(np.ones((2, 2))), np.array([True, True]), 0.0)
        >>> twice.pressing(np.array([-1.0, -2.0]), np.zeros(2))
        array([False,  True])
        """

        def solve(index: IntArray) -> tuple[Array, Callable[[], Array]]:
            force = np.zeros(len(bare))
            force[index] = solve_dense(self.compliance[index][:, index].toarray(), -bare[index])
            return force[index], lambda: self._reached(bare, bare + self.compliance @ force, index)

        force, _ = one_by_one(self.rows, start, self.floor, solve)
        return np.asarray(force > 0.0)

    def _reached(self, bare: Array, gap: Array, index: IntArray) -> Array:
        """Gaps (m,) with forces that close the rows of an index (k,); an error if they miss these."""
        if greatest(gap[index]) > max(MISSED * greatest(bare), self.floor):
            raise NoConvergence(f"the {len(gap)} contact rows have no solution")
        return gap
