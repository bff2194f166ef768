"""Slabs (time steps) of linear laws on contact rows whose status stays, one after the other.

A slab is left to the solver for all models, which computes it from the same state, where a decision is close: a row
that opens or closes, an iteration that has not converged twice as well as it has to, a scalar of the energy balance
that is not zero, or a balance within half its limit.  So both take the same decisions, whatever their last digits are.
"""

import numpy as np

from softway.kernels.jit.compilation import called, uncounted_kernel
from softway.kernels.multibody.band import factor_band
from softway.kernels.slab.audit import audited, closes
from softway.kernels.slab.products import add_impulse, along, elastic, extent, greatest, momenta, spread
from softway.kernels.slab.solution import solve, solve_with
from softway.kernels.slab.tables import (
    FIRST,
    ITERATIONS,
    LAST,
    LOST,
    PartCall,
    bodies_at,
    call_part,
    course_at,
    operator_at,
    rows_at,
    work_at,
)
from softway.tolerances import DECIDED

LEAST = 1e-9
"""Force of a row, relative to the greatest one, above which it stays closed."""
CLOSE = 1e-14
"""Difference of velocities, relative to them, that is rounding."""
ALLOWS, PREPARES, RUBS = range(3)
"""Places of the optional parts."""
UNIT = 0.5
"""Second moment of the end peaks: the part of the slab in which a force at its end acts."""


@uncounted_kernel
def factor(matrix, lower, pivot):
    """Factor an operator in a band; false if it is not positive definite."""
    factor_band(matrix, lower, pivot)
    positive = True
    for i in range(len(pivot)):
        positive = positive and pivot[i] > 0.0
    return positive


@uncounted_kernel
def answer(bodies_place, rows_place, r, down, up, pivot, single, library, x, out):
    """Answer (N,) of the operator to a unit impulse on a row; ``x`` (f,) is work space."""
    bodies, rows = bodies_at(bodies_place), rows_at(rows_place)
    x[:] = 0.0
    add_impulse(bodies, rows, r, 1.0, x)
    solve(down, up, pivot, single, library, x)
    spread(bodies, x, out)


@uncounted_kernel
def slabs(places, parts, tolerance, account, wanted):
    """Compute up to ``wanted`` slabs from the first state of a course, and return how many were computed.

    ``places`` (8,) are the addresses of the tables of bodies, rows, operator, course and work, and of those of optional
    ``parts`` (3,): the addresses of parts that allow a solved slab, that prepare a slab, and for friction, or zero.
    ``account`` (4,) are energy at the start of the march, external work, error and dissipated energy, ``tolerance``
    is that of the iteration.
    """
    bodies, rows, operator = bodies_at(places[0]), rows_at(places[1]), operator_at(places[2])
    course, work = course_at(places[3]), work_at(places[4])
    momenta(bodies, course.v[0], work.before)
    for s in range(wanted):
        if parts[PREPARES] != 0:
            call_part(parts[PREPARES], PartCall(places, s))
        if not _slab(bodies, rows, operator, course, work, tolerance, s):
            return s
        course.sums[s, LOST] = account[3]
        if parts[RUBS] != 0 and call_part(parts[RUBS], PartCall(places, s)) == 0:
            return s
        if not audited(bodies, rows, course, work, account, s):
            return s
        if parts[ALLOWS] != 0 and call_part(parts[ALLOWS], PartCall(places, s)) == 0:
            return s
        for c in range(len(work.q)):
            work.before[c] = work.after[c]
    return wanted


@called
def _slab(bodies, rows, operator, course, work, tolerance, s):
    """Solve a slab; false if it is not certain."""
    h = course.time[s + 1] - course.time[s]
    if not expect(bodies, rows, course, work, h, s):
        return False
    for r in range(len(rows.offset)):
        course.pressure[s + 1, r] = h * UNIT * course.pressure[s, r]
    size = extent(bodies, course.u[s])
    rounding = 8.0 * np.finfo(np.float64).eps * size / h
    for count in range(1, 3):
        arrive(bodies, course.u[s], course.v[s], work.q, h, course.u[s + 1])
        elastic(bodies, course.u[s + 1], course.force[s + 1], course.energy[s + 1])
        if count == 2 and not closes(bodies, rows, course, work, 1.0 / (h * UNIT), s):
            return False
        change = _iterated(bodies, rows, operator, course, work, h, s)
        scale = max(greatest(work.q), greatest(course.v[s]), 1e-300)
        if count == 1:
            course.sums[s, FIRST] = change
        if not (change < np.inf and scale * h <= size):
            return False
        if not stays(bodies, rows, operator, course, work, h, rounding, s):
            return False
        if change <= DECIDED * tolerance * scale:
            break
        if count == 2 or change <= tolerance * scale / DECIDED:
            return False
    course.sums[s, ITERATIONS], course.sums[s, LAST] = count, change
    arrive(bodies, course.u[s], course.v[s], work.q, h, course.u[s + 1])
    elastic(bodies, course.u[s + 1], course.force[s + 1], course.energy[s + 1])
    for r in range(len(rows.offset)):
        course.pressure[s + 1, r] /= h * UNIT
    return closes(bodies, rows, course, work, 1.0, s)


