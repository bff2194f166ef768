"""Friction on half-spaces in a slab (time step): rows that certainly stick or slip as before, and their heat."""

from functools import cache
from typing import NamedTuple

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.by_address import FLAGS, NUMBERS, ROWS, WHOLE, WHOLES, table
from softway.kernels.jit.compilation import Stage, called, uncounted_function_at
from softway.kernels.slab.products import along, greatest
from softway.kernels.slab.tables import FORCE_T, LOST, PART, bodies_at, course_at, operator_at, rows_at, work_at

CERTAIN = 1e-6
"""Difference from a limit, relative to it, beyond which a row certainly sticks; of the velocity, one that slips."""
SLOWED = 0.75
"""Power of the slip at the end of a slab, relative to that at its start, above which no body comes to rest in it."""


class Friction(NamedTuple):
    """Friction of rows (m,): each has ``tangents`` tangential rows, the greatest ratio ``limit`` (m,) of their forces
    to the normal one at rest, and some stick, ``sticks`` (m,), others slip.

    ``start`` (m tangents + 1,), ``component`` and ``value`` (z,) are tangential rows of the nodes with inertia that are
    followed.  ``heat`` (groups,) and ``power`` (contacts, 2 + d) are work space, ``lost`` (1,) is the energy dissipated
    before the first slab.
    """

    tangents: int
    limit: Array
    sticks: BoolArray
    start: IntArray
    component: IntArray
    value: Array
    heat: Array
    power: Array
    lost: Array


friction_at = table(
    "Friction",
    tangents=WHOLE,
    limit=NUMBERS,
    sticks=FLAGS,
    start=WHOLES,
    component=WHOLES,
    value=NUMBERS,
    heat=NUMBERS,
    power=ROWS,
    lost=NUMBERS,
)
"""The table at an address, for kernels."""


@cache
def rubbing() -> Stage:
    """Part that allows a solved slab in which all rows stick or slip as before; its table is the eighth."""
    return uncounted_function_at(PART, _rubbing)


def _rubbing(slab):
    places, s = slab.places, slab.number
    bodies, rows, operator = bodies_at(places[0]), rows_at(places[1]), operator_at(places[2])
    course, work, friction = course_at(places[3]), work_at(places[4]), friction_at(places[7])
    h = course.time[s + 1] - course.time[s]
    same = _stick(rows, friction, course, s) and _slip(rows, operator, course, work, h, s)
    if not (same and _go_on(rows, operator, friction, course, work, h, s)):
        return 0
    _heated(bodies, rows, friction, course, s)
    return 1


@called
def _stick(rows, friction, course, s):
    """True if rows that stick are certainly below their limit at the end of the slab."""
    k = friction.tangents
    for r in range(rows.normals):
        if friction.sticks[r]:
            total = 0.0
            for e in range(rows.normals + r * k, rows.normals + (r + 1) * k):
                total += course.pressure[s + 1, e] ** 2
            if not total**0.5 <= (1.0 - CERTAIN) * friction.limit[r] * course.pressure[s + 1, r]:
                return False
    return True


@called
def _slip(rows, operator, course, work, h, s):
    """True if rows that slip certainly do so against their force."""
    least = CERTAIN * max(greatest(work.q), greatest(course.v[s]))
    for j in range(len(operator.slip)):
        rate = along(rows, operator.slip[j], work.q) - 2.0 / h * rows.moved[operator.slip[j]]
        if not (-rate if operator.factor[j] > 0.0 else rate) > least:
            return False
    return True


@called
def _go_on(rows, operator, friction, course, work, h, s):
    """True if the friction of no contact certainly brings a body to rest in the slab, by the power of its slip."""
    friction.power[:] = 0.0
    for j in range(len(operator.slip)):
        r = operator.slip[j]
        contact, weight = rows.contact[operator.partner[j]], -course.pressure[s, r]
        one = other = -rows.moved[r]
        for e in range(friction.start[r - rows.normals], friction.start[r - rows.normals + 1]):
            one += h * friction.value[e] * course.v[s, friction.component[e]]
            other += h * friction.value[e] * work.q[friction.component[e]]
        friction.power[contact, 0] += weight * one
        friction.power[contact, 1] += weight * other
    for c in range(len(friction.power)):
        one, other = friction.power[c, 0], friction.power[c, 1]
        if not ((one == 0.0 and other == 0.0) or (one > 0.0 and other >= SLOWED * one)):
            return False
    return True


@called
def _heated(bodies, rows, friction, course, s):
    """Set the energy that friction has dissipated, and the tangential force of each contact."""
    k, d = friction.tangents, bodies.dimension
    friction.heat[:] = 0.0
    friction.power[:] = 0.0
    for r in range(rows.normals):
        for e in range(rows.normals + r * k, rows.normals + (r + 1) * k):
            force = 0.5 * course.pressure[s, e] + 0.5 * course.pressure[s + 1, e]
            if force != 0.0:
                slip = along(rows, e, course.u[s + 1]) - along(rows, e, course.u[s]) - rows.moved[e]
                friction.heat[bodies.group[rows.part[r]]] -= force * slip
                for z in range(rows.start[e], rows.start[e + 1]):
                    friction.power[rows.contact[r], 2 + rows.component[z] % d] += force * rows.value[z]
    lost = course.sums[s - 1, LOST] if s else friction.lost[0]
    for g in range(len(friction.heat)):
        lost += max(friction.heat[g], 0.0)
    course.sums[s, LOST] = lost
    for c in range(len(friction.power)):
        total = 0.0
        for i in range(d):
            total += friction.power[c, 2 + i] ** 2
        course.met[s, c, FORCE_T] = total**0.5
