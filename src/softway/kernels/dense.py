"""Small dense systems of contact rows, some of which may depend on others."""

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from softway.errors import NoConvergence
from softway.typing import Array

LIFT = 1e-11
"""Share of the greatest compliance by which dependent rows are told apart; it leaves no trace in the forces."""


def shared(matrix: Array, b: Array) -> Array:
    """Solution of a dense symmetric positive semidefinite system; redundant rows share the force.

    The diagonal is lifted by ``LIFT`` so that dependent rows can be told apart, and the answer is refined on the
    matrix itself: consistent systems are met to rounding.

    Examples
    --------
    >>> shared(np.ones((2, 2)), np.ones(2)).round(12)
    array([0.5, 0.5])
    """
    if not len(b):
        return np.zeros(0)
    lifted = matrix + LIFT * np.diag(matrix).max() * np.eye(len(b))
    try:
        factor = cho_factor(lifted, check_finite=False)
    except LinAlgError:
        raise NoConvergence("the compliance of the contact rows is not positive") from None
    x = np.asarray(cho_solve(factor, b, check_finite=False), float)
    for _ in range(3):
        x = x + cho_solve(factor, b - matrix @ x, check_finite=False)
    return x
