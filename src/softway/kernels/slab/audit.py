"""Balances of a solved slab (time step), and whether they certainly hold: sums in loops over nodes and rows."""

import numpy as np

from softway.kernels.jit.compilation import called
from softway.kernels.slab.products import add_forces, along, extent, momenta
from softway.kernels.slab.tables import (
    CLOSED_POWER,
    COMPLEMENTARITY,
    COUNT,
    ERROR,
    FORCE,
    FORCE_T,
    GAP,
    KINETIC,
    LOST,
    MOMENTUM,
    POWER,
    SPIN,
    STRAIN,
    UNCLOSED,
    WORK,
)
from softway.kernels.slab.works import ENDS, LOADED, MOVING, SIZE, STILL, part_works
from softway.tolerances import AT_REST, BALANCED, BEQUEST, DEPTH, ENERGY, SUMS
from softway.tolerances import MOMENTUM as MISSED


@called
def closes(bodies, rows, course, work, unit, s):
    """True if the energy of every group closes to rounding without a scalar; ``unit`` makes forces of impulses."""
    u0, u1, f0, f1, d = course.u[s], course.u[s + 1], course.force[s], course.force[s + 1], bodies.dimension
    blur = 4.0 * np.finfo(np.float64).eps * extent(bodies, u1)
    work.group[:] = 0.0
    for c in range(len(work.push)):
        work.push[c] = 0.5 * (f0[c] + f1[c])
    loads = (bodies.load_before, bodies.load)
    part_works(bodies.first, d, bodies.heavy, loads, u0, u1, (f0, f1), work.push, work.works)
    rough = len(rows.offset) > rows.normals
    for r in range(rows.normals):
        if course.pressure[s, r] > 0.0 or course.pressure[s + 1, r] > 0.0:
            work.group[bodies.group[rows.part[r]], 2] = 1.0
    for part in range(len(bodies.floor)):
        flies = rough or work.group[bodies.group[part], 2] == 0.0
        V0, V1, found = course.energy[s, part], course.energy[s + 1, part], work.works[part]
        kinetic = 0.0
        for c in range(bodies.first[part] * d, bodies.first[part + 1] * d):
            kinetic += 0.5 * course.v[s, c] * work.before[c]
        level = abs(V0) + abs(V1) + kinetic + found[SIZE] + found[LOADED]
        g = bodies.group[part]
        work.group[g, 0] += V1 - V0 - found[MOVING] - (found[ENDS] if flies else found[STILL])
        work.group[g, 1] += SUMS * level + bodies.floor[part]
    for r in range(rows.normals):
        g = bodies.group[rows.part[r]]
        work.group[g, 1] += blur * (abs(course.pressure[s, r]) + abs(unit * course.pressure[s + 1, r]))
        force = 0.5 * (course.pressure[s, r] + unit * course.pressure[s + 1, r])
        moved = along(rows, r, u1) - along(rows, r, u0) if rough and force > 0.0 else 0.0
        work.group[g, 0] += force * (moved - rows.moved[r])
        work.group[g, 1] += SUMS * 2.0 * abs(force * rows.moved[r])
    closed = True
    for g in range(len(work.group)):
        closed = closed and abs(work.group[g, 0]) <= BALANCED * work.group[g, 1]
    return closed


@called
def audited(bodies, rows, course, work, account, s):
    """Complete the state after a slab and its sums; false if a balance does not certainly hold."""
    h = course.time[s + 1] - course.time[s]
    for c in range(len(work.q)):
        v = work.q[c] if bodies.heavy[c] else 0.5 * work.q[c]
        course.v[s + 1, c] = v
        course.slope[s + 1, c] = (v - course.v[s, c]) * (1.0 / h)
        work.push[c] = 0.0
    momenta(bodies, course.v[s + 1], work.after)
    course.met[s, :, :FORCE_T] = 0.0
    for k in range(course.met.shape[1]):
        course.met[s, k, GAP] = np.inf
    gap = _touching(rows, course, work, s)
    add_forces(rows, work.row[: len(rows.offset)], work.push)
    if course.support.shape[0]:
        _supported(bodies, course, work, h, s)
    size = _momentum(bodies, course, work, h, s)
    _spin(bodies, course, work, s)
    level = _energies(bodies, rows, course, work, account, s)
    rest = 0.0
    for part in range(len(bodies.floor)):
        rest += bodies.floor[part]
    step = course.sums[s, ERROR] - (course.sums[s - 1, ERROR] if s else account[2])
    if not abs(step) <= BALANCED * (ENERGY * level + AT_REST * rest) or not gap >= -BALANCED * DEPTH * extent(
        bodies, course.u[s + 1]
    ):
        return False
    limit = BALANCED * MISSED * size
    return course.sums[s, UNCLOSED] <= limit and _unrest(bodies, rows, course, work, h, s) <= BEQUEST * limit


