"""Conjugate gradients for the projections between meshes."""

from collections.abc import Callable

import numpy as np

from softway.arrays import Array

LIMIT = 10_000
"""Greatest number of products."""


def conjugate_gradients(
    times: Callable[[Array], Array], precondition: Callable[[Array], Array], right: Array, tolerance: float
) -> Array:
    """Solution (f,) of a positive definite system.

    Parameters
    ----------
    times
        Product of the matrix (f, f) with a vector.
    precondition
        Product of a positive definite approximation of its inverse.
    right
        (f,) right side.
    tolerance
        Residual at which it ends, relative to the right side, both in the norm of the preconditioner.  It ends after
        10 000 products, too: each iterate is nearer to the solution in the energy than the one before.

    References
    ----------
    Hestenes, Stiefel (1952), J. Res. Nat. Bur. Standards 49, 409-436.

    Examples
    --------
    >>> matrix = np.array([[2.0, 1.0], [1.0, 2.0]])
    >>> conjugate_gradients(lambda x: matrix @ x, lambda r: r / 2.0, np.array([3.0, 3.0]), 1e-12).tolist()
    [1.0, 1.0]
    """
    x, r = np.zeros_like(right), right.copy()
    z = precondition(r)
    p, rho = z, float(r @ z)
    goal = tolerance**2 * rho
    for _ in range(LIMIT):
        if rho <= goal:
            break
        q = times(p)
        share = rho / float(p @ q)
        x += share * p
        r -= share * q
        z = precondition(r)
        rho, last = float(r @ z), rho
        p = z + (rho / last) * p
    return x
