"""Rotations of rigid bodies in a slab (time step): Cayley's map of the rotation vector, quaternions, inertia.

With ``C = cay(theta)`` every point X of a body moves by ``(C - 1) R0 X = theta x (R0 + R1)/2 X``: the arm is the mean
of its ends (docs/theory/mechanisms.md).
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted


@uncounted
def cayley_turned(z, R0, R1, i):
    """``R1[i] = cay(theta) R0[i]``; the rotation vector ``theta = z[i, 3:]`` has the magnitude ``2 tan(angle/2)``."""
    x, y, z = 0.5 * z[i, 3], 0.5 * z[i, 4], 0.5 * z[i, 5]
    scale = 2.0 / (1.0 + x * x + y * y + z * z)
    for j in range(3):
        a, b, c = R0[i, 0, j], R0[i, 1, j], R0[i, 2, j]
        p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
        R1[i, 0, j] = a + scale * (p + y * r - z * q)
        R1[i, 1, j] = b + scale * (q + z * p - x * r)
        R1[i, 2, j] = c + scale * (r + x * q - y * p)


@uncounted
def quaternion_turned(z, turn, i):
    """Turn the unit quaternion ``turn[i]``, scalar first, by ``cay(z[i, 3:])``."""
    x, y, z = 0.5 * z[i, 3], 0.5 * z[i, 4], 0.5 * z[i, 5]
    a, b, c, d = turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3]
    p, q = a - x * b - y * c - z * d, b + x * a + y * d - z * c
    r, s = c + y * a + z * b - x * d, d + z * a + x * c - y * b
    size = np.sqrt(p * p + q * q + r * r + s * s)
    turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3] = p / size, q / size, r / size, s / size


@uncounted
def matrix_of(turn, R, i):
    """Rotation matrix ``R[i]`` of the unit quaternion ``turn[i]``."""
    a, b, c, d = turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3]
    R[i, 0, 0], R[i, 0, 1], R[i, 0, 2] = 1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)
    R[i, 1, 0], R[i, 1, 1], R[i, 1, 2] = 2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)
    R[i, 2, 0], R[i, 2, 1], R[i, 2, 2] = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)


@uncounted
def in_space(R, own, i, out):
    """``out[i] = R[i] own[i] R[i]^T``: a tensor in the axes of the body, turned into those of space."""
    for j in range(3):
        x = R[i, j, 0] * own[i, 0, 0] + R[i, j, 1] * own[i, 1, 0] + R[i, j, 2] * own[i, 2, 0]
        y = R[i, j, 0] * own[i, 0, 1] + R[i, j, 1] * own[i, 1, 1] + R[i, j, 2] * own[i, 2, 1]
        z = R[i, j, 0] * own[i, 0, 2] + R[i, j, 1] * own[i, 1, 2] + R[i, j, 2] * own[i, 2, 2]
        for k in range(3):
            out[i, j, k] = x * R[i, k, 0] + y * R[i, k, 1] + z * R[i, k, 2]