@called
def _touching(rows, course, work, s):
    """Sums over the contacts; the least gap.  ``work.row`` are the mean forces of the rows."""
    least = np.inf
    course.sums[s, COMPLEMENTARITY] = course.sums[s, POWER] = 0.0
    for r in range(rows.normals, len(rows.offset)):
        work.row[r] = 0.5 * course.pressure[s, r] + 0.5 * course.pressure[s + 1, r]
    for r in range(rows.normals):
        met, p0, p1 = course.met[s, rows.contact[r]], course.pressure[s, r], course.pressure[s + 1, r]
        gap = rows.offset[r] + along(rows, r, course.u[s + 1])
        before = rows.before[r] + along(rows, r, course.u[s]) if p0 > 0.0 else 0.0
        a = course.scalar[s, rows.part[r]]
        force = (0.5 - a) * p0 + (0.5 + a) * p1
        work.row[r] = force
        met[FORCE] += force
        met[GAP] = min(met[GAP], gap)
        least = min(least, gap)
        power = abs(force * ((gap if p1 > 0.0 else 0.0) - before))
        met[CLOSED_POWER] += power
        course.sums[s, POWER] += power
        if p1 > 0.0:
            met[COUNT] += 1.0
            course.sums[s, COMPLEMENTARITY] += abs(p1 * gap)
    return least


@called
def _supported(bodies, course, work, h, s):
    """Mean forces of the supports."""
    for part in range(len(bodies.floor)):
        first, last = 0.5 - course.scalar[s, part], 0.5 + course.scalar[s, part]
        for c in range(bodies.first[part] * bodies.dimension, bodies.first[part + 1] * bodies.dimension):
            course.support[s, c] = 0.0
            if bodies.place[c] < 0:
                inertia = (work.after[c] - work.before[c]) / h
                mean = first * course.force[s, c] + last * course.force[s + 1, c]
                load = 0.5 * bodies.load_before[c] + 0.5 * bodies.load[c]
                course.support[s, c] = inertia + mean - load - work.push[c]


@called
def _momentum(bodies, course, work, h, s):
    """Set momentum and its error; the sum of the sizes of its parts."""
    d, size, held = bodies.dimension, 0.0, course.support.shape[0] > 0
    course.sums[s, UNCLOSED] = 0.0
    for a in range(3):
        course.sums[s, MOMENTUM + a] = 0.0
    for a in range(d):
        gained, pushed = 0.0, 0.0
        for i in range(len(bodies.weight)):
            c = i * d + a
            load = 0.5 * bodies.load_before[c] + 0.5 * bodies.load[c]
            given = load + work.push[c] + (course.support[s, c] if held else 0.0)
            gained += bodies.weight[i] * (course.v[s + 1, c] - course.v[s, c])
            pushed += given
            size += abs(work.before[c]) + abs(work.after[c]) + h * abs(given)
            course.sums[s, MOMENTUM + a] += work.after[c]
        course.sums[s, UNCLOSED] = max(course.sums[s, UNCLOSED], abs(gained - h * pushed))
    return size


@called
def _spin(bodies, course, work, s):
    """Set the angular momentum about the origin."""
    d, u, p, spin = bodies.dimension, course.u[s + 1], work.after, course.sums[s]
    for a in range(3):
        spin[SPIN + a] = 0.0
    for c in range(0, len(u) if d > 1 else 0, d):
        x, y = bodies.points[c] + u[c], bodies.points[c + 1] + u[c + 1]
        spin[SPIN + 2] += x * p[c + 1] - y * p[c]
        if d == 3:
            z = bodies.points[c + 2] + u[c + 2]
            spin[SPIN] += y * p[c + 2] - z * p[c + 1]
            spin[SPIN + 1] += z * p[c] - x * p[c + 2]


@called
def _energies(bodies, rows, course, work, account, s):
    """Set energies, work and the error of their balance; the energy that takes part.

    ``account`` are the energy at the start, and external work and error before the first slab.
    """
    kinetic, strain, level, done = 0.0, 0.0, 0.0, 0.0
    for c in range(len(work.q)):
        kinetic += course.v[s + 1, c] * work.after[c]
        done += (0.5 * bodies.load_before[c] + 0.5 * bodies.load[c]) * (course.u[s + 1, c] - course.u[s, c])
    for r in range(len(rows.moved)):
        done += work.row[r] * rows.moved[r]
    if course.support.shape[0]:
        done += _driven(bodies, course, work, s)
    for part in range(len(bodies.floor)):
        strain += course.energy[s + 1, part]
        level += abs(course.energy[s, part]) + abs(course.energy[s + 1, part])
    total = (course.sums[s - 1, WORK] if s else account[1]) + done
    sums = course.sums[s]
    sums[KINETIC], sums[STRAIN], sums[WORK] = 0.5 * kinetic, strain, total
    sums[ERROR] = 0.5 * kinetic + strain - account[0] - total + sums[LOST]
    return level + 0.5 * kinetic + abs(total)


@called
def _driven(bodies, course, work, s):
    """Work of the supports; without the part that accelerates nodes over the way beyond that of linear velocities."""
    h, total = course.time[s + 1] - course.time[s], 0.0
    for c in range(len(work.q)):
        if bodies.place[c] < 0:
            total += course.support[s, c] * (course.u[s + 1, c] - course.u[s, c])
            total -= (work.after[c] - work.before[c]) / h * bodies.bent[c]
    return total


@called
def _unrest(bodies, rows, course, work, h, s):
    """Momentum over a slab of the unbalanced forces on massless components at its end."""
    d, most = bodies.dimension, 0.0
    for c in range(len(work.q)):
        work.push[c] = 0.0
    add_forces(rows, course.pressure[s + 1], work.push)
    for a in range(d):
        total = 0.0
        for c in range(a, len(work.q), d):
            if not bodies.heavy[c] and bodies.place[c] >= 0:
                total += course.force[s + 1, c] - bodies.load[c] - work.push[c]
        most = max(most, abs(h * total))
    return most
