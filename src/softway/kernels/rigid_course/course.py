"""States of a mechanism after every few slabs (time steps), which compiled slabs write."""

from typing import NamedTuple

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.by_address import passed_by_address
from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.energy import kinetic_energy, potential_energy
from softway.kernels.multibody.slab import march_slabs

KINETIC, POTENTIAL, WORK, DISSIPATION, MOMENTUM, SPIN = 0, 1, 2, 3, 4, 7
"""Columns of the sums: energies, work and dissipation [J], momentum [kg m/s] and angular momentum [kg m^2/s] (3)."""
SUMS = 10
ITERATIONS, INDEPENDENT = 0, 1
"""Columns of the counts: iterations since the row before, and rows of joints that do not depend on others."""


@passed_by_address
class Course(NamedTuple):
    """States in k rows, of which each is ``every`` slabs after that before.

    Body i of the user is part of the body ``whole[i]`` of the tables, with its centre at ``arm[i]`` (3,) from the
    centre of that one, at the start.  ``centre``, ``velocity``, ``spin`` (k, b, 3) and ``rotation`` (k, b, 3, 3) are
    those of the user's bodies in space; ``sums`` (k, SUMS), ``counts`` (k, 2), mean forces of the ``motors`` (k, m),
    ``closed`` stops (k, s), and ``told`` (k, 3): greatest value and velocity of the joints, and greatest change of the
    scalars from 1, since the row before.
    """

    every: int
    whole: IntArray
    arm: Array
    centre: Array
    rotation: Array
    velocity: Array
    spin: Array
    sums: Array
    counts: IntArray
    motors: Array
    closed: BoolArray
    told: Array


def course(rows: int, every: int, whole: IntArray, arm: Array, motors: int, stops: int) -> Course:
    """Table of a number of rows for the bodies ``whole`` (b,) with their ``arm`` (b, 3)."""
    b = len(whole)
    return Course(
        every=every,
        whole=whole,
        arm=arm,
        centre=np.empty((rows, b, 3)),
        rotation=np.empty((rows, b, 3, 3)),
        velocity=np.empty((rows, b, 3)),
        spin=np.empty((rows, b, 3)),
        sums=np.zeros((rows, SUMS)),
        counts=np.zeros((rows, 2), np.int64),
        motors=np.empty((rows, motors)),
        closed=np.zeros((rows, stops), np.bool_),
        told=np.zeros((rows, 3)),
    )


@uncounted_kernel
def reach(place, velocity, gravity, extent, h):
    """Extent of a mechanism with its places, or its way in a slab of length h: the scale of rounding [m]."""
    far = fast = pull = 0.0
    for i in range(len(place)):
        for c in range(3):
            far, fast = max(far, abs(place[i, c])), max(fast, abs(velocity[i, c]))
    for c in range(3):
        pull = max(pull, abs(gravity[c]))
    return max(max(extent, far), max(h * (fast + h * pull), 1e-300))


@uncounted
def is_noted(course, slab, total):
    """True if the state after a slab of a group of ``total`` is that of a row."""
    return (slab + 1) % course.every == 0 or slab + 1 == total


@uncounted_kernel
def note_state(bodies, joints, springs, motion, space, course, row):
    """Set a row of the course to the present state; its ``told`` and its iterations are those of the slabs."""
    note_bodies(motion, space, course, row)
    sums = course.sums[row]
    for k in range(len(sums)):
        sums[k] = 0.0
    for g in range(len(space.kinetic)):
        space.kinetic[g] = space.potential[g] = 0.0
    kinetic_energy(bodies, motion, space.kinetic)
    potential_energy(bodies, springs, joints.angles, motion, space.R0, space.potential)
    for g in range(len(space.kinetic)):
        sums[KINETIC] += space.kinetic[g]
        sums[POTENTIAL] += space.potential[g]
    sums[WORK], sums[DISSIPATION] = motion.work[0], motion.work[1]
    _note_momenta(bodies, motion, space, sums)
    course.counts[row, INDEPENDENT] = 0
    for k in range(len(space.pivot)):
        course.counts[row, INDEPENDENT] += 1 if space.pivot[k] > 0.0 else 0
    for k in range(len(space.drive)):
        course.motors[row, k] = space.drive[k, 2]


@uncounted_kernel
def note_bodies(motion, space, course, row):
    """Set the places, rotations and velocities of the user's bodies."""
    for b in range(len(course.whole)):
        i, arm = course.whole[b], course.arm[b]
        x, w = course.centre[row, b], course.spin[row, b]
        for c in range(3):
            x[c] = w[c] = 0.0
            for m in range(3):
                course.rotation[row, b, c, m] = space.R0[i, c, m]
                x[c] += space.R0[i, c, m] * arm[m]
                w[c] += space.R0[i, c, m] * motion.spin[i, m]
        v = course.velocity[row, b]
        v[0] = motion.velocity[i, 0] + (w[1] * x[2] - w[2] * x[1])
        v[1] = motion.velocity[i, 1] + (w[2] * x[0] - w[0] * x[2])
        v[2] = motion.velocity[i, 2] + (w[0] * x[1] - w[1] * x[0])
        for c in range(3):
            x[c] += motion.place[i, c]


@uncounted
def _note_momenta(bodies, motion, space, sums):
    """Add momentum, and angular momentum about the origin."""
    for i in range(len(motion.place) - 1):
        x, v, m = motion.place[i], motion.velocity[i], bodies.mass[i]
        sums[SPIN] += m * (x[1] * v[2] - x[2] * v[1])
        sums[SPIN + 1] += m * (x[2] * v[0] - x[0] * v[2])
        sums[SPIN + 2] += m * (x[0] * v[1] - x[1] * v[0])
        for c in range(3):
            sums[MOMENTUM + c] += m * v[c]
            own = 0.0
            for k in range(3):
                own += bodies.inertia[i, c, k] * motion.spin[i, k]
            for k in range(3):
                sums[SPIN + k] += space.R0[i, k, c] * own


@uncounted_kernel
def march_rows(bodies, joints, springs, motion, space, course, extent, h, first, total):
    """March the slabs ``first`` to ``total`` of a group without stops; the number of the first that is not solved."""
    for slab in range(first, total):
        row = slab // course.every
        scale = reach(motion.place, motion.velocity, bodies.gravity, extent, h)
        done, used = march_slabs(bodies, joints, springs, motion, space, h, np.int64(1), scale, course.told[row])
        if done == 0:
            return slab
        course.counts[row, ITERATIONS] += used
        if is_noted(course, slab, total):
            note_state(bodies, joints, springs, motion, space, course, row)
    return total
