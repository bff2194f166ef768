"""Hooke's law between a strain and its conjugate stress, for Young's modulus E [Pa] and Poisson's ratio nu."""

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.elasticity.elastic_constants import lame


def energy(strain: Array, E: float, nu: float) -> Array:
    """Energy ``lambda/2 (tr e)^2 + mu e:e`` per volume (...,) [J/m^3] of a strain e (..., 3, 3)."""
    bulk_part, shear = lame(E, nu)
    return 0.5 * bulk_part * tensors.trace(strain) ** 2 + shear * tensors.double_dot(strain, strain)


def stress(strain: Array, E: float, nu: float) -> Array:
    """Stress ``lambda tr(e) I + 2 mu e``, (..., 3, 3) [Pa], of a strain e (..., 3, 3).

    Examples
    --------
    >>> stress(np.diag([0.1, 0.0, 0.0]), 2.5, 0.25).diagonal().round(12).tolist()
    [0.3, 0.1, 0.1]
    """
    bulk_part, shear = lame(E, nu)
    return (bulk_part * tensors.trace(strain))[..., None, None] * tensors.IDENTITY + 2.0 * shear * strain


def moduli(shape: tuple[int, ...], E: float, nu: float) -> Array:
    """Constant moduli, (..., 3, 3, 3, 3) [Pa], for strains of a ``shape`` (..., 3, 3); read-only."""
    return np.broadcast_to(tensors.isotropic(*lame(E, nu)), (*shape, 3, 3))
