"""Forces on rigid bodies in a slab (time step): gravity, springs with dampers, point forces, torques; and their work.

The force of a spring is the exact difference of its potential, ``-k (1 - l/Lm) rm`` with the means of the length and of
the vector between its ends; the moment of a torsion spring belongs to the mean of the angle.
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.joint_rows import mean_turned, turned


@uncounted
def spring_vector(springs, k, place, R):
    """Vector from the first end of a spring to the second, as three numbers, and its length."""
    a, b = springs.a[k], springs.b[k]
    xa, ya, za = turned(R, a, springs.X, k)
    xb, yb, zb = turned(R, b, springs.Y, k)
    x, y, z = (
        place[b, 0] + xb - place[a, 0] - xa,
        place[b, 1] + yb - place[a, 1] - ya,
        place[b, 2] + zb - place[a, 2] - za,
    )
    return x, y, z, np.sqrt(x * x + y * y + z * z)


@uncounted
def add_forces(bodies, springs, place0, R0, place1, R1, z, h, force):
    """Add h times the forces (n, 6) of the slab."""
    gx, gy, gz = h * bodies.gravity[0], h * bodies.gravity[1], h * bodies.gravity[2]
    for i in range(len(z) - 1):
        force[i, 0] += bodies.mass[i] * gx
        force[i, 1] += bodies.mass[i] * gy
        force[i, 2] += bodies.mass[i] * gz
    for k in range(len(springs.a)):
        x0, y0, z0, l0 = spring_vector(springs, k, place0, R0)
        x1, y1, z1, l1 = spring_vector(springs, k, place1, R1)
        mean = 0.5 * (l0 + l1)
        if mean == 0.0:
            continue
        pull = 0.5 * h * (springs.stiffness[k] * (mean - springs.rest[k]) + springs.damping[k] * (l1 - l0) / h) / mean
        _pull_at(R0, R1, springs.a[k], springs.X, k, pull * (x0 + x1), pull * (y0 + y1), pull * (z0 + z1), force)
        _pull_at(R0, R1, springs.b[k], springs.Y, k, -pull * (x0 + x1), -pull * (y0 + y1), -pull * (z0 + z1), force)
    for k in range(len(springs.turned)):
        i, factor = springs.turned[k], h * angle_factor(z, springs.turned[k])
        for c in range(3):
            force[i, 3 + c] += factor * springs.torque[k, c]
    for k in range(len(springs.pushed)):
        f = springs.force
        _pull_at(R0, R1, springs.pushed[k], springs.F, k, h * f[k, 0], h * f[k, 1], h * f[k, 2], force)


@uncounted
def add_torsion(springs, angles, start, angle, turn, h, force):
    """Add h times the moments (n, 6) of the torsion springs, with the angles at the start and the end of the slab."""
    for k in range(len(springs.about)):
        q = springs.about[k]
        moment = springs.torsion[k, 3] - springs.torsion[k, 0] * (0.5 * (start[q] + angle[q]) - springs.torsion[k, 1])
        moment = h * moment - springs.torsion[k, 2] * (angle[q] - start[q])
        for c in range(3):
            force[angles.a[q], 3 + c] -= moment * turn[q, c]
            force[angles.b[q], 3 + c] += moment * turn[q, c]


@uncounted
def add_given(space, h):
    """Add h times the forces by solids, at the mean places of the points of the bodies that they act on."""
    R0, R1, force, given = space.R0, space.R1, space.force, space.given
    for i in range(len(given)):
        for c in range(3):
            force[i, c] += h * given[i, 0, c]
        for k in range(3):
            x, y, z = R0[i, 0, k] + R1[i, 0, k], R0[i, 1, k] + R1[i, 1, k], R0[i, 2, k] + R1[i, 2, k]
            fx, fy, fz = 0.5 * h * given[i, k + 1, 0], 0.5 * h * given[i, k + 1, 1], 0.5 * h * given[i, k + 1, 2]
            force[i, 3] += y * fz - z * fy
            force[i, 4] += z * fx - x * fz
            force[i, 5] += x * fy - y * fx


@uncounted
def _pull_at(R0, R1, i, X, k, fx, fy, fz, force):
    """Add a force (times h) at the mean place of the point ``X[k]`` of body i."""
    x, y, z = turned(R1, i, X, k)
    x, y, z = mean_turned(R0, i, X, k, x, y, z)
    force[i, 0] += fx
    force[i, 1] += fy
    force[i, 2] += fz
    force[i, 3] += y * fz - z * fy
    force[i, 4] += z * fx - x * fz
    force[i, 5] += x * fy - y * fx


@uncounted
def angle_factor(z, i):
    """Angle of a rotation over the magnitude of its vector theta, ``2 atan(|theta|/2)/|theta|``."""
    size = np.sqrt(z[i, 3] * z[i, 3] + z[i, 4] * z[i, 4] + z[i, 5] * z[i, 5])
    return 1.0 if size < 1e-8 else 2.0 * np.arctan(0.5 * size) / size


@uncounted_kernel
def work_of_slab(bodies, springs, angles, motion, space, h):
    """Add the work of forces and torques to the energies that the groups have to have; take what dampers dissipate.

    What solids do is an exchange of energy with them, and not booked as work.
    """
    z = space.z
    for i in range(len(space.given)):
        done = 0.0
        for c in range(3):
            done += z[i, c] * space.given[i, 0, c]
            for k in range(3):
                done += (space.R1[i, c, k] - space.R0[i, c, k]) * space.given[i, k + 1, c]
        motion.energy[bodies.group[i]] += done
    for k in range(len(springs.a)):
        if springs.damping[k] != 0.0:
            l0 = spring_vector(springs, k, motion.place, space.R0)[3]
            l1 = spring_vector(springs, k, space.place, space.R1)[3]
            _book(bodies, motion, springs.a[k], springs.b[k], 0.0, springs.damping[k] * (l1 - l0) ** 2 / h)
    for k in range(len(springs.turned)):
        i, done = springs.turned[k], 0.0
        for c in range(3):
            done += angle_factor(z, i) * z[i, 3 + c] * springs.torque[k, c]
        _book(bodies, motion, i, i, done, 0.0)
    for k in range(len(springs.pushed)):
        i = springs.pushed[k]
        new, old = turned(space.R1, i, springs.F, k), turned(space.R0, i, springs.F, k)
        done = 0.0
        for c in range(3):
            done += (z[i, c] + new[c] - old[c]) * springs.force[k, c]
        _book(bodies, motion, i, i, done, 0.0)
    for k in range(len(springs.about)):
        q = springs.about[k]
        change = space.angle[q] - motion.angle[q]
        done, lost = springs.torsion[k, 3] * change, springs.torsion[k, 2] * change**2 / h
        _book(bodies, motion, angles.a[q], angles.b[q], done, lost)


@uncounted
def _book(bodies, motion, a, b, done, lost):
    """Book work and dissipation between two bodies."""
    i = a if a < len(motion.place) - 1 else b
    motion.energy[bodies.group[i]] += done - lost
    motion.work[0] += done
    motion.work[1] += lost
