"""Tables of piles of balls that compiled loops read: balls, walls, and the contacts of a slab (time step)."""

from typing import NamedTuple

from softway.arrays import Array, IntArray


class Balls(NamedTuple):
    """Balls (n,) and, last, the ground: radii [m], masses [kg], moments of inertia [kg m^2], and their inverses."""

    radius: Array
    mass: Array
    inertia: Array
    inverse_mass: Array
    inverse_inertia: Array


class Walls(NamedTuple):
    """Half spaces (w,): unit normals (w, 3) into the room, offsets [m], coefficients of friction and restitution."""

    normal: Array
    offset: Array
    friction: Array
    restitution: Array


class Laws(NamedTuple):
    """Laws of a pile: gravity (3,) [m/s^2], coefficients between balls, tolerance [m], greatest number of sweeps."""

    gravity: Array
    friction: float
    restitution: float
    tolerance: float
    sweeps: int


class Memory(NamedTuple):
    """Contacts of the last slab: pairs (c, 2), impulses (c, 4) [N s], and 1 (c,) for those that are closed."""

    pairs: IntArray
    impulse: Array
    closed: IntArray


class Contacts(NamedTuple):
    """Contacts (c,) of a slab in the order of the islands.

    ``pairs`` (c, 2) are the lower ball, and the higher ball or ``n`` + wall; ``first`` and ``second`` the bodies, n for
    the ground.  Columns of ``row`` are named below, those of ``impulse`` are the normal one, and the tangential vector.
    ``start`` (i + 1,), ``bodies`` and ``body_start`` (i + 1,) list contacts and balls of the islands.
    """

    pairs: IntArray
    first: IntArray
    second: IntArray
    row: Array
    impulse: Array
    start: IntArray
    bodies: IntArray
    body_start: IntArray


class Work(NamedTuple):
    """Work space of the sweeps: impulses (c, 4) and velocities (n + 1, 6) before one, and the directions of search."""

    impulse: Array
    velocity: Array
    along: Array
    moving: Array


ARM_A, ARM_B, NORMAL, TANGENT, BIAS, FRICTION, LEAST, SCALE, RATIO = 3, 4, 5, 6, 7, 8, 9, 10, 11
PER_NORMAL, PER_TANGENT = 12, 13
"""Columns of ``Contacts.row`` after the unit normal from the first body to the second.

Arms of the place of contact, compliances, velocity that is added to that of the gap, coefficient of friction, least
limit of the friction, length of the mean direction over the distance of touching centres, and
coefficient of restitution; and inverses of the compliances.
"""
FINER = 0.01
"""Tolerance of the sweeps with friction, which the next slabs go on from, relative to that of the gaps."""
COLUMNS = 14
DISSIPATION, OVERLAP, SLIP, SWEEPS, TOUCHES, CLOSED, UNFINISHED, SLABS = 0, 1, 2, 3, 4, 5, 6, 7
"""What is told of slabs: energy [J], greatest overlap [m], greatest miss of the law of friction [m/s], and counts."""
TOLD = 8
