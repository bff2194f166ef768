"""Rows that depend on each other: which of them to close, so that those that are closed are independent.

Where all edges of two surfaces have rows, many of these hold the same motion, with gaps that differ by their rounding
or more.  Sets that are exchanged row by row then go round in circles.  The rows to close next are those that press in
the step of least energy against the nodal blocks alone (docs/theory/solver/elimination.md).
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, greatest
from softway.errors import NoConvergence
from softway.kernels.linalg.active_set import most_sweeps
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

        Notes
        -----
        One row is added at a time, and the least energy falls with each, so that no set comes twice even if rows depend
        on each other (Lawson and Hanson 1974, Solving Least Squares Problems, chapter 23).

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
        force = np.where(self.rows, np.maximum(start, 0.0), 0.0)
        active, blocked, added = force > 0.0, np.zeros(len(force), bool), -1
        for _ in range(most_sweeps(len(force))):
            index = np.flatnonzero(active)
            wanted = solve_dense(self.compliance[index][:, index].toarray(), -bare[index])
            if len(index) and wanted.min() <= 0.0:
                low = index[wanted <= 0.0]
                if added in low:
                    active[added], blocked[added], added = False, True, -1
                    continue
                part = force[low] / np.maximum(force[low] - wanted[wanted <= 0.0], 1e-300)
                force[index] += part.min() * (wanted - force[index])
                gone = low[part <= part.min()]
                force[gone], active[gone] = 0.0, False
                continue
            force[index] = wanted
            gap = bare + self.compliance @ np.where(active, force, 0.0)
            if greatest(gap[index]) > max(MISSED * greatest(bare), self.floor):
                break
            wrong = self.rows & ~active & ~blocked & (gap < -self.floor)
            if not wrong.any():
                return active
            added = int(np.argmin(np.where(wrong, gap, np.inf)))
            active[added] = True
            blocked[:] = False
        raise NoConvergence(f"the {len(force)} contact rows have no solution")
