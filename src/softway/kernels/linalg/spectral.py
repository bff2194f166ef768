"""Principal values and axes of symmetric tensors, and tensors and moduli made from them."""

from math import sqrt

import numpy as np

from softway.arrays import Array, BoolArray

_PAIRS = ((0, 1), (1, 2), (2, 0))


def principal(T: Array) -> tuple[Array, Array]:
    """Principal values (..., m) and axes (..., m, m), in columns, of symmetric tensors (..., m, m).

    The axes are orthonormal even where values are repeated.  The values of tensors that are not finite are ``nan``.

    Examples
    --------
    >>> principal(np.array([[2.0, 1.0], [1.0, 2.0]]))[0].round(12).tolist()
    [1.0, 3.0]
    """
    known: BoolArray = np.asarray(np.isfinite(T).all(axis=(-1, -2)))
    if known.all():
        values, axes = np.linalg.eigh(T)
        return values, axes
    values, axes = np.linalg.eigh(np.where(known[..., None, None], T, 0.0))
    return np.where(known[..., None], values, np.nan), axes


def of_principal(values: Array, axes: Array) -> Array:
    """Symmetric tensor (..., m, m) with the principal ``values`` (..., m) along the ``axes`` (..., m, m).

    Examples
    --------
    >>> T = np.array([[2.0, 1.0], [1.0, 2.0]])
    >>> of_principal(*principal(T)).round(12).tolist()
    [[2.0, 1.0], [1.0, 2.0]]
    """
    return (axes * values[..., None, :]) @ np.swapaxes(axes, -1, -2)


def moduli_in_axes(normal: Array, shear: Array, axes: Array) -> Array:
    """Moduli (..., 3, 3, 3, 3) without coupling of normal and shear components in the given axes.

    Parameters
    ----------
    normal
        Symmetric (..., 3, 3) with ``dS_aa = normal_ab dE_bb`` in these axes.
    shear
        Symmetric (..., 3, 3) with ``dS_ab = shear_ab dE_ab`` in these axes, for a other than b.
    axes
        (..., 3, 3) orthonormal axes in columns.

    Examples
    --------
    >>> C = moduli_in_axes(np.diag([1.0, 2.0, 3.0]), 4.0 * np.ones((3, 3)), np.eye(3))
    >>> float(C[1, 1, 1, 1]), round(float(C[0, 1, 0, 1]), 12)
    (2.0, 2.0)
    """
    q = np.swapaxes(axes, -1, -2)
    basis = [q[..., a, :, None] * q[..., a, None, :] for a in range(3)]
    for a, b in _PAIRS:
        mixed = q[..., a, :, None] * q[..., b, None, :]
        basis.append((mixed + np.swapaxes(mixed, -1, -2)) / sqrt(2.0))
    B = np.stack(basis, axis=-1)
    B = B.reshape(*B.shape[:-3], 9, 6)
    lead = np.broadcast_shapes(normal.shape[:-2], shear.shape[:-2], axes.shape[:-2])
    D = np.zeros((*lead, 6, 6))
    D[..., :3, :3] = normal
    for k, (a, b) in enumerate(_PAIRS, 3):
        D[..., k, k] = shear[..., a, b]
    return (B @ D @ np.swapaxes(B, -1, -2)).reshape(*lead, 3, 3, 3, 3)
