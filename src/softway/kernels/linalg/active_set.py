"""Active sets of rows: exchanges of all wrong rows, then of single ones; and rows that are added one by one."""

from collections.abc import Callable

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NoConvergence

SWEEPS = 30
"""Number of exchanges of all wrong rows, after which single rows are exchanged."""


def exchanged(active: BoolArray, wrong: BoolArray, sweep: int) -> BoolArray:
    """Active rows (m,) after an exchange of the ``wrong`` ones.

    Single exchanges of least index end for every symmetric positive definite compliance.

    References
    ----------
    Murty (1974), Note on a Bard-type scheme for solving the complementarity problem, Opsearch 11, 123-130.

    Examples
    --------
    >>> exchanged(np.array([True, False]), np.array([True, True]), 0)
    array([False,  True])
    >>> exchanged(np.array([True, False]), np.array([True, True]), SWEEPS)
    array([False, False])
    """
    rows = np.flatnonzero(wrong)
    out = active.copy()
    out[rows[:1] if sweep >= SWEEPS else rows] ^= True
    return out


def most_sweeps(m: int) -> int:
    """Greatest number of exchanges for m rows."""
    return SWEEPS + 4 * m


def one_by_one(
    rows: BoolArray,
    start: Array,
    floor: Array | float,
    solve: Callable[[IntArray], tuple[Array, Callable[[], Array]]],
) -> tuple[Array, BoolArray]:
    """Forces (m,) p >= 0 of some rows whose gaps are not negative, with ``p gap = 0``, and the rows (m,) that overlap
    nevertheless, since rounding leaves no force to them.

    One row is added at a time, and the least energy falls with each, so that no set comes twice even if rows depend on
    each other.

    Parameters
    ----------
    rows
        (m,) rows that may press.
    start
        (m,) forces whose positive ones are tried first.
    floor
        Overlap that is rounding.
    solve
        Forces (k,) that close the rows of an index (k,), of both signs, and a function that gives the gaps (m,) of all
        rows with them.

    Raises
    ------
    NoConvergence
        If there are no such forces.

    References
    ----------
    Lawson and Hanson (1974), Solving Least Squares Problems, chapter 23.

    Examples
    --------
    >>> bare, compliance = np.array([-1.0, -2.0]), np.array([[2.0, 1.0], [1.0, 1.0]])
    >>> def solve(index):
    ...     force = np.zeros(2)
    ...     force[index] = np.linalg.solve(compliance[np.ix_(index, index)], -bare[index])
    ...     return force[index], lambda: bare + compliance @ force
    >>> force, left = one_by_one(np.array([True, True]), np.zeros(2), 0.0, solve)
    >>> force, bool(left.any())
    (array([0., 2.]), False)
    """
    force, blocked, added = np.where(rows, np.maximum(start, 0.0), 0.0), np.zeros(len(rows), bool), -1
    active = force > 0.0
    for _ in range(most_sweeps(len(rows))):
        index = np.flatnonzero(active)
        wanted, gaps = solve(index)
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
        force[index], gap = wanted, gaps()
        wrong = rows & ~active & (gap < -floor)
        if not (wrong & ~blocked).any():
            return force, wrong
        added = int(np.argmin(np.where(wrong & ~blocked, gap, np.inf)))
        active[added] = True
        blocked[:] = False
    raise NoConvergence(f"the {len(rows)} contact rows have no solution")
