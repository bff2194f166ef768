"""Strain measures: the strain of a law, and the action of its stress on the body.

The deformation at a point is described by ``m`` orthonormal reference directions ``g_J`` (rows of (m, D)) and the
derivatives ``H_J = du/dX_J`` of the displacement along them (rows of (m, D)).  A volume has three directions, a plate
two, a bar one.

=========  ==============================================  =====================
measure    strain E_JL                                     carrier f_J of the stress
=========  ==============================================  =====================
Small      (g_J.H_L + g_L.H_J)/2                           g_J
Green      (g_J.H_L + g_L.H_J + H_J.H_L)/2                 g_J + H_J
=========  ==============================================  =====================

The stress S = dW/dE acts on the body through the flux ``dW/dH_J = S_JL f_L`` (first Piola-Kirchhoff).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.kernels.linalg import tensors
from softway.kernels.linalg.spectral import of_principal, principal


@dataclass(frozen=True, slots=True, kw_only=True)
class Small:
    """Linearised strain, for small displacement gradients and small rotations.

    Examples
    --------
    >>> Small().strain(np.array([[0.1, 0.2], [0.0, 0.0]]), np.eye(2)).round(12).tolist()
    [[0.1, 0.1], [0.1, 0.0]]
    """

    def strain(self, H: Array, g: Array) -> Array:
        """Strain (..., m, m)."""
        return tensors.symmetric(H @ np.swapaxes(g, -1, -2))

    def carrier(self, H: Array, g: Array) -> Array:
        """Vectors (..., m, D) along which the stress acts."""
        return np.broadcast_to(g, H.shape)

    def geometric(self, S: Array, size: int) -> Array:
        """Geometric moduli (..., m, D, m, D) due to the stress (..., m, m); D = ``size``."""
        m = S.shape[-1]
        return np.zeros((*S.shape[:-2], m, size, m, size))

    def admissible(self, H: Array, g: Array) -> BoolArray:
        """True (...,) where the deformation is admissible: everywhere."""
        return np.ones(H.shape[:-2], bool)

    def ratio(self, H: Array, g: Array, E: Array) -> Array:
        """Volume ratio det F, (...,), from H and the complete strain E (..., 3, 3)."""
        m = H.shape[-2]
        return _in_plane(H, g, 1.0 + E[..., 0, 0]) * _product(1.0 + E, m)

    def dilation(self, E: Array) -> Array:
        """Volume ratio (...,) that refers stresses to the current volume: one."""
        return np.ones(E.shape[:-2])

    def lateral(self, y: Array) -> tuple[Array, Array, Array]:
        """Normal strain as a function of its parameter y, with first and second derivative."""
        return y, np.ones_like(y), np.zeros_like(y)

    def parameters(self, E: Array) -> Array:
        """Parameters (..., m, m) of the strain: the strain itself."""
        return E


@dataclass(frozen=True, slots=True, kw_only=True)
class Green:
    """Green-Lagrange strain ``(F^T F - I)/2``: exact for every deformation, zero for rotations.

    Examples
    --------
    >>> turn = np.array([[-1.0, 1.0], [-1.0, -1.0]])  # rotation by a quarter turn, minus the identity
    >>> float(abs(Green().strain(turn, np.eye(2))).max())
    0.0
    """

    def strain(self, H: Array, g: Array) -> Array:
        """Strain (..., m, m)."""
        return tensors.symmetric((H @ np.swapaxes(g, -1, -2)) + 0.5 * (H @ np.swapaxes(H, -1, -2)))

    def carrier(self, H: Array, g: Array) -> Array:
        """Vectors (..., m, D) along which the stress acts: the deformed directions."""
        return g + H

    def geometric(self, S: Array, size: int) -> Array:
        """Geometric moduli (..., m, D, m, D) due to the stress (..., m, m); D = ``size``."""
        return S[..., :, None, :, None] * np.eye(size)[:, None, :]

    def admissible(self, H: Array, g: Array) -> BoolArray:
        """True (...,) where the deformation is admissible: where the material is not inverted."""
        return _in_plane(H, g, np.ones(H.shape[:-2])) > 0.0

    def ratio(self, H: Array, g: Array, E: Array) -> Array:
        """Volume ratio det F, (...,), from H and the complete strain E (..., 3, 3)."""
        m = H.shape[-2]
        stretch = np.sqrt(np.maximum(1.0 + 2.0 * np.diagonal(E, axis1=-2, axis2=-1), 0.0))
        return _in_plane(H, g, stretch[..., 0]) * np.prod(stretch[..., m:], axis=-1)

    def dilation(self, E: Array) -> Array:
        """Volume ratio (...,) that refers stresses to the current volume: det F."""
        return np.sqrt(tensors.determinant(tensors.IDENTITY + 2.0 * E))

    def lateral(self, y: Array) -> tuple[Array, Array, Array]:
        """Normal strain as a function of its logarithmic strain y, with first and second derivative."""
        E = 0.5 * np.expm1(2.0 * y)
        return E, 1.0 + 2.0 * E, 2.0 + 4.0 * E

    def parameters(self, E: Array) -> Array:
        """Parameters (..., m, m) of the strain: the logarithmic strain, ``nan`` where it does not exist."""
        values, axes = principal(E)
        return of_principal(0.5 * np.log1p(2.0 * np.where(values > -0.5, values, np.nan)), axes)


Measure = Small | Green


def _in_plane(H: Array, g: Array, stretch: Array) -> Array:
    """Signed volume ratio of a cell that fills its space, or the ``stretch`` of a bar in the plane or in space."""
    if H.shape[-2] == H.shape[-1]:
        return tensors.determinant(g + H) * tensors.determinant(g)
    return stretch


def _product(E: Array, m: int) -> Array:
    return np.prod(np.diagonal(E, axis1=-2, axis2=-1)[..., m:], axis=-1)
