"""Slabs of central differences on a device: motion of the nodes, contact rows, and sums of the balances.

Nodal fields are (n, d).  ``inverse`` are reciprocals of masses, zero on supported and on massless components; ``light``
(n,) is 1 for massless nodes, ``free`` (n, d) for components without a support; ``handed`` are internal forces with the
unbalanced ones of massless nodes on the nodes that they follow (docs/theory/solver/explicit.md).
"""

from softway.kernels.device.door import wp

TALLIES = 12
"""Rows of :func:`tally`: kinetic energy, work of loads, momentum (3), spin (3), momentum beyond the impulses (3), and
the sum of the sizes of momenta and impulses."""
MET = 4
"""Rows of the sums of :func:`meet`: mean force, power residual, complementarity, and 1 for a closed row."""
WORST = 3
"""Rows of the greatest values of :func:`meet`: overlap, overlap of an open row, tension of a closed one."""


@wp.kernel
def predict(h: wp.float64, load: wp.array2d(dtype=wp.float64), handed: wp.array2d(dtype=wp.float64),
            inverse: wp.array2d(dtype=wp.float64), light: wp.array(dtype=wp.int32),
            free: wp.array2d(dtype=wp.int32), u: wp.array2d(dtype=wp.float64), v: wp.array2d(dtype=wp.float64),
            before: wp.array2d(dtype=wp.float64), slope: wp.array2d(dtype=wp.float64),
            end: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Slope of the velocity at the start, and the displacement at the end without contact."""
    node, i = wp.tid()
    if free[node, i] == 0:
        slope[node, i] = wp.float64(0.0)
        end[node, i] = u[node, i]
        return
    a = inverse[node, i] * (load[node, i] - handed[node, i])
    if light[node] == 1:
        a = wp.float64(2.0) * before[node, i]
    slope[node, i] = a
    end[node, i] = u[node, i] + h * (v[node, i] + wp.float64(0.5) * h * a)


@wp.kernel
def reach(h: wp.float64, load: wp.array2d(dtype=wp.float64), handed: wp.array2d(dtype=wp.float64),
          inverse: wp.array2d(dtype=wp.float64), light: wp.array(dtype=wp.int32), free: wp.array2d(dtype=wp.int32),
          u: wp.array2d(dtype=wp.float64), end: wp.array2d(dtype=wp.float64), v: wp.array2d(dtype=wp.float64),
          slope: wp.array2d(dtype=wp.float64), velocity: wp.array2d(dtype=wp.float64),
          after: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Velocity at the end of a slab, and its mean slope."""
    node, i = wp.tid()
    found = wp.float64(0.0)
    if free[node, i] == 1:
        if light[node] == 1:
            found = (end[node, i] - u[node, i]) / h
        else:
            last = inverse[node, i] * (load[node, i] - handed[node, i])
            found = v[node, i] + wp.float64(0.5) * h * (slope[node, i] + last)
    velocity[node, i] = found
    after[node, i] = (found - v[node, i]) / h


@wp.kernel
def unbalanced(force: wp.array2d(dtype=wp.float64), load: wp.array2d(dtype=wp.float64),
               push: wp.array2d(dtype=wp.float64), light: wp.array(dtype=wp.int32), free: wp.array2d(dtype=wp.int32),
               out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Unbalanced forces of massless components; zero on the others."""
    node, i = wp.tid()
    missing = wp.float64(0.0)
    if light[node] == 1 and free[node, i] == 1:
        missing = force[node, i] - load[node, i] - push[node, i]
    out[node, i] = missing


@wp.kernel
def balanced(load: wp.array2d(dtype=wp.float64), push: wp.array2d(dtype=wp.float64), light: wp.array(dtype=wp.int32),
             free: wp.array2d(dtype=wp.int32), handed: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Set the forces of massless components to those of loads and contact, with which they are in equilibrium."""
    node, i = wp.tid()
    if light[node] == 1 and free[node, i] == 1:
        handed[node, i] = load[node, i] + push[node, i]


@wp.kernel
def picked(nodes: wp.array(dtype=wp.int32), field: wp.array2d(dtype=wp.float64),
           out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Values at some nodes."""
    k, i = wp.tid()
    out[k, i] = field[nodes[k], i]


@wp.kernel
def residual(load: wp.array(dtype=wp.float64), force: wp.array(dtype=wp.float64), where: wp.array(dtype=wp.int32),
             own: wp.array(dtype=wp.int32), sign: wp.float64, out: wp.array(dtype=wp.float64)):  # fmt: skip
    """``sign (load - force)`` at the components ``where`` of the loads and ``own`` of the forces."""
    k = wp.tid()
    out[k] = sign * (load[where[k]] - force[own[k]])


@wp.kernel
def moved(where: wp.array(dtype=wp.int32), change: wp.array(dtype=wp.float64),
          field: wp.array(dtype=wp.float64)):  # fmt: skip
    """Add a change to the components ``where`` of a field."""
    k = wp.tid()
    field[where[k]] = field[where[k]] + change[k]


@wp.kernel
def placed(where: wp.array(dtype=wp.int32), values: wp.array(dtype=wp.float64),
           out: wp.array(dtype=wp.float64)):  # fmt: skip
    """Set the entries ``where``."""
    k = wp.tid()
    out[where[k]] = values[k]


@wp.kernel
def taken(where: wp.array(dtype=wp.int32), values: wp.array(dtype=wp.float64),
          out: wp.array(dtype=wp.float64)):  # fmt: skip
    """Values at the entries ``where``, with the opposite sign."""
    k = wp.tid()
    out[k] = -values[where[k]]


@wp.kernel
def below(gap: wp.array(dtype=wp.float64), allowed: wp.array(dtype=wp.float64),
          out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Overlap beyond the allowed one."""
    r = wp.tid()
    out[0, r] = -gap[r] - allowed[r]


@wp.kernel
def meet(closed: wp.array(dtype=wp.int32), floor: wp.float64, before: wp.array(dtype=wp.float64),
         gap: wp.array(dtype=wp.float64), first: wp.array(dtype=wp.float64), last: wp.array(dtype=wp.float64),
         sums: wp.array2d(dtype=wp.float64), worst: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Values of each row for the sums and the greatest values of its contact."""
    r = wp.tid()
    none = wp.float64(0.0)
    force = wp.float64(0.5) * (first[r] + last[r])
    drift = wp.float64(0.0)
    sums[2, r] = none
    sums[3, r] = none
    if last[r] > none:
        drift = gap[r]
        sums[2, r] = wp.abs(last[r] * gap[r])
        sums[3, r] = wp.float64(1.0)
    if first[r] > none:
        drift = drift - before[r]
    sums[0, r] = force
    sums[1, r] = wp.abs(force * drift)
    worst[0, r] = -gap[r]
    if closed[r] == 1:
        worst[1, r] = -floor
        worst[2, r] = -last[r]
    else:
        worst[1, r] = -gap[r] - floor
        worst[2, r] = wp.float64(-1.0)


@wp.kernel
def tally(h: wp.float64, mass: wp.array(dtype=wp.float64), points: wp.array2d(dtype=wp.float64),
          load: wp.array2d(dtype=wp.float64), free: wp.array2d(dtype=wp.int32), u: wp.array2d(dtype=wp.float64),
          end: wp.array2d(dtype=wp.float64), v: wp.array2d(dtype=wp.float64), velocity: wp.array2d(dtype=wp.float64),
          opening: wp.array2d(dtype=wp.float64), closing: wp.array2d(dtype=wp.float64),
          first: wp.array2d(dtype=wp.float64), last: wp.array2d(dtype=wp.float64),
          out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Contribution of each node to the sums of a slab; ``first`` and ``last`` are contact forces at its ends."""
    n = wp.tid()
    half = wp.float64(0.5)
    x, p = wp.vec3d(), wp.vec3d()
    kinetic, work, size = wp.float64(0.0), wp.float64(0.0), wp.float64(0.0)  # one name for each: sums are in place
    for row in range(8, 11):
        out[row, n] = wp.float64(0.0)
    for i in range(u.shape[1]):
        x[i] = points[n, i] + end[n, i]
        p[i] = mass[n] * velocity[n, i]
        kinetic = kinetic + half * p[i] * velocity[n, i]
        work = work + load[n, i] * (end[n, i] - u[n, i])
        gained = mass[n] * (velocity[n, i] - v[n, i])
        given = load[n, i] + half * (first[n, i] + last[n, i])
        if free[n, i] == 0:
            given = gained / h + half * (opening[n, i] + closing[n, i])
        out[8 + i, n] = gained - h * given
        size = size + wp.abs(mass[n] * v[n, i]) + wp.abs(p[i]) + h * wp.abs(given)
    turning = wp.cross(x, p)
    out[0, n] = kinetic
    out[1, n] = work
    for i in range(3):
        out[2 + i, n] = p[i]
        out[5 + i, n] = turning[i]
    out[11, n] = size


@wp.kernel
def jerk(mass: wp.array(dtype=wp.float64), edge: wp.array(dtype=wp.float64), before: wp.array2d(dtype=wp.float64),
         after: wp.array2d(dtype=wp.float64), out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Greatest change of the acceleration of a node with inertia, in its shortest edges."""
    n = wp.tid()
    most = wp.float64(0.0)
    if mass[n] > wp.float64(0.0):
        for i in range(before.shape[1]):
            most = wp.max(most, wp.abs(after[n, i] - before[n, i]) / edge[n])
    out[0, n] = most


@wp.kernel
def shortened(ends: wp.array2d(dtype=wp.int32), first: wp.array(dtype=wp.float64),
              points: wp.array2d(dtype=wp.float64), u: wp.array2d(dtype=wp.float64),
              out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Present length of each edge over the shortest initial one of its solid, with the opposite sign."""
    k = wp.tid()
    square = wp.float64(0.0)
    for i in range(u.shape[1]):
        a, b = ends[k, 0], ends[k, 1]
        part = (points[b, i] + u[b, i]) - (points[a, i] + u[a, i])
        square = square + part * part
    out[0, k] = -wp.sqrt(square) / first[k]


@wp.kernel
def fold_most(values: wp.array2d(dtype=wp.float64), out: wp.array2d(dtype=wp.float64)):
    """Greatest values of each row: thread t takes the columns t, t + threads, ..."""
    row, t = wp.tid()
    most = wp.float64(-wp.inf)
    for k in range(t, values.shape[1], out.shape[1]):
        most = wp.max(most, values[row, k])
    out[row, t] = most
