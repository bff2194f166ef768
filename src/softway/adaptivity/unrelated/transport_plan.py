"""Plans that carry what the nodes of a mesh hold to those of another one: matrices with given sums of rows and columns
(docs/theory/bodies/remeshing.md#heat).
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.adaptivity.projections.conjugate_gradients import conjugate_gradients
from softway.arrays import Array, IntArray

ROUNDS = 20
"""Rounds in which rows and columns are scaled in turn."""
STEPS = 12
"""Greatest number of steps of Newton's method."""
EVEN = 1e-13
"""Defect of a sum, relative to it, at which the steps end."""
NEAR = 1e-6
"""Residual of a step of Newton's method."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TransportPlan:
    """Amounts that n places give and m places get.

    Parameters
    ----------
    amounts
        (n, m) amounts, none of which is negative.
    given, taken
        (n,) and (m,) amounts that are left over after all others, of rounding, with the same sum: each place that has
        some gives it to all places that lack some.
    """

    amounts: sp.csr_array
    given: Array
    taken: Array

    def means(self, values: Array) -> Array:
        """Means (m,) of values (n,) by the amounts that arrive.

        Examples
        --------
        >>> kernel = sp.csr_array(np.array([[1.0, 1.0], [0.0, 1.0]]))
        >>> plan = transport_plan(kernel, np.array([3.0, 1.0]), np.array([2.0, 2.0]))
        >>> plan.means(np.array([1.0, 3.0])).round(9).tolist()
        [1.0, 2.0]
        """
        whole, rest = np.asarray(self.amounts.T @ np.ones(len(values))) + self.taken, self.given.sum()
        left = float(self.given @ values) / rest if rest > 0.0 else 0.0
        return np.asarray((self.amounts.T @ values + self.taken * left) / whole)


def transport_plan(kernel: sp.csr_array, rows: Array, columns: Array) -> TransportPlan:
    """Plan with given sums whose amounts are those of a kernel, with factors of the rows and the columns.

    The factors are found by scaling rows and columns in turn (Sinkhorn and Knopp, Pacific J. Math. 21 (1967) 343), and
    then by Newton's method.  No place gives or gets more than its sum, and what is left over after that passes from all
    to all, so that the sums are those that are asked for, however near the factors are (Altschuler, Weed and Rigollet,
    NIPS 2017).

    Parameters
    ----------
    kernel
        (n, m) numbers, none of which is negative; every row and every column has one that is not zero.
    rows, columns
        (n,) and (m,) sums, positive, with the same sum.
    """
    kernel = sp.csr_array(kernel)
    back = sp.csr_array(kernel.T)
    few, parts = rows / np.asarray(kernel.sum(axis=1)), _parts(kernel)
    for _ in range(ROUNDS):
        few = rows / (kernel @ (columns / (back @ few)))
    amounts = _scaled(kernel, few, columns / (back @ few))
    for _ in range(STEPS):
        change = _newton(amounts, rows, columns, parts)
        if not change.any():
            break
        few = few * np.exp(change / max(1.0, float(np.abs(change).max())))
        amounts = _scaled(kernel, few, columns / (back @ few))
    amounts = _scaled(amounts, np.minimum(1.0, rows / amounts.sum(axis=1)), np.ones_like(columns))
    amounts = _scaled(amounts, np.ones_like(rows), np.minimum(1.0, columns / amounts.sum(axis=0)))
    given = np.maximum(rows - amounts.sum(axis=1), 0.0)
    taken = np.maximum(columns - amounts.sum(axis=0), 0.0)
    return TransportPlan(amounts=amounts, given=given, taken=taken)


def _parts(kernel: sp.csr_array) -> IntArray:
    """Number (n,) of the part of each row: rows and columns of different parts have nothing in common."""
    both = sp.block_array([[None, kernel], [kernel.T, None]], format="csr")
    return np.asarray(connected_components(both, directed=False)[1][: kernel.shape[0]])


def _newton(amounts: sp.csr_array, rows: Array, columns: Array, parts: IntArray) -> Array:
    """Changes (n,) of the logarithms of the factors of the rows, where those of the columns follow; zero if all sums
    are there.

    A part whose rows and columns ask for different sums gets what its columns ask for.
    """
    back, sums = sp.csr_array(amounts.T), amounts.sum(axis=1)
    missing = rows - sums
    missing = missing - sums * (np.bincount(parts, missing) / np.bincount(parts, sums))[parts]
    if (np.abs(missing) <= EVEN * rows).all():
        return np.zeros_like(rows)

    def times(x: Array) -> Array:
        return np.asarray(sums * x - amounts @ ((back @ x) / columns))

    return conjugate_gradients(times, lambda r: r / sums, missing, NEAR)


def _scaled(matrix: sp.csr_array, rows: Array, columns: Array) -> sp.csr_array:
    """Matrix (n, m) with factors (n,) of its rows and (m,) of its columns."""
    out = sp.csr_array(matrix.copy())
    out.data *= np.repeat(rows, np.diff(out.indptr)) * columns[out.indices]
    return out
