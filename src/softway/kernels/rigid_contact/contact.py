"""Contacts of rigid bodies with Coulomb's friction: the slab (time step), the velocities at its end, and collisions.

Two impulses of a contact, through the slab on places and at its end on velocities, obey the laws of contact with their
sum (docs/theory/mechanisms.md).  The rows of a contact are its normal one, and blocks of friction: one or two
tangential ones or none, and those of the turning, if any stop of the mechanism has friction against it.  Surfaces that
move like a belt have prescribed rates of their tangential rows.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.multibody.band import solve_band
from softway.kernels.multibody.drives import work_of_jumps
from softway.kernels.multibody.joint_rows import SLIDE
from softway.kernels.multibody.slab import (
    ITERATIONS,
    SLOW,
    evaluate_rows,
    guess_motion,
    has_converged,
    missed_joints,
    motion_of,
    move_on,
    place_ends,
)
from softway.kernels.multibody.velocities import joint_velocity, project_velocities, push_row
from softway.kernels.rigid_contact.cone import block
from softway.kernels.rigid_contact.cone_call import call_cone
from softway.kernels.rigid_contact.routh import impulses_in_order

SLIP = 1e-9
"""Friction, relative to its limit, that is rounding below it."""
ROUNDING = 1e-15
"""Rounding error of impulses and places, relative to the greatest."""


@inlined
def _displacement(joints, space, z, k):
    """``G z`` of a row."""
    total = 0.0
    for side in range(space.G.shape[1]):
        i = joints.sides[k, side]
        for c in range(6):
            total += space.G[k, side, c] * z[i, c]
    return total


@inlined
def _slid(joints, space, z, k, h):
    """Displacement of a contact row against the surface, which itself may move."""
    return _displacement(joints, space, z, k) - h * space.rate[k]


@kernel
def compliances(joints, space, rows):
    """Compliance W (m, m) of contact rows through bodies and joints; C (r, m) to the joints, and the joints' U."""
    m, r = len(rows), len(space.g)
    W, C, U, column = np.zeros((m, m)), np.zeros((r, m)), np.zeros((r, m)), np.zeros(r)
    for j in range(m):
        for k in range(r):
            column[k] = _product(joints, space, k, rows[j]) if space.active[k] else 0.0
        C[:, j] = column
        solve_band(space.lower, space.pivot, column)
        U[:, j] = column
    for i in range(m):
        for j in range(m):
            W[i, j] = _product(joints, space, rows[i], rows[j])
            for k in range(r):
                W[i, j] -= C[k, i] * U[k, j]
    return W, C, U


@inlined
def _product(joints, space, i, j):
    """``G_i M^-1 G_j^T`` of two rows."""
    total = 0.0
    for si in range(space.G.shape[1]):
        for sj in range(space.G.shape[1]):
            if joints.sides[i, si] == joints.sides[j, sj]:
                for c in range(6):
                    total += space.G[i, si, c] * space.MG[j, sj, c]
    return total


@inlined
def _rounding(bodies, motion, speed):
    """Rounding error of an impulse, from the velocities of the bodies and that which rounds their places."""
    greatest = speed
    for i in range(len(motion.place) - 1):
        for c in range(3):
            greatest = max(greatest, abs(motion.velocity[i, c]))
    return ROUNDING * greatest * bodies.mass.max()


@kernel
def solve_contact_slab(bodies, joints, springs, motion, space, rows, friction, h, extent):
    """Motion and impulses of a slab with closed contacts, as ``solve_motion``; the number of iterations, 0 if it fails.

    Afterwards ``space.g`` has the values of all rows at its end, and ``space.G`` their means.
    """
    space.kept[:] = motion.impulse
    evaluate_rows(joints, motion, space, motion.place, space.R0)  # another try left its means
    W, C, U = compliances(joints, space, rows)
    W *= 0.5 * h
    x, b, none = np.zeros(len(rows)), np.zeros(len(rows)), np.zeros(len(friction))
    least = np.zeros(friction.shape)
    rounding = _rounding(bodies, motion, extent / h)
    guess_motion(bodies, joints, springs, motion, space, h)
    z, new, P, before, slow = space.z, space.new, motion.impulse, np.inf, 0
    for iteration in range(1, ITERATIONS + 1):
        place_ends(z, motion.place, space.R0, space.place, space.R1)
        evaluate_rows(joints, motion, space, space.place, space.R1)
        space.push[:] = space.g
        solve_band(space.lower, space.pivot, space.push)
        _offsets(joints, space, P, rows, C, h, b, x)
        b -= W @ x
        if not call_cone(space, W, b, friction, least, none, 0.0 * x, rounding, x):
            break
        _add_impulses(space, P, rows, U, x, h)
        motion_of(bodies, joints, springs, motion, space, h, P, z, new)
        change = move_on(z, new, extent)
        if has_converged(change, before, missed_joints(space), extent):
            place_ends(z, motion.place, space.R0, space.place, space.R1)
            evaluate_rows(joints, motion, space, space.place, space.R1)
            return iteration
        slow = slow + 1 if change > SLOW * before else 0
        if slow >= 2 or not np.isfinite(change):
            break
        before = change
    P[:] = space.kept
    return 0


