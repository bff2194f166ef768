"""Small tensors on trailing axes: (..., 3) vectors, (..., 3, 3) tensors, (..., 3, 3, 3, 3) moduli."""

import numpy as np

from softway.arrays import Array

IDENTITY: Array = np.eye(3)
IDENTITY.setflags(write=False)


def symmetric(T: Array) -> Array:
    """Symmetric part of (..., m, m)."""
    return 0.5 * (T + np.swapaxes(T, -1, -2))


def trace(T: Array) -> Array:
    """Trace of (..., 3, 3), (...,)."""
    return T[..., 0, 0] + T[..., 1, 1] + T[..., 2, 2]


def double_dot(S: Array, T: Array) -> Array:
    """``S_ij T_ij`` of two tensors (..., m, n), (...,)."""
    return np.einsum("...ij,...ij->...", S, T)


def second_invariant(T: Array) -> Array:
    """Sum of the principal minors ``((tr T)^2 - T:T)/2`` of a symmetric (..., 3, 3), (...,)."""
    xx, yy, zz, xy, yz, zx = (T[..., i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)))
    return xx * yy + yy * zz + zz * xx - xy * xy - yz * yz - zx * zx


def determinant(T: Array) -> Array:
    """Determinant of (..., m, m) with m = 1, 2, 3, (...,).

    Examples
    --------
    >>> float(determinant(2.0 * np.eye(3)))
    8.0
    """
    if T.shape[-1] == 1:
        return T[..., 0, 0]
    if T.shape[-1] == 2:
        return T[..., 0, 0] * T[..., 1, 1] - T[..., 0, 1] * T[..., 1, 0]
    a, b, c = (T[..., 0, j] for j in range(3))
    d, e, f = (T[..., 1, j] for j in range(3))
    g, h, i = (T[..., 2, j] for j in range(3))
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def symmetric_inverse(T: Array) -> Array:
    """Inverse of symmetric tensors (..., 3, 3) by cofactors; the result is exactly symmetric.

    Examples
    --------
    >>> symmetric_inverse(np.diag([1.0, 2.0, 4.0])).diagonal().tolist()
    [1.0, 0.5, 0.25]
    """
    xx, yy, zz, xy, yz, zx = (T[..., i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)))
    out = np.empty(T.shape)
    out[..., 0, 0] = yy * zz - yz * yz
    out[..., 1, 1] = zz * xx - zx * zx
    out[..., 2, 2] = xx * yy - xy * xy
    out[..., 0, 1] = out[..., 1, 0] = yz * zx - xy * zz
    out[..., 1, 2] = out[..., 2, 1] = zx * xy - yz * xx
    out[..., 2, 0] = out[..., 0, 2] = xy * yz - zx * yy
    det = xx * out[..., 0, 0] + xy * out[..., 0, 1] + zx * out[..., 0, 2]
    return out / det[..., None, None]


def square_symmetric(T: Array) -> Array:
    """``(T_ik T_jl + T_il T_jk)/2`` of a symmetric (..., 3, 3), (..., 3, 3, 3, 3)."""
    outer = T[..., :, None, :, None] * T[..., None, :, None, :]
    return 0.5 * (outer + np.swapaxes(outer, -1, -2))


def isotropic(bulk_part: float, shear: float) -> Array:
    """Moduli ``lambda d_ij d_kl + mu (d_ik d_jl + d_il d_jk)``, (3, 3, 3, 3), of the Lame constants.

    Examples
    --------
    >>> C = isotropic(1.0, 2.0)
    >>> float(C[0, 0, 0, 0]), float(C[0, 0, 1, 1]), float(C[0, 1, 0, 1])
    (5.0, 1.0, 2.0)
    """
    volumetric = IDENTITY[:, :, None, None] * IDENTITY[None, None, :, :]
    return bulk_part * volumetric + 2.0 * shear * square_symmetric(IDENTITY)


def rotation(F: Array) -> Array:
    """Rotation R of the polar decomposition ``F = R U`` (..., m, m), by Newton's iteration ``R <- (R + R^-T)/2``.

    References
    ----------
    Higham (1986), Computing the polar decomposition - with applications, SIAM J. Sci. Stat. Comput. 7, 1160-1174.

    Examples
    --------
    >>> turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    >>> rotation(turn @ np.diag([2.0, 0.5])).round(12).tolist()
    [[0.0, -1.0], [1.0, 0.0]]
    """
    R = np.array(F, float)
    for _ in range(30):
        last, R = R, 0.5 * (R + np.swapaxes(np.linalg.inv(R), -1, -2))
        if np.abs(R - last).max(initial=0.0) < 1e-8:
            break
    return R
