"""Deviators and scalar measures of plasticity, on trailing axes."""

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors

THIRD: Array = np.eye(3) / 3.0
THIRD.setflags(write=False)


def deviator(T: Array) -> Array:
    """``T - tr(T)/3 I`` of (..., 3, 3)."""
    return T - tensors.trace(T)[..., None, None] * THIRD


def equivalent_stress(s: Array) -> Array:
    """``sqrt(3/2 s:s)`` of a deviator (..., 3, 3), (...,).

    Examples
    --------
    >>> float(equivalent_stress(deviator(np.diag([2.0, 0.0, 0.0]))).round(12))
    2.0
    """
    return np.asarray(np.sqrt(1.5 * tensors.double_dot(s, s)))


def equivalent_strain(e: Array) -> Array:
    """``sqrt(2/3 e:e)`` of a deviator (..., 3, 3), (...,)."""
    return np.asarray(np.sqrt(2.0 / 3.0 * tensors.double_dot(e, e)))


def projector() -> Array:
    """Projector (3, 3, 3, 3) onto symmetric deviators."""
    return np.asarray(tensors.square_symmetric(tensors.IDENTITY) - 3.0 * np.einsum("ij,kl->ijkl", THIRD, THIRD))


def volumetric() -> Array:
    """``I x I``, (3, 3, 3, 3)."""
    return np.asarray(np.einsum("ij,kl->ijkl", tensors.IDENTITY, tensors.IDENTITY))
