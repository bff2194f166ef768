"""Angles of bodies about common axes: values at the end of a slab (time step), with all turns, and their moments.

``c = u . w`` and ``s = v . w`` are bilinear in directions, and ``c0 s1 - s0 c1 = cm (s1 - s0) - sm (c1 - c0)`` with the
means cm and sm is the sine of the change of the angle, so that ``phi1 - phi0 = turn . (theta_b - theta_a)`` holds
exactly (docs/theory/mechanisms.md).
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.joint_rows import mean_turned, turned

SMALL = 1e-8
"""Sine below which the ratio of an angle to it is that of its tangent."""


@uncounted
def evaluate_angles(angles, start, R0, R1, angle, turn):
    """Angles (q,) at the end from those at the ``start`` (q,), and moments ``turn`` (q, 3) on the bodies b."""
    for k in range(len(angle)):
        a, b = angles.a[k], angles.b[k]
        u, v, w = turned(R0, a, angles.U, k), turned(R0, a, angles.V, k), turned(R0, b, angles.W, k)
        c0, s0 = u[0] * w[0] + u[1] * w[1] + u[2] * w[2], v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
        u, v, w = turned(R1, a, angles.U, k), turned(R1, a, angles.V, k), turned(R1, b, angles.W, k)
        c1, s1 = u[0] * w[0] + u[1] * w[1] + u[2] * w[2], v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
        sine, cosine = c0 * s1 - s0 * c1, c0 * c1 + s0 * s1
        change, found = np.arctan2(sine, cosine), np.arctan2(s1, c1)
        angle[k] = found + 2.0 * np.pi * np.rint((start[k] + change - found) / (2.0 * np.pi))
        ratio = 1.0 / cosine if abs(sine) < SMALL else change / sine
        c, s = 0.5 * ratio * (c0 + c1), 0.5 * ratio * (s0 + s1)
        ux, uy, uz = mean_turned(R0, a, angles.U, k, u[0], u[1], u[2])
        vx, vy, vz = mean_turned(R0, a, angles.V, k, v[0], v[1], v[2])
        wx, wy, wz = mean_turned(R0, b, angles.W, k, w[0], w[1], w[2])
        x, y, z = s * ux - c * vx, s * uy - c * vy, s * uz - c * vz
        turn[k, 0], turn[k, 1], turn[k, 2] = y * wz - z * wy, z * wx - x * wz, x * wy - y * wx


@uncounted_kernel
def angles_at(angles, R0, R1, angle, turn):
    """Angles (q,) within half a turn at rotations R1, from those at the start, R0, where they are zero."""
    angle[:] = 0.0
    evaluate_angles(angles, angle, R0, R1, angle, turn)
