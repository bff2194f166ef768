"""Slabs (time steps) of rigid bodies with joints: fixed point with a frozen factor, then the velocities of the joints.

The unknown is the motion ``z = (d, theta) = h/2 (v0 + v1, R0 (W0 + W1))`` of each body, see docs/theory/mechanisms.md.
"""

import numpy as np

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.angles import evaluate_angles
from softway.kernels.multibody.band import factor_band, solve_band
from softway.kernels.multibody.copies import copy_numbers, copy_rows, copy_tensors
from softway.kernels.multibody.drives import pass_time, set_rates, set_targets, work_of_drives
from softway.kernels.multibody.energy import close_energy, kinetic_energy, potential_energy
from softway.kernels.multibody.forces import add_forces, add_given, add_torsion, work_of_slab
from softway.kernels.multibody.joint_rows import add_angles, joint_row, turned_back
from softway.kernels.multibody.rotations import cayley_turned, in_space, matrix_of, quaternion_turned
from softway.kernels.multibody.velocities import joint_velocity, project_velocities

ITERATIONS = 60
"""Greatest number of iterations of a slab."""
CONVERGED = 1e-15
"""Change of the motion, relative to the extent of the mechanism or to a radian, at the level of rounding."""
CLOSED = 1e-13
"""Value of a joint, relative to the extent or one, at which a motion that does not change has converged."""
NEARLY = 1e-12
"""Change below which an iteration that does not improve any more has converged."""
SLOW = 0.7
"""Ratio of successive changes above which an iteration is not worth its time, if it happens twice."""


@uncounted
def evaluate_row(joints, motion, space, place1, R1, k):
    """Value of a row at an end minus the prescribed one, and its Jacobian; the angles at the end are in the space."""
    joint_row(joints, k, motion.place, space.R0, place1, R1, space.g, space.G)
    add_angles(joints, k, space.angle, space.turn, space.g, space.G)
    space.g[k] -= space.target[k]


@uncounted
def evaluate_rows(joints, motion, space, place1, R1):
    """Values g (r,) of the rows at an end and Jacobians G (r, s, 6) at its means with the state, in the space."""
    evaluate_angles(joints.angles, motion.angle, space.R0, R1, space.angle, space.turn)
    for k in range(len(space.g)):
        evaluate_row(joints, motion, space, place1, R1, k)


@uncounted_kernel
def prepare_joints(bodies, joints, motion, space):
    """Jacobians at the present state, ``M^-1 G^T``, and the factor of ``G M^-1 G^T``."""
    for i in range(len(motion.place)):
        in_space(space.R0, bodies.inverse_inertia, i, space.mobility)
    evaluate_rows(joints, motion, space, motion.place, space.R0)
    G, MG = space.G, space.MG
    for k in range(len(space.g)):
        for side in range(G.shape[1]):
            i = joints.sides[k, side]
            for c in range(3):
                MG[k, side, c] = bodies.inverse_mass[i] * G[k, side, c]
                total = 0.0
                for m in range(3):
                    total += space.mobility[i, c, m] * G[k, side, 3 + m]
                MG[k, side, 3 + c] = total
    space.matrix[:] = 0.0
    for p in range(len(joints.pairs)):
        i, j, si, sj = joints.pairs[p, 0], joints.pairs[p, 1], joints.pairs[p, 2], joints.pairs[p, 3]
        total = 0.0
        for c in range(6):
            total += G[i, si, c] * MG[j, sj, c]
        space.matrix[i, i - j] += total
    for k in range(len(space.g)):
        if space.active[k] == 0:  # a pivot of zero: the row takes no part
            space.matrix[k, :] = 0.0
    factor_band(space.matrix, space.lower, space.pivot)


@uncounted
def place_ends(z, place0, R0, place1, R1):
    """Places and rotations at the end of the motion z (n, 6)."""
    for i in range(len(z) - 1):
        for c in range(3):
            place1[i, c] = place0[i, c] + z[i, c]
        cayley_turned(z, R0, R1, i)


@uncounted
def motion_of(bodies, joints, springs, motion, space, h, P, z, new):
    """Motion ``new`` (n, 6) by the forces and impulses P at the motion z; Jacobians and ends at z are in the space."""
    n = len(z) - 1
    force = space.force
    force[:] = 0.0
    for k in range(len(P)):
        for side in range(space.G.shape[1]):
            i = joints.sides[k, side]
            for c in range(6):
                force[i, c] += P[k] * space.G[k, side, c]
    add_forces(bodies, springs, motion.place, space.R0, space.place, space.R1, z, h, force)
    add_torsion(springs, joints.angles, motion.angle, space.angle, space.turn, h, force)
    add_given(space, h)
    for i in range(n):
        for c in range(3):
            new[i, c] = h * (motion.velocity[i, c] + 0.5 * bodies.inverse_mass[i] * force[i, c])
        turning(bodies, motion, space, h, z, i, force, new)


