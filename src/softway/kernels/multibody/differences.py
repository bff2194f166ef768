"""Derivatives of the equations of a slab (time step) of rigid bodies by central differences, for Newton's method."""

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.multibody.angles import evaluate_angles
from softway.kernels.multibody.rotations import cayley_turned
from softway.kernels.multibody.slab import evaluate_row, evaluate_rows, motion_of, place_ends, turning

STEP = 1e-6
"""Difference of a rotation, or of a place relative to the extent of the mechanism."""


@uncounted_kernel
def linearised(bodies, joints, springs, motion, space, h, P, extent, missed, slopes, pushes):
    """Equations of the slab at the motion ``space.z`` (n, 6) and the impulses P (r,), and their derivatives.

    ``missed`` (6 n + r,) takes the motion minus that by the forces, and the joint values; ``slopes`` (6 n + r, 6 n) the
    derivatives with respect to the motion, without springs; ``pushes`` (6 n, r) those of the motion by the impulses.
    """
    n, z = len(space.z) - 1, space.z
    place_ends(z, motion.place, space.R0, space.place, space.R1)
    evaluate_rows(joints, motion, space, space.place, space.R1)
    motion_of(bodies, joints, springs, motion, space, h, P, z, space.new)
    slopes[:], pushes[:] = 0.0, 0.0
    for i in range(n):
        for c in range(6):
            missed[6 * i + c] = z[i, c] - space.new[i, c]
            slopes[6 * i + c, 6 * i + c] = 1.0
    for row in range(len(P)):
        missed[6 * n + row] = space.g[row]
        _add_motion(bodies, joints, space, row, 0.5 * h, pushes, row)
    for j in range(n):
        for k in range(6):
            column, kept, size = 6 * j + k, z[j, k], STEP * (extent if k < 3 else 1.0)
            for sign in (1.0, -1.0):
                z[j, k] = kept + sign * size
                _place_end(joints, motion, space, j)
                weight = sign / (2.0 * size)
                turning(bodies, motion, space, h, z, j, space.force, space.new)
                for c in range(3):
                    slopes[6 * j + 3 + c, column] -= weight * space.new[j, 3 + c]
                for row in range(len(P)):
                    if _has(joints, row, j):
                        evaluate_row(joints, motion, space, space.place, space.R1, row)
                        slopes[6 * n + row, column] += weight * space.g[row]
                        _add_motion(bodies, joints, space, row, -0.5 * h * P[row] * weight, slopes, column)
            z[j, k] = kept
            _place_end(joints, motion, space, j)


@uncounted_kernel
def _place_end(joints, motion, space, j):
    """Place and rotation of body j at the end of its motion, and the angles there."""
    for c in range(3):
        space.place[j, c] = motion.place[j, c] + space.z[j, c]
    cayley_turned(space.z, space.R0, space.R1, j)
    evaluate_angles(joints.angles, motion.angle, space.R0, space.R1, space.angle, space.turn)


@uncounted
def _has(joints, row, j):
    """True if the row is one of body j."""
    found = False
    for side in range(joints.sides.shape[1]):
        found |= joints.sides[row, side] == j
    return found


@uncounted_kernel
def _add_motion(bodies, joints, space, row, weight, out, column):
    """Add ``weight M^-1 G^T`` of a row to a column."""
    for side in range(space.G.shape[1]):
        i = joints.sides[row, side]
        if i == len(space.z) - 1:
            continue
        for c in range(3):
            out[6 * i + c, column] += weight * bodies.inverse_mass[i] * space.G[row, side, c]
            for m in range(3):
                out[6 * i + 3 + c, column] += weight * space.mobility[i, c, m] * space.G[row, side, 3 + m]