@called
def expect(bodies, rows, course, work, h, s):
    """Set q (N,) to the velocity that goes on as before; false if a row would overlap too far without contact."""
    u, v, slope, end = course.u[s], course.v[s], course.slope[s], work.x
    for c in range(len(work.q)):
        rate = v[c] + h * slope[c] if bodies.place[c] >= 0 else bodies.given[c]
        work.q[c] = rate if bodies.heavy[c] else 2.0 * rate
        end[c] = u[c] + h * (0.5 * (v[c] + rate) if bodies.heavy[c] else rate) + bodies.bent[c]
    slow = True
    for r in range(rows.normals):
        slow = slow and rows.offset[r] + along(rows, r, end) >= -rows.allowed[r]
    return slow


@called
def arrive(bodies, u, v, q, h, out):
    """Displacement (N,) at the end of a slab of the length h, for q (N,)."""
    for c in range(len(q)):
        out[c] = u[c] + h * (0.5 * (v[c] + q[c]) if bodies.heavy[c] else 0.5 * q[c]) + bodies.bent[c]


@called
def _iterated(bodies, rows, operator, course, work, h, s):
    """Correct q (N,) and the impulses (m,) of the active rows by the operator; return the greatest change."""
    f0, f1, v, x, field = course.force[s], course.force[s + 1], course.v[s], work.x, work.after
    for c in range(len(field)):
        field[c] = work.q[c] - v[c]
    momenta(bodies, field, work.push)
    for c in range(len(field)):
        if bodies.place[c] >= 0:
            load = bodies.load[c]
            mean = h * (0.5 * f0[c] + 0.5 * f1[c] - load)
            x[bodies.place[c]] = -(work.push[c] + mean) if bodies.heavy[c] else -h * UNIT * (f1[c] - load)
    add_impulses(bodies, rows, operator.active, course.pressure[s + 1], x)
    add_impulses(bodies, rows, operator.slip, course.pressure[s + 1], x)
    solve_with(operator, x[: len(operator.pivot)])
    spread(bodies, x, field)
    return press(bodies, rows, operator, course, work, h, s)


@called
def add_impulses(bodies, rows, which, impulse, x):
    """Add the impulses of some rows to those of the unknowns."""
    for k in range(len(which)):
        add_impulse(bodies, rows, which[k], impulse[which[k]], x)


@called
def press(bodies, rows, operator, course, work, h, s):
    """Change q (N,) by the correction without new contact forces, and close the active rows; the greatest change."""
    field, impulse, k = work.after, course.pressure[s + 1], len(operator.active)
    for a in range(k):
        r = operator.active[a]
        missing = _target(bodies, rows, course, h, s, r)
        for e in range(rows.start[r], rows.start[r + 1]):
            missing -= rows.value[e] * (work.q[rows.component[e]] + field[rows.component[e]])
        work.row[a] = missing
    for a in range(k):
        total = 0.0
        for b in range(k):
            total += operator.inverse[a, b] * work.row[b]
        impulse[operator.active[a]] += total
        work.row[k + a] = total
    add_answers(operator.answer, work.row[k : 2 * k], field)
    for j in range(len(operator.slip)):
        impulse[operator.slip[j]] = operator.factor[j] * impulse[operator.partner[j]]
    for c in range(len(field)):
        work.q[c] += field[c]
    return greatest(field)


@called
def add_answers(answer, impulse, field):
    """Add answers (k, N) times impulses (k,) to a field (N,), four at a time."""
    whole = len(impulse) - len(impulse) % 4
    for a in range(0, whole, 4):
        one, two, three, four = impulse[a], impulse[a + 1], impulse[a + 2], impulse[a + 3]
        for c in range(len(field)):
            field[c] += answer[a, c] * one + answer[a + 1, c] * two + answer[a + 2, c] * three + answer[a + 3, c] * four
    for a in range(whole, len(impulse)):
        for c in range(len(field)):
            field[c] += answer[a, c] * impulse[a]


@called
def _target(bodies, rows, course, h, s, r):
    """Component of q along a row that closes its gap at the end of the slab, or along one that sticks."""
    if r >= rows.normals:
        return 2.0 / h * rows.moved[r]
    gap = rows.offset[r]
    for e in range(rows.start[r], rows.start[r + 1]):
        c = rows.component[e]
        gap += rows.value[e] * (course.u[s, c] + (h * 0.5 * course.v[s, c] if bodies.heavy[c] else 0.0))
    return -2.0 * gap / h


@called
def stays(bodies, rows, operator, course, work, h, rounding, s):
    """True if closed rows certainly stay closed, and open rows open."""
    impulse, most = course.pressure[s + 1], 0.0
    for a in range(len(operator.active)):
        most = max(most, impulse[operator.active[a]] if operator.active[a] < rows.normals else 0.0)
    for a in range(len(operator.active)):
        if operator.active[a] < rows.normals and not impulse[operator.active[a]] > LEAST * most:
            return False
    for r in range(rows.normals):
        if rows.move[r] and impulse[r] == 0.0:
            now = along(rows, r, work.q)
            slack = now - _target(bodies, rows, course, h, s, r)
            if not slack > max(rounding, CLOSE * (abs(slack) + abs(now))) / DECIDED:
                return False
    return True
