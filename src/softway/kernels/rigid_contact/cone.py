"""Impulses of contacts with friction, from their compliance: unilateral normals, cones without convexification.

``y = W x + b`` for the contacts i, with the normal impulse first and blocks of others, of friction against sliding, and
of moments against rolling and drilling: ``0 <= x_n perp y_n >= 0``, and for each block t ``|x_t| <= r`` against the
direction of ``y_t`` with ``r = max(mu x_n, least)``, where mu is a coefficient or, for moments, a length.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.rigid_contact.dense import solve_dense, solve_nearly_dependent

ITERATIONS = 60
"""Greatest number of Newton's steps."""
EXACT = 4e-16
"""Residual, relative to the impulses, below which nothing can be gained."""
SOLVED = 1e-11
"""Residual, relative to the impulses, at which iterates that improve no more are a solution."""
ROUGHLY = 1e-9
"""Residual, relative to the impulses, that is accepted where all else fails: dependent contacts, rounded velocities."""
NEAR = (1e-4, 1e-3, 1e-2, 1e-1)
"""Compliances added in the search near the last impulses, relative to those of each row."""
SEARCHES = 30
"""Greatest number of searches near the last impulses."""
MOST = 5
"""Greatest number of contacts whose modes are tried one by one."""
SWEEPS = 2000
"""Greatest number of sweeps over the contacts."""


@kernel
def solve_cone(W, b, friction, least, lower, axis, rounding, x):
    """Impulses x (m,) in place, from a first guess; 1 if they are a solution, 0 if none was found.

    ``friction`` (c, q) are the coefficients of the q blocks of each contact, and ``least`` (c, q) their least limits.
    Where a block has a unit direction in ``axis`` (m,), it has impulses along it only, against the velocity along it.
    Normal impulses are ``lower`` (c,) at least, instead of zero; impulses below ``rounding`` are rounding errors.
    """
    if len(x) == 0:
        return 1
    d = len(x) // len(friction)
    rho = _steps(W, d, friction)
    found = _newton(W, b, friction, least, lower, axis, rho, rounding, x)
    if not found and d == 2 and len(friction) <= MOST and lower.max() == 0.0:
        found = _modes(W, b, friction, x)
    if not found:
        _sweeps(W, b, friction, least, lower, axis, rho, x)
        found = _newton(W, b, friction, least, lower, axis, rho, rounding, x)
    for part in NEAR:
        if not found:
            found = _proximal(W, b, friction, least, lower, axis, rho, rounding, x, part)
    if not found:
        F, J = np.empty(len(x)), np.empty((len(x), len(x)))
        size = _projected(W, b, friction, least, lower, axis, rho, x, F, J)
        found = 1 if size <= ROUGHLY * np.abs(x).max() else 0
    x[::d] = np.maximum(x[::d], lower)
    return found


@inlined
def block(d, q, k):
    """First row of the block k of q in a contact of d rows, and the row after it."""
    if q == 1:  # sliding
        return 1, d
    if q == 2:  # in the plane: sliding, rolling
        return 1 + k, 2 + k
    return 1 + 2 * k, min(3 + 2 * k, 6)  # in space: sliding, rolling, drilling


@kernel
def _steps(W, d, friction):
    """Inverse compliances (m,) of each row, one for the rows of a block."""
    rho = np.empty(len(W))
    for i in range(len(friction)):
        n = d * i
        rho[n] = 1.0 / max(W[n, n], 1e-300)
        for k in range(friction.shape[1]):
            first, last = block(d, friction.shape[1], k)
            most = 0.0
            for t in range(n + first, n + last):
                most = max(most, W[t, t])
            for t in range(n + first, n + last):
                rho[t] = 1.0 / max(most, 1e-300)
    return rho


