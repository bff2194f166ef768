"""Closed stops of a mechanism at the end of a slab (time step): their push, what they dissipate, and which stay closed.

A stop has a normal row and blocks of friction, as in :mod:`~softway.kernels.rigid_contact.contact`.
"""

import numpy as np

from softway.kernels.jit.compilation import kernel
from softway.kernels.multibody.energy import close_energy, kinetic_energy
from softway.kernels.multibody.slab import take_motion, tell_joints
from softway.kernels.multibody.velocities import joint_velocity
from softway.kernels.rigid_contact.cone import block
from softway.kernels.rigid_contact.contact import SLIP, book_slab, collide, compliances, group_of

NEAR = 1e-10
"""Gap relative to the extent at which a stop takes part in an impact."""
STILL = 1e-9
"""Velocity relative to the greatest at which a stop is closed after an impact."""
NOISE = 1e-12
"""Sliding relative to the extent, in a slab, that is rounding of a stop that sticks."""
GAINED = 1e-13
"""Gain of energy, relative to the energy, that is rounding."""
REBOUNDS = (1.0, 0.75, 0.5, 0.25, 0.0)
"""Parts of the rebound that are tried until the energy does not grow."""


@kernel
def coefficients(stops):
    """Coefficients of friction (s, q) at present, those at rest of located stops that do not slide."""
    found = stops.friction.copy()
    for k in range(len(found)):
        if stops.located[k] and stops.closed[k] and not stops.sliding[k]:
            found[k, 0] = stops.static[k]
    return found


@kernel
def closed_rows(stops):
    """Rows (m,) of the closed stops, and their coefficients of friction (c, q)."""
    (s, d), present, count = stops.rows.shape, coefficients(stops), 0
    for k in range(s):
        count += 1 if stops.closed[k] else 0
    rows, friction, c = np.zeros(count * d, np.int64), np.zeros((count, present.shape[1])), 0
    for k in range(s):
        if stops.closed[k]:
            rows[c * d : (c + 1) * d], friction[c] = stops.rows[k], present[k]
            c += 1
    return rows, friction


@kernel
def block_size(amounts, d, q, k):
    """Magnitude of the block k of q in the amounts (d,) of a stop."""
    first, last = block(d, q, k)
    total = 0.0
    for t in range(first, last):
        total += amounts[t] ** 2
    return np.sqrt(total)


@kernel
def below_limit(impulse, friction):
    """Closed stops and blocks (c, q) whose friction is below its limit in the impulses (m,), or that have none."""
    c, q = friction.shape
    d, below = len(impulse) // max(c, 1), np.zeros((c, q), np.bool_)
    for i in range(c):
        own = impulse[d * i : d * (i + 1)]
        for k in range(q):
            limit = friction[i, k]
            below[i, k] = block_size(own, d, q, k) < (1.0 - SLIP) * limit * own[0] or limit == 0.0
    return below


@kernel
def velocities(joints, motion, space, stops):
    """Velocities (s, d) of the gaps and of the sliding at a prepared state [m/s]."""
    out = np.zeros(stops.rows.shape)
    for k in range(out.shape[0]):
        for t in range(out.shape[1]):
            out[k, t] = joint_velocity(joints, motion, space, stops.rows[k, t])
    return out


@kernel
def see_sliding(motion, stops, speeds, noise, held):
    """Note which stops slide or turn, at the velocities (s, d); those below ``noise`` [m/s] are none of located stops.

    Located stops that slid through a slab go on sliding, at whatever velocity, if friction has not ``held`` (s,) them.
    """
    q, d = stops.friction.shape[1], stops.rows.shape[1]
    fast, turned = np.abs(motion.velocity).max(), np.abs(motion.spin).max()
    for k in range(len(stops.closed)):
        size = block_size(speeds[k], d, q, 0)
        moving = size > STILL * fast
        if stops.located[k]:
            moving = (moving and size > noise) or (stops.sliding[k] and stops.closed[k] and not held[k])
        stops.sliding[k] = moving
        for t in range(1, q):
            stops.turning[k, t - 1] = block_size(speeds[k], d, q, t) > STILL * turned


@kernel
def jammed(joints, motion, space, stops):
    """Closed stops (s,) whose sliding has no continuous course at the present state.

    A normal force with its friction would not push the places of contact apart, ``W_nn - mu W_nt <= 0`` (Painleve).
    """
    found, (first, last) = np.zeros(len(stops.closed), np.bool_), block(stops.rows.shape[1], stops.friction.shape[1], 0)
    for k in range(len(found)):
        if stops.closed[k] and stops.sliding[k] and stops.friction[k, 0] > 0.0:
            W, speed, across = compliances(joints, space, stops.rows[k])[0], 0.0, 0.0
            for t in range(first, last):
                slip = joint_velocity(joints, motion, space, stops.rows[k, t])
                speed += slip**2
                across += W[0, t] * slip
            speed = np.sqrt(speed)
            found[k] = W[0, 0] * speed - stops.friction[k, 0] * across <= 0.0 and speed > 0.0
    return found


@kernel
def hold(bodies, joints, stops):
    """Set the groups that the ground holds by joints or closed stops."""
    ground = len(bodies.mass) - 1
    bodies.supported[:] = stops.held
    for k in range(len(stops.closed)):
        a, b = joints.a[stops.rows[k, 0]], joints.b[stops.rows[k, 0]]
        if stops.closed[k] and (a == ground or b == ground):
            bodies.supported[bodies.group[min(a, b)]] = 1


