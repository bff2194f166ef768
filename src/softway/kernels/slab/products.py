"""Products of nodal fields with mass, stiffness and contact rows, in loops over nodes."""

from softway.kernels.jit.compilation import called


@called
def momenta(bodies, v, out):
    """``M v`` (N,)."""
    d = bodies.dimension
    for i in range(len(bodies.weight)):
        for a in range(d):
            total = 0.0
            for e in range(bodies.mass_start[i], bodies.mass_start[i + 1]):
                total += bodies.mass[e] * v[bodies.mass_node[e] * d + a]
            out[i * d + a] = total


@called
def elastic(bodies, u, force, energy):
    """Internal force (N,) and energy (parts,) of linear laws, by differences of displacements.

    ``K u`` itself would lose digits with the distance from the origin.
    """
    d = bodies.dimension
    for part in range(len(bodies.floor)):
        total, origin = 0.0, bodies.first[part] * d
        for i in range(bodies.first[part], bodies.first[part + 1]):
            for a in range(d):
                force[i * d + a] = 0.0
            for e in range(bodies.stiff_start[i], bodies.stiff_start[i + 1]):
                j = bodies.stiff_node[e]
                for a in range(d):
                    for b in range(d):
                        force[i * d + a] += bodies.stiff[e, a, b] * (u[j * d + b] - u[i * d + b])
            for a in range(d):
                total += force[i * d + a] * (u[i * d + a] - u[origin + a])
        energy[part] = 0.5 * total


@called
def add_impulse(bodies, rows, r, impulse, x):
    """Add the impulse of a row to those of the unknowns x (f,)."""
    for e in range(rows.start[r], rows.start[r + 1]):
        place = bodies.place[rows.component[e]]
        if place >= 0:
            x[place] += rows.value[e] * impulse


@called
def spread(bodies, x, out):
    """Field (N,) of unknowns x (f,); zero on supported components."""
    for c in range(len(out)):
        out[c] = x[bodies.place[c]] if bodies.place[c] >= 0 else 0.0


@called
def along(rows, r, field):
    """Component of a field (N,) along a row."""
    total = 0.0
    for e in range(rows.start[r], rows.start[r + 1]):
        total += rows.value[e] * field[rows.component[e]]
    return total


@called
def add_forces(rows, amounts, out):
    """Add the nodal forces (N,) of forces (m,) of the rows."""
    for r in range(len(rows.offset)):
        if amounts[r] != 0.0:
            for e in range(rows.start[r], rows.start[r + 1]):
                out[rows.component[e]] += rows.value[e] * amounts[r]


@called
def greatest(field):
    """Greatest magnitude of a field; not a number if a value is none."""
    most = 0.0
    for c in range(len(field)):
        size = abs(field[c])
        most = size if not size <= most else most
    return most


@called
def extent(bodies, u):
    """Greatest coordinate at a displacement (N,) [m]."""
    most = 0.0
    for c in range(len(u)):
        most = max(most, abs(bodies.points[c] + u[c]))
    return most
