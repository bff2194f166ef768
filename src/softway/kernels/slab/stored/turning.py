"""Operators that turn with the nodes, as in :mod:`softway.solve.operators.nodal_rotation`.

The operator of a slab (time step) is ``R A R^T``, where R contains the rotation of the material around each node since
A was factored.
"""

import numpy as np

from softway.kernels.jit.compilation import called
from softway.kernels.slab.products import add_impulse, spread
from softway.kernels.slab.solution import solve_with
from softway.kernels.slab.stored.tables import MIXED, NOW, STRAIGHT, TURNED, UNKNOWN

CLEAR = 1e-6
"""Relative distance of a rotation from its limit at which it is certainly beyond it, or below."""
STEPS = 30
"""Greatest number of steps of Newton's iteration for a rotation."""
DEPENDENT = 1e-9
"""Pivot of a compliance, relative to its diagonal, below which closed rows depend on each other."""


@called
def turn(bodies, rows, operator, turning, u, x):
    """Set the rotations at the start of a slab, and the answers of closed rows in axes that turn; false if a decision
    is close, or constant axes are given up.

    ``x`` (f,) is work space.
    """
    state = _rotations(bodies, turning, u)
    turning.state[NOW] = state
    if state == UNKNOWN or (state == TURNED and not turning.state[MIXED]):
        return False
    if not turning.state[MIXED]:
        return True
    for k in range(len(operator.active)):
        x[:] = 0.0
        add_impulse(bodies, rows, operator.active[k], 1.0, x)
        solve_turned(bodies, operator, turning, x)
        spread(bodies, x, operator.answer[k])
    return _inverted(rows, operator, turning)


@called
def solve_turned(bodies, operator, turning, x):
    """Solve in place with the operator of the slab, x (f,)."""
    if turning.state[NOW] == TURNED:
        _rotate(bodies, turning, x, True)
        solve_with(operator, x)
        _rotate(bodies, turning, x, False)
    else:
        solve_with(operator, x)


@called
def _rotations(bodies, turning, u):
    """Set the rotations (n, d, d) at the displacement u (N,); what has happened to the axes."""
    n, d, R = len(turning.free), bodies.dimension, turning.rotation
    moved = _gradients(bodies, turning, u)
    if moved < 1.0 - CLEAR:
        return STRAIGHT
    total = 0.0
    for i in range(n):
        if turning.free[i]:
            _turned_by(R[i], turning.inverse[i])
        for a in range(d):
            for b in range(d):
                one = 1.0 if a == b else 0.0
                R[i, a, b] = R[i, a, b] if turning.free[i] and np.isfinite(R[i, a, b]) else one
                total += (R[i, a, b] - one) ** 2
    rotated = np.sqrt(total / (n * d)) / turning.limit[0]
    if not (abs(moved - 1.0) > CLEAR and abs(rotated - 1.0) > CLEAR):
        return UNKNOWN
    return TURNED if rotated > 1.0 else STRAIGHT


@called
def _gradients(bodies, turning, u):
    """Set the deformation gradients (n, d, d) in the place of the rotations; their change, relative to the limit."""
    n, d, F, total = len(turning.free), bodies.dimension, turning.rotation, 0.0
    for i in range(n):
        for a in range(d):
            for b in range(d):
                slope = 1.0 if a == b else 0.0
                for e in range(turning.start[i], turning.start[i + 1]):
                    slope += turning.slope[e, b] * u[turning.node[e] * d + a]
                F[i, a, b] = slope
                total += (slope - turning.before[i, a, b]) ** 2
    return np.sqrt(total / (n * d)) / turning.limit[0]


@called
def _turned_by(F, inverse):
    """Replace a deformation gradient (d, d) by the rotation in its change from the one with this inverse."""
    d = len(F)
    a, b, c = F[0, 0], F[0, 1], F[1, 0]
    if d == 2:
        e = F[1, 1]
        p, q = a * inverse[0, 0] + b * inverse[1, 0], a * inverse[0, 1] + b * inverse[1, 1]
        r, t = c * inverse[0, 0] + e * inverse[1, 0], c * inverse[0, 1] + e * inverse[1, 1]
        size = np.hypot(p + t, r - q)
        F[0, 0] = F[1, 1] = (p + t) / size
        F[1, 0] = (r - q) / size
        F[0, 1] = -F[1, 0]
        return
    f, g, h, k, m, o = F[0, 2], F[1, 1], F[1, 2], F[2, 0], F[2, 1], F[2, 2]
    for j in range(3):
        x, y, z = inverse[0, j], inverse[1, j], inverse[2, j]
        F[0, j] = a * x + b * y + f * z
        F[1, j] = c * x + g * y + h * z
        F[2, j] = k * x + m * y + o * z
    for _ in range(STEPS):
        if _newton(F) < 1e-8:
            return


@called
def _newton(R):
    """Replace R (3, 3) by ``(R + R^-T)/2``; the greatest change."""
    a, b, c, d, e, f, g, h, k = R[0, 0], R[0, 1], R[0, 2], R[1, 0], R[1, 1], R[1, 2], R[2, 0], R[2, 1], R[2, 2]
    A, B, C = e * k - f * h, f * g - d * k, d * h - e * g
    det, most = a * A + b * B + c * C, 0.0
    cofactors = (A, B, C, c * h - b * k, a * k - c * g, b * g - a * h, b * f - c * e, c * d - a * f, a * e - b * d)
    for i in range(9):
        last = R[i // 3, i % 3]
        R[i // 3, i % 3] = 0.5 * (last + cofactors[i] / det)
        most = max(most, abs(R[i // 3, i % 3] - last))
    return most


@called
def _rotate(bodies, turning, x, back):
    """Multiply unknowns x (f,) by the rotations, or by their inverses."""
    d, R, place = bodies.dimension, turning.rotation, bodies.place
    for i in range(len(turning.free)):
        if turning.free[i]:
            p, q = place[i * d], place[i * d + 1]
            a, b = x[p], x[q]
            if d == 2:
                x[p] = R[i, 0, 0] * a + (R[i, 1, 0] if back else R[i, 0, 1]) * b
                x[q] = (R[i, 0, 1] if back else R[i, 1, 0]) * a + R[i, 1, 1] * b
            else:
                r = place[i * d + 2]
                c = x[r]
                for k in range(3):
                    one, two, three = (
                        (R[i, 0, k], R[i, 1, k], R[i, 2, k]) if back else (R[i, k, 0], R[i, k, 1], R[i, k, 2])
                    )
                    x[place[i * d + k]] = one * a + two * b + three * c


@called
def _inverted(rows, operator, turning):
    """Set the inverse of the compliance of the closed rows (k, k); false if they depend on each other."""
    k, W, inverse = len(operator.active), turning.compliance, operator.inverse
    for i in range(k):
        for j in range(k):
            r, total = operator.active[j], 0.0
            for e in range(rows.start[r], rows.start[r + 1]):
                total += rows.value[e] * operator.answer[i, rows.component[e]]
            W[j, i] = total
            inverse[i, j] = 1.0 if i == j else 0.0
        turning.size[i] = W[i, i]
    for i in range(k):
        pivot = W[i, i]
        if not pivot > DEPENDENT * turning.size[i]:
            return False
        for j in range(k):
            part = W[j, i] / pivot
            if j != i and part != 0.0:
                for c in range(i, k):
                    W[j, c] -= part * W[i, c]
                for c in range(k):
                    inverse[j, c] -= part * inverse[i, c]
        for c in range(k):
            W[i, c] /= pivot
            inverse[i, c] /= pivot
    return True
