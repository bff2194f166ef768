"""Slabs (time steps) of stored energies on contact rows whose status stays, one after the other.

The steps are those of the fixed point with a frozen operator and Anderson mixing
(:mod:`softway.solve.methods.fixed_point`).  A slab is left to the solver for all models where it does more than
iterate to its solution, and where a decision is close.
"""

import numpy as np

from softway.kernels.jit.compilation import merged, uncounted_kernel
from softway.kernels.slab.audit import audited
from softway.kernels.slab.march import UNIT, add_impulses, arrive, expect, press, stays
from softway.kernels.slab.products import extent, greatest, momenta, spread
from softway.kernels.slab.stored.closure import certain, close
from softway.kernels.slab.stored.force import stored_forces
from softway.kernels.slab.stored.mixing import KEPT, PREVIOUS, mix
from softway.kernels.slab.stored.tables import (
    BEFORE,
    DEAR,
    LATEST,
    LEAST,
    PRICE,
    SLABS,
    TOLERANCE,
    TOTAL,
    USUAL,
    WORN,
    search_at,
    turning_at,
)
from softway.kernels.slab.stored.turning import solve_turned, turn
from softway.kernels.slab.tables import (
    FIRST,
    ITERATIONS,
    LAST,
    LOST,
    bodies_at,
    course_at,
    operator_at,
    rows_at,
    work_at,
)

NEAR = 0.99
"""Part of the tolerance up to which a change is within it; where changes are rounding, both paths may differ more."""
WINDOW = 10
"""Iterations after which slow convergence asks for a new operator."""
SLOW = 0.5
"""Contraction up to which it certainly does not, if few iterations are left."""
FEW = 0.9
"""Part of the iterations that a new operator would cost, up to which it is certainly not worth it."""
STUCK, ASTRAY, IDLE = 0.95, 50.0, 4
"""Ratio of successive changes above which an iterate makes no progress, ratio to the least one above which it goes
astray, and iterations without halving of the change after which it may be rounding."""


@uncounted_kernel
def stored_slabs(places, account, wanted):
    """Compute up to ``wanted`` slabs from the first state of a course, and return how many were computed.

    ``places`` (7,) are the addresses of the tables of bodies, rows, operator, course, work, search and turning.
    ``account`` (4,) are energy at the start of the march, external work, error and dissipated energy.
    """
    bodies, rows, operator = bodies_at(places[0]), rows_at(places[1]), operator_at(places[2])
    course, work = course_at(places[3]), work_at(places[4])
    search, turning = search_at(places[5]), turning_at(places[6])
    momenta(bodies, course.v[0], work.before)
    for s in range(wanted):
        if not _slab(bodies, rows, operator, course, work, search, turning, s):
            return s
        course.sums[s, LOST] = account[3]
        if not audited(bodies, rows, course, work, account, s):
            return s
        for c in range(len(work.q)):
            work.before[c] = work.after[c]
        if _dear(search, np.int64(course.sums[s, ITERATIONS])):
            return s + 1
    return wanted


@merged
def _dear(search, iterations):
    """Count a slab; true if its operator is worn, see ``OperatorMemory.after``."""
    it, limits = search.taken, search.limits
    it[LEAST] = min(it[LEAST], iterations) if it[SLABS] else iterations
    it[SLABS] += 1
    it[TOTAL] += iterations
    it[BEFORE], it[LATEST] = it[LATEST], iterations
    recent, mean = 0.5 * (it[BEFORE] + it[LATEST]), (it[TOTAL] + limits[PRICE]) / it[SLABS]
    dear = it[SLABS] > 1 and recent > max(mean, limits[WORN] * max(it[LEAST], limits[USUAL]))
    it[DEAR] = 1 if dear else 0
    return dear


