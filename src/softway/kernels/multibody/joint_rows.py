"""Rows of joints between rigid bodies: values at the end of a slab (time step), and Jacobians at the means of its ends.

Each row g is at most bilinear in places and directions, so that ``g1 - g0 = G (d, theta)`` holds exactly with the
Jacobian G at the means (docs/theory/mechanisms.md).  A row has the bodies a and b, the points X of a and Y of b, and
the directions N of a and B of b, all in the axes of their bodies.
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted

POINT = 0
"""``e . (p_b - p_a) = c`` along the direction e = N, fixed in space."""
ALONG = 1
"""``n . (p_b - p_a) = c`` along the direction n = N of body a."""
DIRECTION = 2
"""``n . m = c`` for the directions n = N of body a and m = B of body b."""
DISTANCE = 3
"""``(|p_b - p_a|^2 - c^2) / (2 c) = 0``."""
ANGLE = 4
"""Only angles that :func:`add_angles` adds."""
SLIDE = 5
"""Sliding along the direction B of body a at the place of contact ``p_b - c n`` with n = N of body a; no value."""
ROLL = 6
"""Sliding across the line between the points, at ``p_a + c (p_b - p_a)``; along the first or second direction B[0]."""
TURN = 7
"""Turning of b against a about the direction B of body a; no value."""
TWIST = 8
"""Turning of b against a about the first or second direction B[0] across the line between the points, or about it."""


@uncounted
def joint_row(joints, k, place0, R0, place1, R1, g, G):
    """Value ``g[k]`` at the end and Jacobian ``G[k]`` (2, 6) at the means: for the sides a and b, along d and theta."""
    kind, a, b, value = joints.kind[k], joints.a[k], joints.b[k], joints.value[k]
    X, Y, N = joints.X, joints.Y, joints.N
    if kind == DIRECTION:
        _direction_row(joints, k, R0, R1, g, G)
        return
    if kind == ANGLE:
        _angle_row(joints, k, g, G)
        return
    if kind >= SLIDE:
        _sliding_row(joints, k, place0, R0, place1, R1, g, G)
        return
    # arms at the end and at the mean, and the vector between the points at the end and at the mean
    xa, ya, za = turned(R1, a, X, k)
    xb, yb, zb = turned(R1, b, Y, k)
    ax, ay, az = mean_turned(R0, a, X, k, xa, ya, za)
    bx, by, bz = mean_turned(R0, b, Y, k, xb, yb, zb)
    dx, dy, dz = place1[b, 0] - place1[a, 0], place1[b, 1] - place1[a, 1], place1[b, 2] - place1[a, 2]
    ex, ey, ez = dx + xb - xa, dy + yb - ya, dz + zb - za
    sx = 0.5 * (place0[b, 0] - place0[a, 0] + dx) + bx - ax
    sy = 0.5 * (place0[b, 1] - place0[a, 1] + dy) + by - ay
    sz = 0.5 * (place0[b, 2] - place0[a, 2] + dz) + bz - az
    tx, ty, tz = N[k, 0], N[k, 1], N[k, 2]
    px, py, pz = 0.0, 0.0, 0.0  # moment on body a of a direction that turns with it
    if kind == POINT:
        g[k] = tx * ex + ty * ey + tz * ez - value
    elif kind == ALONG:
        nx, ny, nz = turned(R1, a, N, k)
        g[k] = nx * ex + ny * ey + nz * ez - value
        tx, ty, tz = mean_turned(R0, a, N, k, nx, ny, nz)
        px, py, pz = ty * sz - tz * sy, tz * sx - tx * sz, tx * sy - ty * sx
    else:
        g[k] = (ex * ex + ey * ey + ez * ez - value * value) / (2.0 * value)
        tx, ty, tz = sx / value, sy / value, sz / value
    G[k, 0, 0], G[k, 0, 1], G[k, 0, 2] = -tx, -ty, -tz
    G[k, 1, 0], G[k, 1, 1], G[k, 1, 2] = tx, ty, tz
    G[k, 0, 3], G[k, 0, 4], G[k, 0, 5] = px - (ay * tz - az * ty), py - (az * tx - ax * tz), pz - (ax * ty - ay * tx)
    G[k, 1, 3], G[k, 1, 4], G[k, 1, 5] = by * tz - bz * ty, bz * tx - bx * tz, bx * ty - by * tx


@uncounted
def _direction_row(joints, k, R0, R1, g, G):
    """Row of two directions."""
    a, b, N, B = joints.a[k], joints.b[k], joints.N, joints.B
    xa, ya, za = turned(R1, a, N, k)
    xb, yb, zb = turned(R1, b, B, k)
    g[k] = xa * xb + ya * yb + za * zb - joints.value[k]
    ax, ay, az = mean_turned(R0, a, N, k, xa, ya, za)
    bx, by, bz = mean_turned(R0, b, B, k, xb, yb, zb)
    px, py, pz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    for side in range(2):
        for i in range(3):
            G[k, side, i] = 0.0
    G[k, 0, 3], G[k, 0, 4], G[k, 0, 5] = px, py, pz
    G[k, 1, 3], G[k, 1, 4], G[k, 1, 5] = -px, -py, -pz


@uncounted
def _angle_row(joints, k, g, G):
    """Row without any places."""
    g[k] = -joints.value[k]
    for side in range(2):
        for i in range(6):
            G[k, side, i] = 0.0


@uncounted
def add_angles(joints, k, angle, turn, g, G):
    """Add the angles of a row, with their factors, to its value and its Jacobian."""
    for t in range(2):
        q = joints.angle[k, t]
        if q >= 0:
            ratio = joints.ratio[k, t]
            g[k] += ratio * angle[q]
            for c in range(3):
                if t == 1:
                    G[k, 2, 3 + c], G[k, 3, 3 + c] = 0.0, 0.0
                G[k, 2 * t, 3 + c] -= ratio * turn[q, c]
                G[k, 2 * t + 1, 3 + c] += ratio * turn[q, c]


@uncounted
def _sliding_row(joints, k, place0, R0, place1, R1, g, G):
    """Row of the sliding of b against a along a tangential direction: equal forces at the mean place of contact."""
    if joints.kind[k] >= TURN:
        _turning_row(joints, k, place0, R0, place1, R1, g, G)
        return
    a, b, value = joints.a[k], joints.b[k], joints.value[k]
    xa, ya, za = turned(R1, a, joints.X, k)
    xb, yb, zb = turned(R1, b, joints.Y, k)
    ax, ay, az = mean_turned(R0, a, joints.X, k, xa, ya, za)
    bx, by, bz = mean_turned(R0, b, joints.Y, k, xb, yb, zb)
    cx, cy, cz = (
        0.5 * (place0[b, 0] + place1[b, 0] - place0[a, 0] - place1[a, 0]),
        0.5 * (place0[b, 1] + place1[b, 1] - place0[a, 1] - place1[a, 1]),
        0.5 * (place0[b, 2] + place1[b, 2] - place0[a, 2] - place1[a, 2]),
    )
    if joints.kind[k] == SLIDE:
        nx, ny, nz = turned(R1, a, joints.N, k)
        nx, ny, nz = mean_turned(R0, a, joints.N, k, nx, ny, nz)
        tx, ty, tz = turned(R1, a, joints.B, k)
        tx, ty, tz = mean_turned(R0, a, joints.B, k, tx, ty, tz)
        bx, by, bz = bx - value * nx, by - value * ny, bz - value * nz
    else:
        sx, sy, sz = cx + bx - ax, cy + by - ay, cz + bz - az
        tx, ty, tz = _across(sx, sy, sz, joints.B[k, 0])
        bx, by, bz = bx - (1.0 - value) * sx, by - (1.0 - value) * sy, bz - (1.0 - value) * sz
    ax, ay, az = cx + bx, cy + by, cz + bz  # the same place from the centre of a
    g[k] = 0.0
    G[k, 0, 0], G[k, 0, 1], G[k, 0, 2] = -tx, -ty, -tz
    G[k, 1, 0], G[k, 1, 1], G[k, 1, 2] = tx, ty, tz
    G[k, 0, 3], G[k, 0, 4], G[k, 0, 5] = az * ty - ay * tz, ax * tz - az * tx, ay * tx - ax * ty
    G[k, 1, 3], G[k, 1, 4], G[k, 1, 5] = by * tz - bz * ty, bz * tx - bx * tz, bx * ty - by * tx


@uncounted
def _turning_row(joints, k, place0, R0, place1, R1, g, G):
    """Row of the turning of b against a: opposite moments about a direction."""
    a, b = joints.a[k], joints.b[k]
    if joints.kind[k] == TURN:
        tx, ty, tz = turned(R1, a, joints.B, k)
        tx, ty, tz = mean_turned(R0, a, joints.B, k, tx, ty, tz)
    else:
        xa, ya, za = turned(R1, a, joints.X, k)
        xb, yb, zb = turned(R1, b, joints.Y, k)
        ax, ay, az = mean_turned(R0, a, joints.X, k, xa, ya, za)
        bx, by, bz = mean_turned(R0, b, joints.Y, k, xb, yb, zb)
        tx, ty, tz = _across(
            0.5 * (place0[b, 0] + place1[b, 0] - place0[a, 0] - place1[a, 0]) + bx - ax,
            0.5 * (place0[b, 1] + place1[b, 1] - place0[a, 1] - place1[a, 1]) + by - ay,
            0.5 * (place0[b, 2] + place1[b, 2] - place0[a, 2] - place1[a, 2]) + bz - az,
            joints.B[k, 0],
        )
    g[k] = 0.0
    for side in range(2):
        for c in range(3):
            G[k, side, c] = 0.0
    G[k, 0, 3], G[k, 0, 4], G[k, 0, 5] = -tx, -ty, -tz
    G[k, 1, 3], G[k, 1, 4], G[k, 1, 5] = tx, ty, tz


@uncounted
def _across(x, y, z, which):
    """Unit direction across a vector, the first (0) or second (1), or along it (2).

    In the plane the first is that of its right angle, and the second that of the normal of the plane.
    """
    length = np.sqrt(x * x + y * y + z * z)
    if length == 0.0:  # the points coincide: the stop is open, and its rows do not matter
        x, length = 1.0, 1.0
    x, y, z = x / length, y / length, z / length
    if which > 1.0:
        return x, y, z
    u, v, w = -y, x, 0.0
    if abs(z) > 0.9:
        u, v, w = 0.0, -z, y
    size = np.sqrt(u * u + v * v + w * w)
    u, v, w = u / size, v / size, w / size
    if which > 0.0:
        return y * w - z * v, z * u - x * w, x * v - y * u
    return u, v, w


@uncounted
def turned(R, i, x, k):
    """``R[i] x[k]`` as three numbers."""
    u, v, w = x[k, 0], x[k, 1], x[k, 2]
    return (
        R[i, 0, 0] * u + R[i, 0, 1] * v + R[i, 0, 2] * w,
        R[i, 1, 0] * u + R[i, 1, 1] * v + R[i, 1, 2] * w,
        R[i, 2, 0] * u + R[i, 2, 1] * v + R[i, 2, 2] * w,
    )


@uncounted
def turned_back(R, i, u, v, w):
    """``R[i]^T (u, v, w)`` as three numbers."""
    return (
        R[i, 0, 0] * u + R[i, 1, 0] * v + R[i, 2, 0] * w,
        R[i, 0, 1] * u + R[i, 1, 1] * v + R[i, 2, 1] * w,
        R[i, 0, 2] * u + R[i, 1, 2] * v + R[i, 2, 2] * w,
    )


@uncounted
def mean_turned(R0, i, x, k, x1, y1, z1):
    """Mean of ``R0[i] x[k]`` and its value at the end."""
    x0, y0, z0 = turned(R0, i, x, k)
    return 0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1)
