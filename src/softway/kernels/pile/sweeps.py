"""Sweeps over the contacts of an island until velocities change by a tolerance: projections with conjugate directions.

The law of a contact is exact in each update: ``0 <= x_n perp y_n >= 0``, and ``|x_t| <= r`` against ``y_t`` with
``r = max(mu x_n, least)``.  The compliance of a ball with a contact has no part from the normal to the plane across.
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.pile.rows import gap_rate, push_across, push_along, slip
from softway.kernels.pile.tables import BIAS, FRICTION, LEAST, NORMAL, PER_NORMAL, PER_TANGENT, TANGENT


@uncounted
def _press(balls, contacts, velocity, k):
    """Bring the normal impulse of a contact to its law; the change as a velocity, and the rate of the gap after it."""
    row, x = contacts.row, contacts.impulse
    rate = gap_rate(contacts, velocity, k)
    new = max(0.0, x[k, 0] - (rate + row[k, BIAS]) * row[k, PER_NORMAL])
    change = new - x[k, 0]
    if change == 0.0:
        return 0.0, rate
    x[k, 0] = new
    push_along(balls, contacts, velocity, k, change)
    change *= row[k, NORMAL]
    return abs(change), rate + change


@uncounted
def limit(contacts, k):
    """Greatest friction of a contact."""
    return max(contacts.row[k, FRICTION] * contacts.impulse[k, 0], contacts.row[k, LEAST])


@uncounted
def wanted(contacts, velocity, k, rate):
    """Tangential impulse of a contact by its law, given the velocities and the rate of its gap."""
    x, per = contacts.impulse, contacts.row[k, PER_TANGENT]
    p, q, t = slip(contacts, velocity, k, rate)
    p, q, t = x[k, 1] - p * per, x[k, 2] - q * per, x[k, 3] - t * per
    square, most = p * p + q * q + t * t, limit(contacts, k)
    if square > most * most:
        part = most / np.sqrt(square)
        p, q, t = part * p, part * q, part * t
    return p, q, t


@uncounted
def _rub(balls, contacts, velocity, k, rate):
    """Bring the tangential impulse of a contact to its law; the square of the change as a velocity."""
    x, wide = contacts.impulse, contacts.row[k, TANGENT]
    if limit(contacts, k) == 0.0 and x[k, 1] == 0.0 and x[k, 2] == 0.0 and x[k, 3] == 0.0:
        return 0.0
    p, q, t = wanted(contacts, velocity, k, rate)
    u, v, w = p - x[k, 1], q - x[k, 2], t - x[k, 3]
    x[k, 1], x[k, 2], x[k, 3] = p, q, t
    push_across(balls, contacts, velocity, k, u, v, w)
    return (u * u + v * v + w * w) * wide * wide


@uncounted
def _fit_cone(balls, contacts, velocity, k):
    """Bring friction of a contact within its limit."""
    x, most = contacts.impulse, limit(contacts, k)
    square = x[k, 1] * x[k, 1] + x[k, 2] * x[k, 2] + x[k, 3] * x[k, 3]
    if square > most * most:
        part = most / np.sqrt(square)
        p, q, t = part * x[k, 1], part * x[k, 2], part * x[k, 3]
        push_across(balls, contacts, velocity, k, p - x[k, 1], q - x[k, 2], t - x[k, 3])
        x[k, 1], x[k, 2], x[k, 3] = p, q, t


@uncounted
def _nth(low, high, i):
    """Contact number i on the way to and fro."""
    return low + i if i < high - low else 2 * high - low - 1 - i


@uncounted_kernel
def converge(balls, contacts, velocity, island, tolerance, most, work):
    """Sweep an island until its velocities change by the tolerance at most; number of sweeps and the last change.

    Between two sweeps impulses and velocities go on along the direction of the last steps, which the ratio of their
    sizes makes conjugate (Fletcher and Reeves), at most as far as the last step.
    """
    low, high = contacts.start[island], contacts.start[island + 1]
    before, worst = 0.0, 0.0
    _keep(contacts, velocity, work, island)
    for count in range(most):
        worst, square = 0.0, 0.0
        for i in range(2 * (high - low)):
            k = _nth(low, high, i)
            change, rate = _press(balls, contacts, velocity, k)
            worst, square = max(worst, change), max(square, _rub(balls, contacts, velocity, k, rate))
        worst = max(worst, np.sqrt(square))
        if worst <= tolerance:
            return count + 1, worst
        size, along = _sizes(contacts, work, low, high, 4, count)
        ratio = min(size / before, 1.0) if count > 0 and along >= 0.0 else 0.0
        before = size
        if count + 1 < most:
            _go_on(contacts, velocity, work, island, ratio)
    return most, worst


@uncounted_kernel
def close(balls, contacts, velocity, island, tolerance, most, work):
    """Sweep over the normal impulses of an island in the same way; friction stays, but within its limits."""
    low, high = contacts.start[island], contacts.start[island + 1]
    before, worst = 0.0, 0.0
    for k in range(low, high):
        work.impulse[k, 0] = contacts.impulse[k, 0]
    for count in range(most):
        worst = 0.0
        for i in range(2 * (high - low)):
            k = _nth(low, high, i)
            worst = max(worst, _press(balls, contacts, velocity, k)[0])
            if contacts.row[k, FRICTION] > 0.0:
                _fit_cone(balls, contacts, velocity, k)
        if worst <= tolerance:
            return count + 1, worst
        size, along = _sizes(contacts, work, low, high, 1, count)
        ratio = min(size / before, 1.0) if count > 0 and along >= 0.0 else 0.0
        before = size
        if count + 1 < most:
            _press_on(balls, contacts, velocity, work, low, high, ratio)
    return most, worst


@uncounted
def _keep(contacts, velocity, work, island):
    """Keep impulses and velocities of an island as they are before a sweep."""
    for k in range(contacts.start[island], contacts.start[island + 1]):
        for c in range(4):
            work.impulse[k, c] = contacts.impulse[k, c]
    for j in range(contacts.body_start[island], contacts.body_start[island + 1]):
        i = contacts.bodies[j]
        for c in range(6):
            work.velocity[i, c] = velocity[i, c]


@uncounted
def _sizes(contacts, work, low, high, wide, count):
    """Square of the change by the last sweep, and its product with the direction, in the metric of the compliance."""
    size, along = 0.0, 0.0
    for k in range(low, high):
        for c in range(wide):
            weight = contacts.row[k, NORMAL if c == 0 else TANGENT]
            change = contacts.impulse[k, c] - work.impulse[k, c]
            size += weight * change * change
            if count > 0:
                along += weight * change * work.along[k, c]
    return size, along


@uncounted
def _go_on(contacts, velocity, work, island, ratio):
    """New direction from the last change, and impulses and velocities moved along the old one, and kept."""
    for k in range(contacts.start[island], contacts.start[island + 1]):
        for c in range(4):
            change = contacts.impulse[k, c] - work.impulse[k, c]
            old = ratio * work.along[k, c] if ratio > 0.0 else 0.0
            contacts.impulse[k, c] += old
            work.impulse[k, c] = contacts.impulse[k, c]
            work.along[k, c] = old + change
    for j in range(contacts.body_start[island], contacts.body_start[island + 1]):
        i = contacts.bodies[j]
        for c in range(6):
            change = velocity[i, c] - work.velocity[i, c]
            old = ratio * work.moving[i, c] if ratio > 0.0 else 0.0
            velocity[i, c] += old
            work.velocity[i, c] = velocity[i, c]
            work.moving[i, c] = old + change


@uncounted
def _press_on(balls, contacts, velocity, work, low, high, ratio):
    """New direction from the last change, and normal impulses moved along the old one, and kept."""
    for k in range(low, high):
        change = contacts.impulse[k, 0] - work.impulse[k, 0]
        old = ratio * work.along[k, 0] if ratio > 0.0 else 0.0
        if old != 0.0:
            contacts.impulse[k, 0] += old
            push_along(balls, contacts, velocity, k, old)
        work.impulse[k, 0] = contacts.impulse[k, 0]
        work.along[k, 0] = old + change


@uncounted_kernel
def friction_missed(contacts, velocity, low, high):
    """Greatest velocity by which contacts miss the law of friction [m/s]."""
    worst = 0.0
    for k in range(low, high):
        x = contacts.impulse
        p, q, t = wanted(contacts, velocity, k, gap_rate(contacts, velocity, k))
        missed = np.sqrt((p - x[k, 1]) ** 2 + (q - x[k, 2]) ** 2 + (t - x[k, 3]) ** 2)
        worst = max(worst, missed * contacts.row[k, TANGENT])
    return worst
