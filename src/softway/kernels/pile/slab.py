"""Slab (time step) of a pile: impulses on the places through it, and at its end on the velocities (theory/piles.md)."""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel
from softway.kernels.pile.ends import end_island, set_ends
from softway.kernels.pile.islands import islands
from softway.kernels.pile.rows import set_rows, turn_impulses
from softway.kernels.pile.search import near_pairs
from softway.kernels.pile.tables import (
    CLOSED,
    COLUMNS,
    DISSIPATION,
    NORMAL,
    OVERLAP,
    SCALE,
    SLIP,
    SWEEPS,
    TOUCHES,
    Contacts,
    Memory,
    Work,
)
from softway.kernels.pile.through import lost_energies, through_slab

SKIN = 0.01
"""Part of the radius that is searched beyond the motion of a slab."""


@kernel
def pile_slab(h, balls, walls, laws, place, velocity, memory, told):
    """Places (n, 3), velocities and spins (n + 1, 6), and the contacts, after a slab; adds to what is ``told``.

    The places are those of no slab if gaps could not be closed; the last value is then 0.
    """
    n = len(place)
    reach, end = _reach(h, balls, laws, place, velocity), place.copy()
    while True:
        contacts, closed = _met(balls, walls, memory, place, reach)
        count = len(closed)
        work = Work(np.empty((count, 4)), np.empty((n + 1, 6)), np.empty((count, 4)), np.empty((n + 1, 6)))
        gaps, solved = np.zeros((2, count)), np.zeros(3)
        total = through_slab(h, balls, walls, laws, place, velocity, contacts, closed, work, gaps, end, solved)
        if not _beyond(place, end, reach):
            break
    lost, rebound = lost_energies(contacts, total), _rebounds(h, balls, contacts, gaps)
    if count:
        told[OVERLAP] = max(told[OVERLAP], -gaps[1].min())
    told[SLIP], told[SWEEPS] = max(told[SLIP], solved[0]), told[SWEEPS] + solved[1]
    new = total - velocity
    set_rows(balls, walls, contacts, end, end)
    turn_impulses(contacts)
    set_ends(h, walls, laws, contacts, closed, gaps[1], new, rebound)
    told[DISSIPATION] += lost.sum()
    told[TOUCHES] += ((contacts.impulse[:, 0] > 0.0) & (closed == 0)).sum()
    most = 0
    for island in range(len(contacts.start) - 1):
        allowed = lost[contacts.start[island] : contacts.start[island + 1]].sum()
        most = max(most, end_island(h, balls, laws, contacts, work, new, rebound, island, allowed, told))
    told[SWEEPS] += most
    closed[:] = (contacts.impulse[:, 0] > 0.0) & (rebound == 0.0)
    told[CLOSED] = closed.sum()
    return end, new, Memory(contacts.pairs, contacts.impulse, closed), solved[2] == 1.0


@kernel
def _met(balls, walls, memory, place, reach):
    """Contacts of balls within their reaches, with the impulses of the closed ones, and 1 (c,) for those."""
    n = len(place)
    pairs, start, bodies, body_start = islands(near_pairs(place, balls.radius, reach, walls), n)
    row, impulse = np.zeros((len(pairs), COLUMNS)), np.zeros((len(pairs), 4))
    first, second = pairs[:, 0].copy(), np.minimum(pairs[:, 1], n)
    contacts = Contacts(pairs, first, second, row, impulse, start, bodies, body_start)
    return contacts, _remembered(contacts, memory, n)


@inlined
def _rebounds(h, balls, contacts, gaps):
    """Squares (c,) of the velocities that would give the energies back that gaps took by closing."""
    square = np.empty(len(contacts.row))
    for k in range(len(square)):
        row = contacts.row[k]
        lost = contacts.impulse[k, 0] * (gaps[0, k] - gaps[1, k]) / (h * row[SCALE])
        square[k] = 2.0 * row[NORMAL] * max(0.0, lost)
    return square


@inlined
def _reach(h, balls, laws, place, velocity):
    """How far balls (n,) may go in the slab, with a skin."""
    reach, falls = np.empty(len(place)), h * np.sqrt((laws.gravity * laws.gravity).sum())
    for i in range(len(place)):
        speed = np.sqrt(velocity[i, 0] ** 2 + velocity[i, 1] ** 2 + velocity[i, 2] ** 2)
        reach[i] = h * (speed + falls) + SKIN * balls.radius[i]
    return reach


@inlined
def _beyond(place, end, reach):
    """Widen reaches that balls went beyond; True if there are any, since they may overlap others."""
    found = False
    for i in range(len(place)):
        gone = 0.0
        for c in range(3):
            gone += (end[i, c] - place[i, c]) ** 2
        if gone > reach[i] ** 2:
            reach[i], found = 2.0 * np.sqrt(gone), True
    return found


@kernel
def _remembered(contacts, memory, n):
    """Impulses of closed contacts from the last slab; 1 (c,) for those that are closed."""
    first, following = np.full(n, -1, np.int64), np.empty(len(memory.pairs), np.int64)
    closed = np.zeros(len(contacts.pairs), np.int64)
    for k in range(len(memory.pairs)):
        following[k] = first[memory.pairs[k, 0]]
        first[memory.pairs[k, 0]] = k
    for k in range(len(closed)):
        j = first[contacts.pairs[k, 0]]
        while j >= 0 and memory.pairs[j, 1] != contacts.pairs[k, 1]:
            j = following[j]
        if j >= 0 and memory.closed[j]:
            contacts.impulse[k] = memory.impulse[j]
            closed[k] = 1
    return closed
