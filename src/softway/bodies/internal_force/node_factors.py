"""Factors of the stiffness at the nodes."""

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array
from softway.bodies.internal_force.body_force import BodyForce


def scaled_matrix(matrix: csc_array, factor: Array | None) -> csc_array:
    """Matrix ``sqrt(f_i f_j) K_ij`` (n d, n d) with factors f (n,) of the nodes; the matrix itself without any.

    It is symmetric, and positive where K is; of the stiffness with a factor that changes little along an element it is
    close to the exact one.

    Examples
    --------
    >>> bar = csc_array(np.array([[1.0, -1.0], [-1.0, 1.0]]))
    >>> scaled_matrix(bar, np.array([1.0, 4.0])).toarray().tolist()
    [[1.0, -2.0], [-2.0, 4.0]]
    """
    if factor is None:
        return matrix
    scale = np.repeat(np.sqrt(factor), matrix.shape[0] // len(factor))
    data = matrix.data * scale[matrix.indices] * np.repeat(scale, np.diff(matrix.indptr))
    return csc_array((data, matrix.indices, matrix.indptr), matrix.shape)


def scaled_product(internal: BodyForce, factor: Array | None, u: Array, w: Array) -> Array:
    """Product (n, d) [N] of the :func:`scaled_matrix` of the tangent of a body at u with w (n, d) [m]."""
    if factor is None:
        return internal.tangent_product(u, w)
    scale = np.sqrt(factor)[:, None]
    return np.asarray(scale * internal.tangent_product(u, scale * w))


def scaled_blocks(internal: BodyForce, factor: Array | None, u: Array) -> Array:
    """Diagonal blocks (n, d, d) of the :func:`scaled_matrix` of the tangent of a body at u (n, d) [N/m]."""
    blocks = internal.tangent_diagonal_blocks(u)
    return blocks if factor is None else factor[:, None, None] * blocks