@merged
def _slab(bodies, rows, operator, course, work, search, turning, s):
    """Solve a slab; false if it is not certain."""
    h = course.time[s + 1] - course.time[s]
    if not turn(bodies, rows, operator, turning, course.u[s], work.x[: len(operator.pivot)]):
        return False
    if not expect(bodies, rows, course, work, h, s):
        return False
    for r in range(len(rows.offset)):
        course.pressure[s + 1, r] = h * UNIT * course.pressure[s, r]
    search.kept[KEPT] = search.kept[PREVIOUS] = 0
    count = _iterated(bodies, rows, operator, course, work, search, turning, h, s)
    if count == 0:
        return False
    course.sums[s, ITERATIONS], course.sums[s, FIRST] = count, search.changes[0]
    course.sums[s, LAST] = search.changes[count - 1]
    _evaluate(bodies, course, work, search, h, s)
    for r in range(len(rows.offset)):
        course.pressure[s + 1, r] /= h * UNIT
    return close(bodies, rows, course, work, search, 1.0, s) and certain(search)


@merged
def _evaluate(bodies, course, work, search, h, s):
    """Displacement, internal force and energy at the end of a slab for q."""
    arrive(bodies, course.u[s], course.v[s], work.q, h, course.u[s + 1])
    stored_forces(
        bodies.first, bodies.dimension, search.solids, course.u[s + 1], course.force[s + 1], course.energy[s + 1]
    )


@merged
def _iterated(bodies, rows, operator, course, work, search, turning, h, s):
    """Number of iterations to a solution, or 0 if there is none or a decision is close."""
    size, before = extent(bodies, course.u[s]), greatest(course.v[s])
    rounding, tolerance = 8.0 * np.finfo(np.float64).eps * size / h, search.limits[TOLERANCE]
    best, closest, idle, stuck = np.inf, np.inf, 0, 0
    for count in range(1, len(search.changes) + 1):
        _evaluate(bodies, course, work, search, h, s)
        if count == 1:
            course.scalar[s] = 0.0
        elif not close(bodies, rows, course, work, search, 1.0 / (h * UNIT), s):
            return 0
        change = _corrected(bodies, rows, operator, course, work, turning, h, s)
        scale = max(greatest(work.q), before, 1e-300)
        search.changes[count - 1] = change
        if not (change < np.inf and scale * h <= size) or not stays(
            bodies, rows, operator, course, work, h, rounding, s
        ):
            return 0
        wanted = tolerance * scale
        if change <= NEAR * wanted:
            return count
        stuck = stuck + 1 if count > 1 and change > STUCK * search.changes[count - 2] else 0
        idle = 0 if change < 0.5 * best and best > rounding else idle + 1
        best = change if idle == 0 else best
        if NEAR * change <= wanted or stuck == 2 or idle == IDLE or change > ASTRAY * closest:
            return 0
        closest = min(closest, change)
        if count > WINDOW and _renews(search, count, change / wanted):
            return 0
        mix(search, work.after, work.q, course.pressure[s + 1])
    return 0


@merged
def _renews(search, count, distance):
    """True if a new operator may be worth it, see :mod:`softway.solve.methods.renewal`."""
    rate = (search.changes[count - 1] / search.changes[count - 1 - WINDOW]) ** (1.0 / WINDOW)
    if rate > SLOW:
        return True
    return np.log(max(distance, 1.0)) / -np.log(rate) > FEW * (search.limits[PRICE] + search.limits[USUAL])


@merged
def _corrected(bodies, rows, operator, course, work, turning, h, s):
    """Correct q (N,) and the impulses (m,) of the active rows by the operator; return the greatest change."""
    f0, f1, v, x, field = course.force[s], course.force[s + 1], course.v[s], work.x, work.after
    for c in range(len(field)):
        field[c] = work.q[c] - v[c]
    momenta(bodies, field, work.push)
    for part in range(len(bodies.floor)):
        first, last = 0.5 - course.scalar[s, part], 0.5 + course.scalar[s, part]
        for c in range(bodies.first[part] * bodies.dimension, bodies.first[part + 1] * bodies.dimension):
            if bodies.place[c] >= 0:
                load = bodies.load[c]
                mean = h * (first * f0[c] + last * f1[c] - load)
                x[bodies.place[c]] = -(work.push[c] + mean) if bodies.heavy[c] else -h * UNIT * (f1[c] - load)
    add_impulses(bodies, rows, operator.active, course.pressure[s + 1], x)
    solve_turned(bodies, operator, turning, x[: len(operator.pivot)])
    spread(bodies, x, field)
    return press(bodies, rows, operator, course, work, h, s)
