"""End of a slab (time step) of a pile: velocities that obey the laws of contact with the sums of both impulses.

Contacts that touched in the slab rebound.  The contacts of an island never create energy: if the rebounds of an island
did, they are made smaller, and at last there are no impulses at the end.  Where all contacts are elastic and without
friction, they give back what the slab took.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.pile.rows import gap_rate, slip
from softway.kernels.pile.sweeps import close, converge, friction_missed
from softway.kernels.pile.tables import BIAS, DISSIPATION, FINER, FRICTION, LEAST, RATIO, SLIP

PARTS = (1.0, 0.75, 0.5, 0.25, 0.0)
"""Parts of the rebounds that are tried until the energy does not grow."""
GAINED = 1e-13
"""Gain of energy, relative to the kinetic energy of the island, that is rounding."""
ROUGHER = 100.0
"""Tolerance of velocities at the end of a slab where friction did not converge, relative to that otherwise."""
CLOSING, SEARCHES = 2000, 12
"""Greatest numbers of sweeps that end an approach with given friction, and of rebounds searched."""


@kernel
def set_ends(h, walls, laws, contacts, closed, gap, velocity, rebound):
    """Laws at the end of a slab; velocities of the ``rebound`` (c,) [m/s] from squares that closing the gaps took.

    A rebound that gravity would take back within half a slab is none, unless it is elastic.
    """
    n = len(velocity) - 1
    falls = 0.5 * h * np.sqrt((laws.gravity * laws.gravity).sum())
    for k in range(len(rebound)):
        wall, row = contacts.pairs[k, 1] - n, contacts.row
        row[k, FRICTION] = laws.friction if wall < 0 else walls.friction[wall]
        ratio = laws.restitution if wall < 0 else walls.restitution[wall]
        touches = contacts.impulse[k, 0] > 0.0
        rate = gap_rate(contacts, velocity, k)
        speed = ratio * np.sqrt(rate * rate + rebound[k])
        rebound[k] = speed if touches and not closed[k] and (ratio == 1.0 or speed > falls) else 0.0
        row[k, LEAST], row[k, RATIO] = 0.0, ratio
        row[k, BIAS] = 0.0 if touches or gap[k] <= 2.0 * laws.tolerance else np.inf


@kernel
def end_island(h, balls, laws, contacts, work, velocity, rebound, island, allowed, told):
    """Velocities of an island at the end of a slab, which may give back the ``allowed`` energy [J]; the sweeps."""
    low, high = contacts.start[island], contacts.start[island + 1]
    bodies = contacts.bodies[contacts.body_start[island] : contacts.body_start[island + 1]]
    through, before, rates = contacts.impulse[low:high].copy(), velocity[bodies], np.empty((high - low, 4))
    _see_rates(contacts, velocity, low, high, rates)
    allowed, tolerance = max(0.0, allowed), 2.0 * laws.tolerance / h
    scale = allowed + _energy(balls, velocity, bodies)
    elastic, part, found = _elastic(laws, contacts, rebound, low, high), 1.0, np.zeros((3, 2))
    gained, sweeps, turns = 0.0, 0, SEARCHES if _elastic(laws, contacts, rebound, low, high) else 0
    for turn in range(turns + len(PARTS) + 1):
        contacts.impulse[low:high] = through
        for j in range(len(bodies)):
            velocity[bodies[j]] = before[j]
        _set_rebounds(contacts, rebound, part, low, high)
        sweeps += _solved(balls, contacts, velocity, laws.sweeps, island, tolerance, work)
        gained = _gained(contacts, velocity, through, rates, low, high)
        if gained <= allowed + GAINED * scale and (not elastic or gained >= allowed - GAINED * scale):
            break
        if turn < turns:
            part = _next_part(found, turn, part, gained - allowed)
        elif turn < turns + len(PARTS):
            elastic, part = False, PARTS[turn - turns]
        if turn == turns + len(PARTS) - 1:
            _widen(contacts, through, low, high)
    if gained > allowed + GAINED * scale:
        contacts.impulse[low:high], gained = through, 0.0
        for j in range(len(bodies)):
            velocity[bodies[j]] = before[j]
    told[DISSIPATION] -= gained
    told[SLIP] = max(told[SLIP], friction_missed(contacts, velocity, low, high))
    return sweeps


@inlined
def _set_rebounds(contacts, rebound, part, low, high):
    """Parts of the rebounds of touching contacts."""
    for k in range(low, high):
        if contacts.row[k, BIAS] != np.inf:
            contacts.row[k, BIAS] = -part * rebound[k]


@inlined
def _next_part(found, turn, part, missed):
    """Part of the rebounds from the last two: the energy is linear in its square."""
    found[turn % 2, 0], found[turn % 2, 1] = part * part, missed
    if turn == 0:
        return 0.9 * part
    slope = (found[1, 1] - found[0, 1]) / (found[1, 0] - found[0, 0])
    square = part * part - missed / slope
    return np.sqrt(square) if np.isfinite(square) and square > 0.0 else 0.5 * part


@kernel
def _solved(balls, contacts, velocity, most, island, tolerance, work):
    """Velocities of an island by the laws of contact, and the number of sweeps.

    Where the sweeps did not converge, no gap closes all the same: friction stays, and normal impulses end approaches.
    """
    used, worst = converge(balls, contacts, velocity, island, FINER * tolerance, most, work)
    if worst > tolerance:
        used += close(balls, contacts, velocity, island, ROUGHER * tolerance, CLOSING, work)[0]
    return used


@inlined
def _elastic(laws, contacts, rebound, low, high):
    """True if contacts of an island rebound, all as they came, and none has friction."""
    some = False
    for k in range(low, high):
        touches = contacts.row[k, BIAS] != np.inf
        some = some or rebound[k] > 0.0
        if touches and (contacts.row[k, FRICTION] > 0.0 or contacts.row[k, RATIO] < 1.0):
            return False
    return some


@kernel
def _see_rates(contacts, velocity, low, high, rates):
    """Velocities of gaps and of the sliding before the impulses."""
    for k in range(low, high):
        rate = gap_rate(contacts, velocity, k)
        rates[k - low, 0] = rate
        rates[k - low, 1], rates[k - low, 2], rates[k - low, 3] = slip(contacts, velocity, k, rate)


@kernel
def _gained(contacts, velocity, through, rates, low, high):
    """Energy from the impulses at the end: on means of the velocities before and after them [J]."""
    total = 0.0
    for k in range(low, high):
        x, rate = contacts.impulse[k] - through[k - low], gap_rate(contacts, velocity, k)
        p, q, t = slip(contacts, velocity, k, rate)
        before = rates[k - low]
        total += 0.5 * x[0] * (rate + before[0]) + 0.5 * x[1] * (p + before[1])
        total += 0.5 * x[2] * (q + before[2]) + 0.5 * x[3] * (t + before[3])
    return total


@inlined
def _energy(balls, velocity, bodies):
    """Kinetic energy of some balls [J]."""
    total = 0.0
    for i in bodies:
        for c in range(3):
            total += 0.5 * balls.mass[i] * velocity[i, c] ** 2 + 0.5 * balls.inertia[i] * velocity[i, 3 + c] ** 2
    return total


@inlined
def _widen(contacts, through, low, high):
    """Least limits of the friction, so that what acted through the slab is admissible at its end."""
    for k in range(low, high):
        x = through[k - low]
        contacts.row[k, LEAST] = np.sqrt(x[1] * x[1] + x[2] * x[2] + x[3] * x[3])