@kernel
def _offsets(joints, space, P, rows, C, h, b, x):
    """Gaps and slidings b (m,) with the joints closed, and the impulses x (m,) so far."""
    for i in range(len(rows)):
        k = rows[i]
        b[i] = _slid(joints, space, space.z, k, h) if joints.kind[k] >= SLIDE else space.g[k]
        x[i] = P[k]
        for j in range(len(space.g)):
            b[i] -= C[j, i] * space.push[j]


@kernel
def _add_impulses(space, P, rows, U, x, h):
    """Impulses x (m,) of the contacts, and those with which the joints answer and close their own values."""
    for j in range(len(P)):
        P[j] -= 2.0 / h * space.push[j]
        for i in range(len(rows)):
            P[j] -= U[j, i] * (x[i] - P[rows[i]]) if space.active[j] else 0.0
    for i in range(len(rows)):
        P[rows[i]] = x[i]


@kernel
def book_slab(bodies, joints, motion, space, rows, h):
    """Book the work of the contacts in a slab that is taken, with the rows at its means."""
    for i in range(len(rows)):
        k = rows[i]
        lost = -motion.impulse[k] * _slid(joints, space, space.z, k, h) / h
        done = motion.impulse[k] * space.rate[k]
        motion.energy[group_of(bodies, joints, motion, k)] += done - lost
        motion.work[0] += done
        motion.work[1] += lost


@inlined
def group_of(bodies, joints, motion, k):
    """Group of the bodies of a row."""
    return bodies.group[joints.a[k] if joints.a[k] != len(motion.place) - 1 else joints.b[k]]


@kernel
def collide(bodies, joints, motion, space, rows, friction, through, rebound, lower, speed, x):
    """Change the velocities at a prepared state by the contacts; x (m,) are the impulses, ``through`` (m,) included.

    ``friction`` (c, q) are the coefficients of the blocks.  Normal velocities become ``rebound`` (c,) at least, and
    normal impulses are ``lower`` (c,) at least; impulses that acted ``through`` the slab count in the laws.  Friction
    that slid through it keeps its direction, that of the mean: the direction at the end would be late by half a slab.
    The work of motors and belts is booked; ``speed`` is that of the extent in a slab, the scale of rounding.  1 if a
    solution was found.
    """
    W = compliances(joints, space, rows)[0]
    b, d = np.zeros(len(rows)), len(rows) // max(len(friction), 1)
    least, axis = np.zeros(friction.shape), np.zeros(len(rows))
    for i in range(len(rows)):
        b[i] = joint_velocity(joints, motion, space, rows[i])
        if i % d == 0:
            b[i] -= rebound[i // d]
    for i in range(len(friction)):
        for k in range(friction.shape[1]):
            first, last = block(d, friction.shape[1], k)
            for t in range(d * i + first, d * i + last):
                least[i, k] = np.sqrt(least[i, k] ** 2 + through[t] ** 2)
            if last - first == 2 and least[i, k] > (1.0 - SLIP) * friction[i, k] * through[d * i]:
                axis[d * i + first : d * i + last] = through[d * i + first : d * i + last] / max(least[i, k], 1e-300)
    b -= W @ through
    rounding = _rounding(bodies, motion, speed)
    found = call_cone(space, W, b, friction, least, lower, axis, rounding, x)
    if not found and np.abs(axis).max() > 0.0:
        x[:] = through
        found = call_cone(space, W, b, friction, least, lower, 0.0 * axis, rounding, x)
    push_contacts(bodies, joints, motion, space, rows, x - through)
    return found


@kernel
def push_contacts(bodies, joints, motion, space, rows, impulse):
    """Change the velocities by impulses (m,) of contact rows, with the joints; book the work of motors and belts."""
    for i in range(len(rows)):
        done = impulse[i] * space.rate[rows[i]]
        motion.energy[group_of(bodies, joints, motion, rows[i])] += done
        motion.work[0] += done
        push_row(joints, motion, space, rows[i], impulse[i])
    project_velocities(bodies, joints, motion, space)
    work_of_jumps(bodies, joints, motion, space)


@kernel
def collide_at_once(bodies, joints, motion, space, rows, friction, ratio, x):
    """Collision at one contact in the plane, followed through its sliding (Routh); 1 if it ends."""
    W = compliances(joints, space, rows)[0]
    found = impulses_in_order(
        W,
        joint_velocity(joints, motion, space, rows[0]),
        joint_velocity(joints, motion, space, rows[1]),
        friction,
        ratio,
        x,
    )
    push_contacts(bodies, joints, motion, space, rows, x)
    return found