@kernel
def _newton(W, b, friction, least, lower, axis, rho, rounding, x):
    """Newton's method on the projections of the impulses; x is the best iterate.  1 if it is a solution."""
    m = len(x)
    F, J, tried = np.empty(m), np.empty((m, m)), np.empty(m)
    size = _projected(W, b, friction, least, lower, axis, rho, x, F, J)
    waited = 0
    for _ in range(ITERATIONS):
        scale = np.abs(x).max() + np.abs(rho * b).max()
        nearly = max(SOLVED * scale, rounding)
        if size <= EXACT * scale or (waited >= 2 and size <= nearly):
            return 1
        step = -F
        solve_nearly_dependent(J, step)
        length, found, before = 1.0, size, F.copy()
        while True:
            tried[:] = x + length * step
            found = _projected(W, b, friction, least, lower, axis, rho, tried, F, J)
            if found < size or length < 1e-3 or (length == 1.0 and size <= nearly):
                break
            length *= 0.5
        waited = waited + 1 if found > 0.5 * size else 0
        if found >= size:
            if size <= nearly:
                return 1
            if waited >= 8:
                return 0
        if not np.isfinite(found):
            F[:] = before
            return 0
        x[:], size = tried, found
    return 1 if size <= nearly else 0


@kernel
def _proximal(W, b, friction, least, lower, axis, rho, rounding, x, part):
    """Search near the last impulses, again and again: an added compliance makes every problem regular.  1 if solved."""
    added, near, new = part / rho, W.copy(), np.zeros(len(x))
    for i in range(len(x)):
        near[i, i] += added[i]
    for _ in range(SEARCHES):
        new[:] = x
        if not _newton(near, b - added * x, friction, least, lower, axis, rho, rounding, new):
            return 0
        change = np.abs(new - x).max()
        x[:] = new
        if change <= SOLVED * np.abs(x).max():
            break
    return _newton(W, b, friction, least, lower, axis, rho, rounding, x)


@kernel
def _projected(W, b, friction, least, lower, axis, rho, x, F, J):
    """Residual F (m,): impulses less their projections after a step against y; its derivative J; its greatest entry."""
    y = W @ x + b
    d = len(x) // len(friction)
    for i in range(len(friction)):
        n = d * i
        ahead = x[n] - rho[n] * y[n]
        J[n] = 0.0
        if ahead > lower[i]:
            F[n] = rho[n] * y[n]
            J[n] = rho[n] * W[n]
        else:
            F[n] = x[n] - lower[i]
            J[n, n] = 1.0
        for k in range(friction.shape[1]):
            first, last = block(d, friction.shape[1], k)
            radius = max(friction[i, k] * max(ahead, lower[i]), least[i, k])
            turning = friction[i, k] if ahead > lower[i] and radius > least[i, k] else 0.0
            _tangential(W, y, turning, radius, axis, rho, x, F, J, n, n + first, n + last)
    return np.abs(F).max()


@kernel
def _tangential(W, y, turning, radius, axis, rho, x, F, J, n, first, last):
    """Rows from ``first`` to before ``last``, a block of a contact: inside its disc it sticks, outside it slips."""
    if last - first == 2 and (axis[first] != 0.0 or axis[first + 1] != 0.0):
        _along_axis(W, y, turning, radius, axis, rho, x, F, J, n, first, last)
        return
    size = 0.0
    for t in range(first, last):
        size += (x[t] - rho[t] * y[t]) ** 2
    size = np.sqrt(size)
    for t in range(first, last):
        J[t] = 0.0
        if size <= radius and radius > 0.0:
            F[t] = rho[t] * y[t]
            J[t] = rho[t] * W[t]
            continue
        along = (x[t] - rho[t] * y[t]) / size if size > 0.0 else 0.0
        F[t] = x[t] - radius * along
        J[t, t] = 1.0
        if turning:  # the radius follows the normal impulse
            J[t, n] -= along * turning
            J[t] += along * turning * rho[n] * W[n]
        for other in range(first, last):  # the direction turns, in space only
            if last - first > 1 and size > 0.0:
                part = (1.0 if other == t else 0.0) - along * (x[other] - rho[other] * y[other]) / size
                J[t, other] -= radius / size * part
                J[t] += radius / size * part * rho[other] * W[other]


