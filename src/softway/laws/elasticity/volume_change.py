"""Volume change as a function of Green's strain, without the cancellation of ``det(I + 2 E) - 1`` at small strain."""

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors

_SERIES_BELOW = 1e-2  # |j| below which j - ln(1 + j) is a series: 10 terms have an error below 1e-17 of j^2/2


def jacobian(E: Array) -> tuple[Array, Array]:
    """``4 I2 + 8 det E`` and ``j = J^2 - 1 = 2 tr E + 4 I2 + 8 det E`` of Green's strain (..., 3, 3), (...,) each.

    Examples
    --------
    >>> float(jacobian(np.diag([0.5, 0.0, 0.0]))[1])
    1.0
    """
    higher = 4.0 * tensors.second_invariant(E) + 8.0 * tensors.determinant(E)
    return higher, 2.0 * tensors.trace(E) + higher


def inverse(E: Array) -> tuple[Array, Array]:
    """Inverse of ``C = I + 2 E`` (..., 3, 3) and ln J (...,); ``nan`` where C has no positive determinant.

    Examples
    --------
    >>> float(inverse(np.diag([0.5, 0.0, 0.0]))[0][0, 0])
    0.5
    """
    j = jacobian(E)[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = 0.5 * np.log(np.where(j > -1.0, 1.0, np.nan)) + 0.5 * np.log1p(j)
        return tensors.symmetric_inverse(tensors.IDENTITY + 2.0 * E), logarithm


def excess(j: Array) -> Array:
    """``j - ln(1 + j)`` (...,) without cancellation: ``j^2 (1/2 - j/3 + j^2/4 - ...)``.

    Examples
    --------
    >>> round(float(excess(np.array(1e-9))) * 1e18, 8)
    0.5
    """
    small = np.abs(j) < _SERIES_BELOW
    x = np.where(small, j, 0.0)
    series = np.zeros_like(x)
    for k in range(11, 1, -1):
        series = 1.0 / k - x * series
    return np.where(small, x * x * series, j - np.log1p(j))
