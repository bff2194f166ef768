"""Geometry of cells at their quadrature points."""

import numpy as np

from softway.arrays import Array


def cell_geometry(corners: Array, dN: Array, weights: Array) -> tuple[Array, Array, Array]:
    """Gradients, measures and directions at the quadrature points of cells.

    Parameters
    ----------
    corners
        (e, a, d) positions of the nodes [m].
    dN
        (q, a, r) derivatives of the shape functions along the r reference coordinates; r = d, or r = 1 for lines in
        space.
    weights
        (q,) quadrature weights of the reference cell.

    Returns
    -------
    gradients
        (e, q, a, r) derivatives of the shape functions along the directions [1/m].
    measures
        (e, q) length, area or volume of the points [m^r].
    directions
        (e, q, r, d) orthonormal directions: the axes of space, or the tangent of a line.

    Examples
    --------
    A line of length 2 along y with one point:

    >>> corners = np.array([[[0.0, 0.0], [0.0, 2.0]]])
    >>> gradients, measures, directions = cell_geometry(corners, np.array([[[-1.0], [1.0]]]), np.array([1.0]))
    >>> gradients.ravel().tolist(), measures.ravel().tolist(), directions.ravel().tolist()
    ([-0.5, 0.5], [2.0], [0.0, 1.0])
    """
    jacobian = np.einsum("ead,qar->eqrd", corners, dN)  # dX_d / d xi_r
    if jacobian.shape[-1] == jacobian.shape[-2]:
        measures = np.linalg.det(jacobian)
        gradients = np.swapaxes(np.linalg.solve(jacobian, np.swapaxes(dN, -1, -2)[None]), -1, -2)
        directions = np.broadcast_to(np.eye(jacobian.shape[-1]), jacobian.shape)
    else:
        measures = np.linalg.norm(jacobian[..., 0, :], axis=-1)
        gradients = dN[None] / measures[..., None, None]
        directions = jacobian / measures[..., None, None]
    return gradients, measures * weights, directions


def determinants(matrices: Array) -> Array:
    """Determinants (...,) of matrices (..., k, k), k up to 3.

    Examples
    --------
    >>> determinants(np.array([[[2.0, 1.0], [1.0, 3.0]]])).tolist()
    [5.0]
    """
    m, k = matrices, matrices.shape[-1]
    if k == 1:
        return np.asarray(m[..., 0, 0])
    if k == 2:
        return np.asarray(m[..., 0, 0] * m[..., 1, 1] - m[..., 0, 1] * m[..., 1, 0])
    minors = [m[..., 1, i] * m[..., 2, j] - m[..., 1, j] * m[..., 2, i] for i, j in ((1, 2), (2, 0), (0, 1))]
    return np.asarray(m[..., 0, 0] * minors[0] + m[..., 0, 1] * minors[1] + m[..., 0, 2] * minors[2])
