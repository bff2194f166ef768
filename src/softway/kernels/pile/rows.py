"""Rows of the contacts of balls: normals, arms and compliances; gaps, velocities and impulses.

The gap of two balls is ``(|r|^2 - l^2) / 2l`` with the vector r between the centres and l the sum of the radii.  Its
change over a slab is exactly that of the row at the mean of r (docs/theory/piles.md).
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.pile.search import wall_gap
from softway.kernels.pile.tables import ARM_A, ARM_B, NORMAL, PER_NORMAL, PER_TANGENT, SCALE, TANGENT


@uncounted_kernel
def set_rows(balls, walls, contacts, start, end):
    """Normals, arms, compliances and scales at the means of the places ``start`` and ``end`` (n, 3)."""
    n, row = len(start), contacts.row
    for k in range(len(row)):
        a, b = contacts.pairs[k, 0], contacts.pairs[k, 1]
        if b < n:
            size = 0.0
            for c in range(3):
                row[k, c] = 0.5 * (start[b, c] - start[a, c] + end[b, c] - end[a, c])
                size += row[k, c] ** 2
            size = np.sqrt(size)
            for c in range(3):
                row[k, c] /= size
            row[k, SCALE] = size / (balls.radius[a] + balls.radius[b])
        else:
            for c in range(3):
                row[k, c] = -walls.normal[b - n, c]
            row[k, SCALE] = 1.0
        b = contacts.second[k]
        row[k, ARM_A], row[k, ARM_B] = balls.radius[a] * row[k, SCALE], balls.radius[b] * row[k, SCALE]
        turning = row[k, ARM_A] ** 2 * balls.inverse_inertia[a] + row[k, ARM_B] ** 2 * balls.inverse_inertia[b]
        row[k, NORMAL] = balls.inverse_mass[a] + balls.inverse_mass[b]
        row[k, TANGENT] = row[k, NORMAL] + turning
        row[k, PER_NORMAL], row[k, PER_TANGENT] = 1.0 / row[k, NORMAL], 1.0 / row[k, TANGENT]


@uncounted_kernel
def set_gaps(balls, walls, contacts, place, gap):
    """Gaps (c,) at places (n, 3) [m]."""
    n = len(place)
    for k in range(len(gap)):
        a, b = contacts.pairs[k, 0], contacts.pairs[k, 1]
        if b < n:
            touching = balls.radius[a] + balls.radius[b]
            total = -touching * touching
            for c in range(3):
                total += (place[b, c] - place[a, c]) ** 2
            gap[k] = 0.5 * total / touching
        else:
            gap[k] = wall_gap(place, balls.radius, walls, a, b - n)


@uncounted
def gap_rate(contacts, velocity, k):
    """Velocity of a gap [m/s]."""
    a, b, row = contacts.first[k], contacts.second[k], contacts.row
    total = 0.0
    for c in range(3):
        total += row[k, c] * (velocity[b, c] - velocity[a, c])
    return total


@uncounted
def slip(contacts, velocity, k, rate):
    """Velocity (3,) of sliding at a place of contact, whose gap has this rate [m/s]."""
    a, b, row = contacts.first[k], contacts.second[k], contacts.row
    r, s = row[k, ARM_A], row[k, ARM_B]
    x, y, z = row[k, 0], row[k, 1], row[k, 2]
    p = r * velocity[a, 3] + s * velocity[b, 3]
    q = r * velocity[a, 4] + s * velocity[b, 4]
    t = r * velocity[a, 5] + s * velocity[b, 5]
    return (
        velocity[b, 0] - velocity[a, 0] - x * rate - (q * z - t * y),
        velocity[b, 1] - velocity[a, 1] - y * rate - (t * x - p * z),
        velocity[b, 2] - velocity[a, 2] - z * rate - (p * y - q * x),
    )


@uncounted
def push_along(balls, contacts, velocity, k, amount):
    """Normal impulse at a contact."""
    a, b, row = contacts.first[k], contacts.second[k], contacts.row
    for c in range(3):
        velocity[a, c] -= balls.inverse_mass[a] * amount * row[k, c]
        velocity[b, c] += balls.inverse_mass[b] * amount * row[k, c]


@uncounted
def push_across(balls, contacts, velocity, k, x, y, z):
    """Tangential impulse at a contact."""
    a, b, row = contacts.first[k], contacts.second[k], contacts.row
    m, s = balls.inverse_mass[a], balls.inverse_mass[b]
    velocity[a, 0] -= m * x
    velocity[a, 1] -= m * y
    velocity[a, 2] -= m * z
    velocity[b, 0] += s * x
    velocity[b, 1] += s * y
    velocity[b, 2] += s * z
    m, s = row[k, ARM_A] * balls.inverse_inertia[a], row[k, ARM_B] * balls.inverse_inertia[b]
    p, q, t = row[k, 1] * z - row[k, 2] * y, row[k, 2] * x - row[k, 0] * z, row[k, 0] * y - row[k, 1] * x
    velocity[a, 3] -= m * p
    velocity[a, 4] -= m * q
    velocity[a, 5] -= m * t
    velocity[b, 3] -= s * p
    velocity[b, 4] -= s * q
    velocity[b, 5] -= s * t


@uncounted_kernel
def push_all(balls, contacts, velocity):
    """All impulses of the contacts."""
    x = contacts.impulse
    for k in range(len(x)):
        push_along(balls, contacts, velocity, k, x[k, 0])
        push_across(balls, contacts, velocity, k, x[k, 1], x[k, 2], x[k, 3])


@uncounted_kernel
def turn_impulses(contacts):
    """Tangential impulses into the planes of the present normals, with their magnitudes."""
    x = contacts.impulse
    for k in range(len(x)):
        before, after, out = 0.0, 0.0, 0.0
        for c in range(3):
            before += x[k, c + 1] * x[k, c + 1]
            out += x[k, c + 1] * contacts.row[k, c]
        if before == 0.0:
            continue
        for c in range(3):
            x[k, c + 1] -= out * contacts.row[k, c]
            after += x[k, c + 1] * x[k, c + 1]
        if after > 0.0:
            for c in range(3):
                x[k, c + 1] *= np.sqrt(before / after)
