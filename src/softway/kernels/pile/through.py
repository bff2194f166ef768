"""Impulses through a slab (time step) of a pile: no gap is negative at its end, and closed contacts have friction.

Where the sweeps with friction ended too early, the gaps are closed by normal impulses alone.  Friction that is then
directed so that an island gains energy is left out.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.pile.rows import gap_rate, push_all, set_gaps, set_rows, slip, turn_impulses
from softway.kernels.pile.sweeps import close, converge, friction_missed
from softway.kernels.pile.tables import BIAS, FINER, FRICTION, LEAST, NORMAL, SCALE

ROUNDS = 30
"""Greatest number of times that the directions of contacts are brought up to date."""
CLOSING = 2000
"""Greatest number of sweeps that close the gaps with given friction."""
LEFT = 1.25
"""Greatest overlap that is left, relative to the tolerance of the sweeps."""
CORRECTIONS = 8
"""Greatest number of times that friction is left out where an island gains energy; at last all of it."""
GAINED = 1e-14
"""Gain of energy, relative to the impulses times the velocities across them, that is rounding."""


@kernel
def through_slab(h, balls, walls, laws, place, velocity, contacts, closed, work, gaps, end, solved):
    """Sums (n + 1, 6) of the velocities at both ends of a slab with closed gaps, and places at its end.

    ``solved`` is told by how much friction misses its law [m/s], the sweeps, and 1 if the gaps are closed.
    """
    n, left, tolerance = len(place), laws.sweeps, 2.0 * laws.tolerance / h
    free = 2.0 * velocity
    free[:n, :3] += h * laws.gravity
    total = free.copy()
    end[:] = place + 0.5 * h * free[:n, :3]
    set_gaps(balls, walls, contacts, place, gaps[0])
    solved[:] = 0.0
    for correction in range(CORRECTIONS + 1):
        for _ in range(ROUNDS):
            rub = left > 0
            set_rows(balls, walls, contacts, place, end)
            _set_laws(h, walls, laws, contacts, closed, gaps[0], n)
            turn_impulses(contacts)
            total[:] = free
            push_all(balls, contacts, total)
            aim, most = FINER * tolerance if rub else tolerance, max(1, min(left, (laws.sweeps + 1) // 2))
            used, worst = _swept(balls, contacts, total, rub, aim, most if rub else CLOSING, work)
            left -= used if rub else 0
            end[:] = place + 0.5 * h * total[:n, :3]
            solved[1] += used
            if used <= 1 and worst <= aim:
                set_gaps(balls, walls, contacts, end, gaps[1])
                solved[2] = 1.0
                if len(closed) == 0 or gaps[1].min() >= -LEFT * laws.tolerance:
                    break
                solved[2] = 0.0
        if not _left_out(contacts, total, tolerance, correction + 1 == CORRECTIONS):
            break
        solved[2], left = 0.0, 0
    solved[0] = 0.5 * friction_missed(contacts, total, 0, len(closed))
    return total


@kernel
def _swept(balls, contacts, total, rub, aim, most, work):
    """Sweep all islands, with friction or without; the greatest number of sweeps and last change."""
    used, worst = 0, 0.0
    for island in range(len(contacts.start) - 1):
        if rub:
            count, change = converge(balls, contacts, total, island, aim, most, work)
        else:
            count, change = close(balls, contacts, total, island, aim, most, work)
        used, worst = max(used, count), max(worst, change)
    return used, worst


@inlined
def _set_laws(h, walls, laws, contacts, closed, gap, n):
    """Velocities that close the gaps in a slab, and friction of the contacts that were closed before it."""
    for k in range(len(closed)):
        wall = contacts.pairs[k, 1] - n
        contacts.row[k, BIAS] = 2.0 * gap[k] / (h * contacts.row[k, SCALE])
        friction = laws.friction if wall < 0 else walls.friction[wall]
        contacts.row[k, FRICTION] = friction if closed[k] else 0.0
        contacts.row[k, LEAST] = 0.0


@kernel
def _left_out(contacts, total, tolerance, everything):
    """Leave out friction that gives energy to islands that gain some, or all friction there; number of contacts.

    A gain by impulses through the overlap that is left, and by rounding, is none.
    """
    found = 0
    for island in range(len(contacts.start) - 1):
        lost, spared, low, high = 0.0, 0.0, contacts.start[island], contacts.start[island + 1]
        for k in range(low, high):
            x, rate, across = contacts.impulse[k], gap_rate(contacts, total, k), _given(contacts, total, k)
            lost -= 0.5 * x[0] * rate + across
            spared += x[0] * tolerance + GAINED * (
                x[0] * abs(rate) + abs(across) + x[0] * x[0] * contacts.row[k, NORMAL]
            )
        for k in range(low, high):
            x = contacts.impulse[k]
            if lost < -spared and (everything or _given(contacts, total, k) > 0.0) and (x[1:] != 0.0).any():
                x[1:] = 0.0
                found += 1
    return found


@inlined
def _given(contacts, total, k):
    """Energy that friction of a contact gives [J]."""
    p, q, t = slip(contacts, total, k, gap_rate(contacts, total, k))
    return 0.5 * (contacts.impulse[k, 1] * p + contacts.impulse[k, 2] * q + contacts.impulse[k, 3] * t)


@kernel
def lost_energies(contacts, total):
    """Energies (c,) that contacts took in the slab: impulses on mean velocities, half the sums [J]."""
    lost = np.empty(len(contacts.row))
    for k in range(len(lost)):
        lost[k] = -0.5 * contacts.impulse[k, 0] * gap_rate(contacts, total, k) - _given(contacts, total, k)
    return lost
