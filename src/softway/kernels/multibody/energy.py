"""Energies of groups of connected rigid bodies, and the scalar that gives back what the joints took.

The velocities that satisfy the joints are the nearest ones, so their energy is a little too low.  The motion relative
to the mean rigid motion of a group is scaled until the energy is that which the forces of the slab left to it.
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.band import factor_band, solve_band
from softway.kernels.multibody.forces import spring_vector
from softway.kernels.multibody.joint_rows import turned_back
from softway.kernels.multibody.rotations import in_space
from softway.kernels.multibody.velocities import push_rows

AT_REST = 1e-13
"""Kinetic energy relative to the greatest energy below which a group is at rest: nothing is scaled."""
FAR = 0.05
"""Change of the squared scalar beyond which it is no correction: nothing is scaled."""


@uncounted_kernel
def kinetic_energy(bodies, motion, out):
    """Add the kinetic energies of the groups (g,)."""
    for i in range(len(motion.place) - 1):
        total = 0.0
        for c in range(3):
            total += 0.5 * bodies.mass[i] * motion.velocity[i, c] ** 2
            for m in range(3):
                total += 0.5 * motion.spin[i, c] * bodies.inertia[i, c, m] * motion.spin[i, m]
        out[bodies.group[i]] += total


@uncounted_kernel
def potential_energy(bodies, springs, angles, motion, R, out):
    """Add the potential energies of the groups (g,): weight, springs and torsion springs."""
    n, place = len(motion.place) - 1, motion.place
    for i in range(n):
        for c in range(3):
            out[bodies.group[i]] -= bodies.mass[i] * bodies.gravity[c] * place[i, c]
    for k in range(len(springs.a)):
        length = spring_vector(springs, k, place, R)[3]
        i = springs.a[k] if springs.a[k] < n else springs.b[k]
        out[bodies.group[i]] += 0.5 * springs.stiffness[k] * (length - springs.rest[k]) ** 2
    for k in range(len(springs.about)):
        q = springs.about[k]
        i = angles.a[q] if angles.a[q] < n else angles.b[q]
        out[bodies.group[i]] += 0.5 * springs.torsion[k, 0] * (motion.angle[q] - springs.torsion[k, 1]) ** 2


@uncounted_kernel
def close_energy(bodies, springs, joints, motion, space):
    """Scale the velocities of the jointed groups; the greatest change of a scalar from 1.

    The velocities that the drives prescribe are not scaled.  What a moving drive leaves open is its work.
    """
    groups, worst = len(bodies.jointed), 0.0
    kinetic, potential, mean = space.kinetic, space.potential, space.mean
    kinetic[:], potential[:], mean[:] = 0.0, 0.0, 0.0
    kinetic_energy(bodies, motion, kinetic)
    potential_energy(bodies, springs, joints.angles, motion, space.R0, potential)
    _add_driven(joints, motion, space, -1.0)
    space.rest[:] = 0.0
    kinetic_energy(bodies, motion, space.rest)
    for k in range(groups):
        rigid = 0.0
        if bodies.jointed[k] == 0:
            continue
        if bodies.supported[k] == 0:
            rigid = _mean_motion(bodies, motion, space, k, mean[k])
        driven = kinetic[k] - space.rest[k]
        moving, wanted = space.rest[k] - rigid, motion.energy[k] - potential[k] - driven - rigid
        scale = abs(motion.energy[k]) + abs(potential[k]) + kinetic[k]
        if moving <= AT_REST * scale or abs(wanted - moving) > FAR * moving:
            if space.driven[k]:
                motion.work[0] += moving - wanted
                motion.energy[k] += moving - wanted
            continue
        s = np.sqrt(wanted / moving)
        worst = max(worst, abs(s - 1.0))
        _scale(bodies, motion, space, k, mean[k], s)
    _add_driven(joints, motion, space, 1.0)
    return worst


@uncounted
def _add_driven(joints, motion, space, sign):
    """Add the velocities with the least energy that have the prescribed rates; the others are perpendicular to them."""
    if len(joints.drives.row):
        for k in range(len(space.rate)):
            space.push[k] = sign * space.rate[k]
        push_rows(joints, motion, space, space.push)


@uncounted_kernel
def _mean_motion(bodies, motion, space, group, mean):
    """Rigid motion with the momentum and spin of a free group: centre, velocity, angular velocity; its energy."""
    mass, R = 0.0, space.R0
    mean[:] = 0.0
    for i in range(len(motion.place) - 1):
        if bodies.group[i] == group:
            mass += bodies.mass[i]
            for c in range(3):
                mean[0, c] += bodies.mass[i] * motion.place[i, c]
                mean[1, c] += bodies.mass[i] * motion.velocity[i, c]
    for c in range(3):
        mean[0, c] /= mass
        mean[1, c] /= mass
    total, spin, own = space.three[0], space.three[1, 0], space.own
    total[:], spin[:] = 0.0, 0.0
    for i in range(len(motion.place) - 1):
        if bodies.group[i] != group:
            continue
        m, v, w = bodies.mass[i], motion.velocity, motion.spin
        x, y, z = motion.place[i, 0] - mean[0, 0], motion.place[i, 1] - mean[0, 1], motion.place[i, 2] - mean[0, 2]
        arm = (x, y, z)
        in_space(R, bodies.inertia, i, own)
        spin[0] += m * (y * v[i, 2] - z * v[i, 1])
        spin[1] += m * (z * v[i, 0] - x * v[i, 2])
        spin[2] += m * (x * v[i, 1] - y * v[i, 0])
        for c in range(3):
            turning = R[i, c, 0] * w[i, 0] + R[i, c, 1] * w[i, 1] + R[i, c, 2] * w[i, 2]
            for j in range(3):
                spin[j] += own[i, j, c] * turning
                total[c, j] += own[i, c, j] - m * arm[c] * arm[j]
            total[c, c] += m * (x * x + y * y + z * z)
    _solve(total, spin, mean[2], space.three)
    energy = 0.0
    for c in range(3):
        energy += 0.5 * mass * mean[1, c] ** 2 + 0.5 * spin[c] * mean[2, c]
    return energy


@uncounted_kernel
def _solve(matrix, b, x, three):
    """Solution x (3,) of a symmetric positive semidefinite system; zero along dependent rows."""
    band, lower, pivot = three[2], three[3], three[1, 1]
    for i in range(3):
        x[i] = b[i]
        for j in range(i + 1):
            band[i, i - j] = matrix[i, j]
    factor_band(band, lower, pivot)
    solve_band(lower, pivot, x)


@uncounted_kernel
def _scale(bodies, motion, space, group, mean, s):
    """Scale the velocities of a group relative to its mean motion by s."""
    p, q, r = mean[2, 0], mean[2, 1], mean[2, 2]
    for i in range(len(motion.place) - 1):
        if bodies.group[i] != group:
            continue
        x, y, z = motion.place[i, 0] - mean[0, 0], motion.place[i, 1] - mean[0, 1], motion.place[i, 2] - mean[0, 2]
        rigid = mean[1, 0] + q * z - r * y, mean[1, 1] + r * x - p * z, mean[1, 2] + p * y - q * x
        own = turned_back(space.R0, i, p, q, r)
        for c in range(3):
            motion.velocity[i, c] = rigid[c] + s * (motion.velocity[i, c] - rigid[c])
            motion.spin[i, c] = own[c] + s * (motion.spin[i, c] - own[c])
