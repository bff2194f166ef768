"""Scalars that close the energy balances of a slab (time step), see :mod:`softway.solve.equations.energy_balance`."""

import numpy as np

from softway.kernels.jit.compilation import called
from softway.kernels.slab.products import extent
from softway.kernels.slab.stored.tables import (
    CHANGE,
    FLOOR,
    MISSING,
    ROUGH,
    ROUNDING,
    SCALAR,
    SLIGHT,
    STRAINED,
    TOUCHED,
    WORK,
)
from softway.kernels.slab.works import LOADED, MOVING, SIZE, SLOPE, STILL, part_works
from softway.tolerances import AT_REST, DECIDED, SUMS

CLEAR = 0.95
"""Part of a limit within which a scalar is certain, and so is the missing work: both follow from the solution."""
BOUND = 0.5
"""Greatest scalar that is not bounded, see :mod:`softway.solve.equations.energy_balance`."""


@called
def close(bodies, rows, course, work, search, unit, s):
    """Set the scalars of all solids for the forces at the ends of a slab; false if one is near its bound.

    ``unit`` makes forces of impulses.
    """
    _balances(bodies, rows, course, work, search, unit, s)
    within = True
    for g in range(len(search.balance)):
        it = search.balance[g]
        acts = it[TOUCHED] > 0.0 or it[STRAINED] > AT_REST * it[FLOOR]
        a = it[MISSING] / it[CHANGE] if acts and abs(it[MISSING]) > it[ROUNDING] else 0.0
        within = within and abs(a) <= CLEAR * BOUND
        it[SCALAR] = a
    for part in range(len(bodies.floor)):
        course.scalar[s, part] = search.balance[bodies.group[part], SCALAR]
    return within


@called
def certain(search):
    """True if the scalars of the last :func:`close` certainly are what they are, and no reason for a shorter slab."""
    limits = search.limits
    sure = True
    for g in range(len(search.balance)):
        it = search.balance[g]
        missing, at_rest = abs(it[MISSING]), AT_REST * it[FLOOR]
        clear = it[TOUCHED] > 0.0 or not DECIDED * at_rest <= it[STRAINED] <= at_rest / DECIDED
        near = DECIDED * it[ROUNDING] <= missing <= it[ROUNDING] / DECIDED
        rough = abs(it[SCALAR]) > CLEAR * limits[ROUGH] and missing > CLEAR * limits[SLIGHT] * it[WORK]
        sure = sure and (clear or missing <= DECIDED * it[ROUNDING]) and not near and not rough
    return sure


@called
def _balances(bodies, rows, course, work, search, unit, s):
    """Set the terms of the balance of each group."""
    u0, u1, f0, f1, d = course.u[s], course.u[s + 1], course.force[s], course.force[s + 1], bodies.dimension
    blur = 4.0 * np.finfo(np.float64).eps * extent(bodies, u1)
    for c in range(len(work.push)):
        work.push[c] = 0.5 * (f0[c] + f1[c])
    part_works(bodies.first, d, bodies.heavy, (bodies.load, bodies.load), u0, u1, (f0, f1), work.push, work.works)
    search.balance[:] = 0.0
    for part in range(len(bodies.floor)):
        it, done = search.balance[bodies.group[part]], work.works[part]
        V0, V1, kinetic = course.energy[s, part], course.energy[s + 1, part], 0.0
        for c in range(bodies.first[part] * d, bodies.first[part + 1] * d):
            kinetic += 0.5 * course.v[s, c] * work.before[c]
        it[MISSING] += V1 - V0 - done[MOVING] - done[STILL]
        it[CHANGE] += done[SLOPE]
        it[ROUNDING] += SUMS * (abs(V0) + abs(V1) + kinetic + done[SIZE] + done[LOADED]) + bodies.floor[part]
        it[WORK] += done[SIZE]
        it[STRAINED] += abs(V0) + abs(V1)
        it[FLOOR] += bodies.floor[part]
    for r in range(len(rows.offset)):
        it, p0, p1 = search.balance[bodies.group[rows.part[r]]], course.pressure[s, r], unit * course.pressure[s + 1, r]
        it[ROUNDING] += blur * (abs(p0) + abs(p1))
        if p0 > 0.0 or p1 > 0.0:
            it[TOUCHED] = 1.0
