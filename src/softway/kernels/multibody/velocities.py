"""Velocities of the rows of joints, and impulses that change them."""

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.band import solve_band


@uncounted
def joint_velocity(joints, motion, space, k):
    """Velocity of a joint row, ``G v``, minus the prescribed rate."""
    total = -space.rate[k]
    for side in range(space.G.shape[1]):
        i = joints.sides[k, side]
        for c in range(3):
            spin = (
                space.R0[i, c, 0] * motion.spin[i, 0]
                + space.R0[i, c, 1] * motion.spin[i, 1]
                + space.R0[i, c, 2] * motion.spin[i, 2]
            )
            total += space.G[k, side, c] * motion.velocity[i, c] + space.G[k, side, 3 + c] * spin
    return total


@uncounted_kernel
def project_velocities(bodies, joints, motion, space):
    """Nearest velocities in the norm of the mass that satisfy the joints: ``v - M^-1 G^T (G M^-1 G^T)^+ G v``."""
    space.jump[:] = 0.0
    for _ in range(2):
        for k in range(len(space.g)):
            space.push[k] = -joint_velocity(joints, motion, space, k)
        push_rows(joints, motion, space, space.push)
        for k in range(len(space.g)):
            space.jump[k] += space.push[k]


@uncounted_kernel
def push_rows(joints, motion, space, wanted):
    """Change the velocities of the active rows by ``wanted`` (r,); afterwards ``wanted`` has the impulses."""
    solve_band(space.lower, space.pivot, wanted)
    for k in range(len(wanted)):
        push_row(joints, motion, space, k, wanted[k])


@uncounted
def push_row(joints, motion, space, k, impulse):
    """Change the velocities of the bodies by an impulse of a row."""
    for side in range(space.G.shape[1]):
        i = joints.sides[k, side]
        for c in range(3):
            motion.velocity[i, c] += impulse * space.MG[k, side, c]
            motion.spin[i, c] += impulse * (
                space.R0[i, 0, c] * space.MG[k, side, 3]
                + space.R0[i, 1, c] * space.MG[k, side, 4]
                + space.R0[i, 2, c] * space.MG[k, side, 5]
            )
