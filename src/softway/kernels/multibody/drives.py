"""Prescribed motions of rows as functions of time, and the work of the motors that keep to them."""

import numpy as np

from softway.kernels.jit.compilation import uncounted

LATE = 1e-12
"""Time before a knot, relative to the time, that is rounding."""


@uncounted
def drive_at(drives, m, time):
    """Value of a prescribed motion at a time, and its rate; at a knot the rate after it."""
    low, high = drives.first[m], drives.first[m + 1]
    while high - low > 1:
        middle = (low + high) // 2
        if drives.pieces[middle, 0] <= time + LATE * abs(time):
            low = middle
        else:
            high = middle
    piece = drives.pieces[low]
    since, value, rate = time - piece[0], 0.0, 0.0
    for power in range(6, 0, -1):
        rate = rate * since + value
        value = value * since + piece[power]
    size, often, phase = piece[7], piece[8], piece[9]
    value += size * (np.sin(often * since + phase) - np.sin(phase))
    return value, rate + size * often * np.cos(often * since + phase)


@uncounted
def set_targets(drives, motion, space, h):
    """Prescribed values at the end of a slab from the present state."""
    for m in range(len(drives.row)):
        before, rate = drive_at(drives, m, motion.time[0])
        value = drive_at(drives, m, motion.time[0] + h)[0]
        space.target[drives.row[m]] = value
        space.drive[m, 0], space.drive[m, 1] = value - before, rate


@uncounted
def set_rates(drives, motion, space):
    """Prescribed rates at the present state."""
    for m in range(len(drives.row)):
        space.rate[drives.row[m]] = drive_at(drives, m, motion.time[0])[1]


@uncounted
def pass_time(motion, h):
    """Add to the time, and keep the rounding error of the sum."""
    added = h - motion.time[1]
    total = motion.time[0] + added
    motion.time[1] = (total - motion.time[0]) - added
    motion.time[0] = total


@uncounted
def work_of_drives(bodies, joints, motion, space, h):
    """Add the work of the motors: in the slab, and at the time node at its end with the mean of the rates there.

    The rate before the node is that of the motion that is linear in the rates, as the velocities of the bodies are.
    Groups whose drives move are ``driven`` in the space.
    """
    space.driven[:] = 0
    for m in range(len(joints.drives.row)):
        k = joints.drives.row[m]
        i = joints.a[k] if joints.a[k] < len(motion.place) - 1 else joints.b[k]
        change, before = space.drive[m, 0], 2.0 / h * space.drive[m, 0] - space.drive[m, 1]
        done = motion.impulse[k] * change / h + 0.5 * space.jump[k] * (before + space.rate[k])
        motion.energy[bodies.group[i]] += done
        motion.work[0] += done
        if change != 0.0 or space.rate[k] != 0.0:
            space.driven[bodies.group[i]] = 1
        space.drive[m, 2] = (motion.impulse[k] + space.jump[k]) / h


@uncounted
def work_of_jumps(bodies, joints, motion, space):
    """Add the work of the motors in a collision, through which their rates do not change."""
    for m in range(len(joints.drives.row)):
        k = joints.drives.row[m]
        i = joints.a[k] if joints.a[k] < len(motion.place) - 1 else joints.b[k]
        done = space.jump[k] * space.rate[k]
        motion.energy[bodies.group[i]] += done
        motion.work[0] += done
