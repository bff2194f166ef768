"""Small dense systems of contact rows, some of which may depend on others."""

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from softway.errors import NoConvergence
from softway.typing import Array

LIFT = 1e-11
"""Share of the greatest compliance by which dependent rows are told apart; it leaves no trace in the forces."""


def shared(matrix: Array, b: Array) -> Array:
    """Solution of a dense symmetric system; redundant rows share the force.

    The diagonal is lifted by ``LIFT`` so that dependent rows can be told apart, and the answer is refined on the
    matrix itself: consistent systems are met to rounding.  The matrix need not be positive: a part that only the
    contact holds has an indefinite compliance.

    Examples
    --------
    >>> shared(np.ones((2, 2)), np.ones(2)).round(12)
    array([0.5, 0.5])
    """
    if not len(b):
        return np.zeros(0)
    lifted = matrix + LIFT * np.abs(np.diag(matrix)).max() * np.eye(len(b))
    factor, pivots, failed = dgetrf(lifted)
    if failed:
        raise NoConvergence(f"the compliance of {len(b)} contact rows is singular")
    x = np.asarray(dgetrs(factor, pivots, b)[0], float)
    for _ in range(3):
        x = x + dgetrs(factor, pivots, b - matrix @ x)[0]
    return x