@kernel
def excess(bodies, motion):
    """Kinetic energies (g,) of the groups over the energies that they have to have, up to their potentials [J]."""
    out = -motion.energy
    kinetic_energy(bodies, motion, out)
    return out


@kernel
def lose(bodies, joints, motion, stops, lost, pushed):
    """Book energies (g,) of the groups that stops dissipated [J], in the ratio of normal impulses (s,)."""
    for g in range(len(lost)):
        motion.work[1] += lost[g]
        motion.energy[g] -= lost[g]
        total, count = 0.0, 0
        for k in range(len(pushed)):
            if group_of(bodies, joints, motion, stops.rows[k, 0]) == g:
                total, count = total + pushed[k], count + 1
        for k in range(len(pushed)):
            if group_of(bodies, joints, motion, stops.rows[k, 0]) == g and lost[g] != 0.0:
                stops.spent[k] += lost[g] * (pushed[k] / total if total > 0.0 else 1.0 / count)


@kernel
def take_contact_slab(bodies, joints, springs, motion, space, stops, span, extent, told, rebound, stays):
    """Take a slab that was solved, where stops ``rebound`` (s,) [m/s]; set those that are closed at its end (s,).

    The energy that joints and stops took from the velocities at the end is given back, but not that of stops that
    slide or begin to stick.  1 if velocities at the end satisfy the laws of contact.
    """
    rows, friction = closed_rows(stops)
    _book(bodies, joints, motion, space, stops, span)
    take_motion(bodies, joints, springs, motion, space, span)
    through = np.zeros(len(rows))
    for i in range(len(rows)):
        through[i] = motion.impulse[rows[i]]
    below = below_limit(through, friction)
    steady = _steady(space, stops, rows, friction, through, below)
    if not steady:
        told[2] = max(told[2], close_energy(bodies, springs, joints, motion, space))
    before, total = excess(bodies, motion), through.copy()
    bounce, speed = rebound[stops.closed], extent / span
    if not _pushed(bodies, joints, motion, space, rows, friction, through, bounce, speed, total):
        return 0
    if steady:
        told[2] = max(told[2], close_energy(bodies, springs, joints, motion, space))
    else:
        pushed = np.zeros(len(stops.closed))
        pushed[stops.closed] = total[:: stops.rows.shape[1]]
        lose(bodies, joints, motion, stops, before - excess(bodies, motion), pushed)
    tell_joints(joints, motion, space, told)
    _stays(joints, motion, space, stops, extent, span, total, below, rebound, stays)
    return 1


@kernel
def _book(bodies, joints, motion, space, stops, span):
    """Book the work of the closed stops in a slab."""
    for k in range(len(stops.closed)):
        if stops.closed[k]:
            lost = motion.work[1]
            book_slab(bodies, joints, motion, space, stops.rows[k], span)
            stops.spent[k] += motion.work[1] - lost
            stops.shut[k] += span


@kernel
def _steady(space, stops, rows, friction, through, below):
    """True if all closed stops press and stick, on surfaces that do not move themselves."""
    d, c = stops.rows.shape[1], 0
    for k in range(len(stops.closed)):
        if not stops.closed[k]:
            continue
        if not through[d * c] > 0.0:
            return False
        for t in range(friction.shape[1]):
            moves = stops.sliding[k] if t == 0 else stops.turning[k, t - 1]
            if not below[c, t] or (moves and friction[c, t] > 0.0):
                return False
        c += 1
    rate = 0.0
    for k in rows:
        rate = max(rate, abs(space.rate[k]))
    return rate == 0.0


@kernel
def _pushed(bodies, joints, motion, space, rows, friction, through, rebound, speed, total):
    """Push the closed stops at the end of a slab: their impulses (m,), those that acted ``through`` it included.

    If the energy grew, which rebounds with friction may cause, they are pushed with less rebound.  0 if there is no
    solution.
    """
    if len(rows) == 0:
        return 1
    velocity, spin, energy, work = motion.velocity.copy(), motion.spin.copy(), motion.energy.copy(), motion.work.copy()
    before, solved = excess(bodies, motion).sum(), 0
    scale, none = before + energy.sum(), np.zeros(len(rebound))
    for part in REBOUNDS:
        if part > 0.0 and not rebound.any():
            continue
        motion.velocity[:], motion.spin[:], motion.energy[:], motion.work[:] = velocity, spin, energy, work
        total[:] = through
        back = part * rebound
        solved = collide(bodies, joints, motion, space, rows, friction, through, back, none, speed, total)
        if solved and excess(bodies, motion).sum() <= before + GAINED * scale:
            return 1
    return solved


@kernel
def _stays(joints, motion, space, stops, extent, span, total, below, rebound, stays):
    """Set the stops (s,) that are closed at the end: those that pushed, and those near that do not part."""
    speeds, held, c = velocities(joints, motion, space, stops), np.zeros(len(stays), np.bool_), 0
    greatest, d = np.abs(motion.velocity).max(), stops.rows.shape[1]
    for k in range(len(stays)):
        stays[k] = False
        if stops.closed[k]:
            near = space.g[stops.rows[k, 0]] <= NEAR * extent and speeds[k, 0] <= STILL * greatest
            stays[k] = (total[d * c] > 0.0 or near) and rebound[k] <= 0.0
            held[k] = below[c, 0]
            c += 1
    see_sliding(motion, stops, speeds, NOISE * extent / span, held)
