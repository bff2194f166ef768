"""Exchanges of an active set: all wrong rows at once, then single rows of least index."""

import numpy as np

from softway.arrays import BoolArray

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