@kernel
def _along_axis(W, y, turning, radius, axis, rho, x, F, J, n, first, last):
    """The same rows of a block with impulses along a given direction only."""
    ahead = 0.0
    for t in range(first, last):
        ahead += axis[t] * (x[t] - rho[t] * y[t])
    pull = min(max(ahead, -radius), radius)
    for t in range(first, last):
        F[t] = x[t] - axis[t] * pull
        J[t] = 0.0
        J[t, t] = 1.0
        if abs(ahead) > radius and turning:
            slope = axis[t] * np.sign(ahead) * turning
            J[t, n] -= slope
            J[t] += slope * rho[n] * W[n]
        for other in range(first, last):
            if abs(ahead) <= radius:
                J[t, other] -= axis[t] * axis[other]
                J[t] += axis[t] * axis[other] * rho[other] * W[other]


@kernel
def _modes(W, b, friction, x):
    """Try all modes of a few contacts in the plane: open, sticking, slipping to either side.  1 if one fits."""
    m, count = len(x), len(friction)
    A, found = np.empty((m, m)), np.empty(m)
    scale = np.abs(b).max()
    for code in range(4**count):
        left = code
        for i in range(count):
            mode, left, n = left % 4, left // 4, 2 * i
            A[n], A[n + 1] = W[n], W[n + 1]
            found[n], found[n + 1] = -b[n], -b[n + 1]
            if mode == 0:
                A[n], found[n] = 0.0, 0.0
                A[n, n] = 1.0
            if mode != 1:
                A[n + 1], found[n + 1] = 0.0, 0.0
                A[n + 1, n + 1] = 1.0
            if mode > 1:
                A[n + 1, n] = -friction[i, 0] * (1.0 if mode == 2 else -1.0)
        solve_dense(A, found)
        if _fits(W @ found + b, found, friction, code, scale):
            x[:] = found
            return 1
    return 0


@kernel
def _fits(y, x, friction, code, scale):
    """True if impulses of given modes satisfy the inequalities."""
    size = np.abs(x).max()
    for i in range(len(friction)):
        mode, code, n = code % 4, code // 4, 2 * i
        rough = SOLVED * scale
        if x[n] < -SOLVED * size or y[n] < -rough:
            return False
        if mode == 1 and abs(x[n + 1]) > friction[i, 0] * x[n] + SOLVED * size:
            return False
        if (mode == 2 and y[n + 1] > rough) or (mode == 3 and y[n + 1] < -rough):
            return False
        if mode > 0 and abs(y[n]) > 1e3 * rough:
            return False
    return True


@kernel
def _sweeps(W, b, friction, least, lower, axis, rho, x):
    """Projected steps of one contact after the other, as a guess for Newton's method."""
    d = len(x) // len(friction)
    for _ in range(SWEEPS):
        change = 0.0
        for i in range(len(friction)):
            n = d * i
            new = max(lower[i], x[n] - rho[n] * (W[n] @ x + b[n]))
            change, x[n] = max(change, abs(new - x[n])), new
            for k in range(friction.shape[1]):
                first, last = block(d, friction.shape[1], k)
                radius, size = max(friction[i, k] * new, least[i, k]), 0.0
                for t in range(n + first, n + last):
                    moved = x[t] - rho[t] * (W[t] @ x + b[t])
                    change, x[t] = max(change, abs(moved - x[t])), moved
                    size += moved * moved
                size = np.sqrt(size)
                if size > radius:
                    for t in range(n + first, n + last):
                        x[t] *= radius / size
                first, last = n + first, n + last
                if last - first == 2 and (axis[first] != 0.0 or axis[first + 1] != 0.0):
                    x[first:last] = axis[first:last] * (axis[first:last] @ x[first:last])
        if change <= 1e-12 * np.abs(x).max():
            return
