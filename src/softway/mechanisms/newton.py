"""Slabs (time steps) of a mechanism, by Newton's method near singular positions, where the frozen factor diverges."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.arrays import Array
from softway.errors import NumericsError
from softway.kernels.multibody.differences import linearised
from softway.kernels.multibody.slab import end_slab, guess_motion, march_slabs
from softway.kernels.multibody.tables import Space
from softway.mechanisms.arrays import Arrays

HALVINGS = 12
"""Halvings of a slab that cannot be solved."""
ITERATIONS = 15
"""Greatest number of iterations."""
CONVERGED, NEARLY = 1e-15, 1e-11
"""Change of the motion, relative to the extent, at the level of rounding; and one that may stay."""


def march_on(it: Arrays, room: Space, time: float, h: float, count: int, told: Array) -> int:
    """March a number of slabs without stops from a time; their iterations.

    Raises
    ------
    NumericsError
        If a slab has no solution at any length.
    """
    done = iterations = 0
    while done < count:
        tables = it.bodies, it.joints, it.springs, it.motion, room
        solved, used = march_slabs(*tables, h, count - done, it.reach(h), told)
        done, iterations = done + solved, iterations + used
        if done < count:
            iterations += hard_slab(it, room, time + done * h, h, told)
            done += 1
    return iterations


def hard_slab(it: Arrays, room: Space, time: float, h: float, told: Array, halvings: int = 0) -> int:
    """Solve a slab in which the fixed point fails by Newton's method, or else in two halves, and so on.

    Raises
    ------
    NumericsError
        If it has no solution.
    """
    found = newton_motion(it, room, h, it.reach(h))
    if found:
        end_slab(it.bodies, it.joints, it.springs, it.motion, room, h, told)
        return found
    if halvings == HALVINGS:
        worst = it.joint_of[int(np.argmax(np.abs(room.g)))] if it.joint_of else ""
        what = f"a slab of {h:.3g} s has no solution" + (
            f"; the joint {worst!r} is farthest from closed" if worst else ""
        )
        raise NumericsError(what, time, "a shorter step, or a mechanism that can move on from there")
    iterations = 0
    for k in range(2):
        one, used = march_slabs(it.bodies, it.joints, it.springs, it.motion, room, 0.5 * h, 1, it.reach(h), told)
        iterations += used if one else hard_slab(it, room, time + 0.5 * k * h, 0.5 * h, told, halvings + 1)
    return iterations


def newton_motion(it: Arrays, room: Space, h: float, extent: float) -> int:
    """Motion and impulses of a slab, in ``room.z`` and in the impulses; number of iterations, 0 if it fails.

    Rows that depend on others at the start take no part.
    """
    n, r = len(it.names), len(it.joint_of)
    rows = np.flatnonzero(room.pivot > 0.0)
    equations = np.concatenate([np.arange(6 * n), 6 * n + rows])
    impulse, last = it.motion.impulse.copy(), np.inf
    missed, slopes, pushes = np.zeros(6 * n + r), np.zeros((6 * n + r, 6 * n)), np.zeros((6 * n, r))
    guess_motion(it.bodies, it.joints, it.springs, it.motion, room, h)
    scale = np.tile([extent] * 3 + [1.0] * 3, n)
    for iteration in range(1, ITERATIONS + 1):
        linearised(it.bodies, it.joints, it.springs, it.motion, room, h, impulse, extent, missed, slopes, pushes)
        step = _step(slopes[equations], pushes[:, rows], missed[equations])
        if step is None:
            return 0
        room.z[:-1] -= step[: 6 * n].reshape(n, 6)
        impulse[rows] -= step[6 * n :]
        change = float(np.abs(step[: 6 * n] / scale).max())
        if change <= CONVERGED or (change <= NEARLY and change > 0.5 * last):
            it.motion.impulse[:] = impulse
            return iteration
        last = change
    return 0


def _step(slopes: Array, pushes: Array, missed: Array) -> Array | None:
    """Newton's step of motion and impulses; None if there is none."""
    rows = pushes.shape[1]
    right = np.concatenate([-pushes, np.zeros((rows, rows))])
    try:
        step = splu(sp.csc_array(np.concatenate([slopes, right], axis=1))).solve(missed)
    except RuntimeError:  # the matrix is singular
        return None
    return np.asarray(step) if np.isfinite(step).all() else None