@uncounted
def turning(bodies, motion, space, h, z, i, force, new):
    """Rotation ``new[i, 3:]``: ``theta = h R0 (W0 + W1)/2`` with ``W1 = W0 + J^-1 R0^T (h tau - (R1 - R0) J W1)``."""
    R0, R1, own, inverse, s = space.R0, space.R1, bodies.inertia, bodies.inverse_inertia, motion.spin
    w0, w1, w2 = body_rate(R0, z, s, h, i)
    j0 = own[i, 0, 0] * w0 + own[i, 0, 1] * w1 + own[i, 0, 2] * w2
    j1 = own[i, 1, 0] * w0 + own[i, 1, 1] * w1 + own[i, 1, 2] * w2
    j2 = own[i, 2, 0] * w0 + own[i, 2, 1] * w1 + own[i, 2, 2] * w2
    d = R1[i, 0, 0] - R0[i, 0, 0], R1[i, 0, 1] - R0[i, 0, 1], R1[i, 0, 2] - R0[i, 0, 2]
    b0 = force[i, 3] - d[0] * j0 - d[1] * j1 - d[2] * j2
    d = R1[i, 1, 0] - R0[i, 1, 0], R1[i, 1, 1] - R0[i, 1, 1], R1[i, 1, 2] - R0[i, 1, 2]
    b1 = force[i, 4] - d[0] * j0 - d[1] * j1 - d[2] * j2
    d = R1[i, 2, 0] - R0[i, 2, 0], R1[i, 2, 1] - R0[i, 2, 1], R1[i, 2, 2] - R0[i, 2, 2]
    b2 = force[i, 5] - d[0] * j0 - d[1] * j1 - d[2] * j2
    a0, a1, a2 = turned_back(R0, i, b0, b1, b2)
    u0 = s[i, 0] + 0.5 * (inverse[i, 0, 0] * a0 + inverse[i, 0, 1] * a1 + inverse[i, 0, 2] * a2)
    u1 = s[i, 1] + 0.5 * (inverse[i, 1, 0] * a0 + inverse[i, 1, 1] * a1 + inverse[i, 1, 2] * a2)
    u2 = s[i, 2] + 0.5 * (inverse[i, 2, 0] * a0 + inverse[i, 2, 1] * a1 + inverse[i, 2, 2] * a2)
    for c in range(3):
        new[i, 3 + c] = h * (R0[i, c, 0] * u0 + R0[i, c, 1] * u1 + R0[i, c, 2] * u2)


@uncounted
def body_rate(R0, z, spin, h, i):
    """Angular velocity ``W1 = 2/h R0^T theta - W0`` at the end in the axes of the body, as three numbers."""
    x, y, w = turned_back(R0, i, 2.0 / h * z[i, 3], 2.0 / h * z[i, 4], 2.0 / h * z[i, 5])
    return x - spin[i, 0], y - spin[i, 1], w - spin[i, 2]


@uncounted_kernel
def guess_motion(bodies, joints, springs, motion, space, h):
    """Motion z at the start: that of the velocities and of the impulses of the slab before."""
    z = space.z
    set_targets(joints.drives, motion, space, h)
    z[:] = 0.0
    copy_rows(motion.place, space.place)
    copy_tensors(space.R0, space.R1)
    evaluate_angles(joints.angles, motion.angle, space.R0, space.R0, space.angle, space.turn)
    for i in range(len(z) - 1):
        for c in range(3):
            z[i, c] = h * motion.velocity[i, c]
            z[i, 3 + c] = h * (
                space.R0[i, c, 0] * motion.spin[i, 0]
                + space.R0[i, c, 1] * motion.spin[i, 1]
                + space.R0[i, c, 2] * motion.spin[i, 2]
            )
    motion_of(bodies, joints, springs, motion, space, h, motion.impulse, z, space.new)
    copy_rows(space.new, z)


@uncounted_kernel
def solve_motion(bodies, joints, springs, motion, space, h, extent):
    """Fixed point for the motion and the impulses with the factor of the start; number of iterations, 0 if it fails."""
    guess_motion(bodies, joints, springs, motion, space, h)
    z, new, P, before, slow = space.z, space.new, motion.impulse, np.inf, 0
    for iteration in range(1, ITERATIONS + 1):
        place_ends(z, motion.place, space.R0, space.place, space.R1)
        evaluate_rows(joints, motion, space, space.place, space.R1)
        copy_numbers(space.g, space.push)
        solve_band(space.lower, space.pivot, space.push)
        for k in range(len(P)):
            P[k] -= 2.0 / h * space.push[k]
        motion_of(bodies, joints, springs, motion, space, h, P, z, new)
        change = move_on(z, new, extent)
        if has_converged(change, before, missed_joints(space), extent):
            return iteration
        slow = slow + 1 if change > SLOW * before else 0
        if slow >= 2 or not np.isfinite(change):
            return 0
        before = change
    return 0


@uncounted
def move_on(z, new, extent):
    """Take the motion ``new`` (n, 6) as z; the greatest change, of places relative to the extent."""
    change = 0.0
    for i in range(len(z) - 1):
        for c in range(3):
            change = max(change, abs(new[i, c] - z[i, c]) / extent, abs(new[i, 3 + c] - z[i, 3 + c]))
            z[i, c], z[i, 3 + c] = new[i, c], new[i, 3 + c]
    return change


@uncounted
def missed_joints(space):
    """Greatest value of the joints."""
    worst = 0.0
    for k in range(len(space.g)):
        if space.active[k] != 0:
            worst = max(worst, abs(space.g[k]))
    return worst


@uncounted
def has_converged(change, before, missed, extent):
    """True if a motion has changed by rounding only, or improves no more, and the joints are closed."""
    still = change <= CONVERGED and missed <= CLOSED * max(1.0, extent)
    return still or (change <= NEARLY and change > 0.5 * before)


@uncounted_kernel
def end_slab(bodies, joints, springs, motion, space, h, told):
    """Take the motion z: new state with the velocities of the joints, and the energy that each group has to have.

    ``told`` (3,) takes the greatest joint value and joint velocity, and the greatest change of the scalars from 1.
    """
    take_motion(bodies, joints, springs, motion, space, h)
    told[2] = max(told[2], close_energy(bodies, springs, joints, motion, space))
    tell_joints(joints, motion, space, told)


@uncounted_kernel
def take_motion(bodies, joints, springs, motion, space, h):
    """Take the motion z: new state with the velocities of the joints, whose energy is a little too low."""
    n, z = len(motion.place) - 1, space.z
    place_ends(z, motion.place, space.R0, space.place, space.R1)
    evaluate_angles(joints.angles, motion.angle, space.R0, space.R1, space.angle, space.turn)
    work_of_slab(bodies, springs, joints.angles, motion, space, h)
    copy_numbers(space.angle, motion.angle)
    pass_time(motion, h)
    set_rates(joints.drives, motion, space)
    for i in range(n):
        motion.spin[i, 0], motion.spin[i, 1], motion.spin[i, 2] = body_rate(space.R0, z, motion.spin, h, i)
        for c in range(3):
            motion.velocity[i, c] = 2.0 / h * z[i, c] - motion.velocity[i, c]
            motion.place[i, c] = space.place[i, c]
        quaternion_turned(z, motion.turn, i)
        matrix_of(motion.turn, space.R0, i)
    prepare_joints(bodies, joints, motion, space)
    project_velocities(bodies, joints, motion, space)
    work_of_drives(bodies, joints, motion, space, h)


@uncounted_kernel
def tell_joints(joints, motion, space, told):
    """Greatest value and velocity of the joints, in ``told``."""
    for k in range(len(space.g)):
        if space.active[k] != 0:
            told[0] = max(told[0], abs(space.g[k]))
            told[1] = max(told[1], abs(joint_velocity(joints, motion, space, k)))


@uncounted_kernel
def march_slabs(bodies, joints, springs, motion, space, h, count, extent, told):
    """March up to ``count`` slabs from a prepared state; the number that was solved, and the iterations they took."""
    iterations = 0
    for slab in range(count):
        copy_numbers(motion.impulse, space.kept)
        found = solve_motion(bodies, joints, springs, motion, space, h, extent)
        if found == 0:
            copy_numbers(space.kept, motion.impulse)
            return slab, iterations
        iterations += found
        end_slab(bodies, joints, springs, motion, space, h, told)
    return count, iterations


@uncounted_kernel
def begin(bodies, joints, springs, motion, space):
    """Prepare the factor of the joints at a state, and the energies of the groups."""
    set_rates(joints.drives, motion, space)
    for i in range(len(motion.place) - 1):
        matrix_of(motion.turn, space.R0, i)
    prepare_joints(bodies, joints, motion, space)
    motion.energy[:] = 0.0
    kinetic_energy(bodies, motion, motion.energy)
    potential_energy(bodies, springs, joints.angles, motion, space.R0, motion.energy)
