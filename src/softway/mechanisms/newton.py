"""Newton's method for a slab (time step) of a mechanism near a singular position, where the frozen factor diverges."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.arrays import Array
from softway.kernels.multibody.differences import linearised
from softway.kernels.multibody.slab import guess_motion
from softway.kernels.multibody.tables import Space
from softway.mechanisms.arrays import Arrays

ITERATIONS = 15
"""Greatest number of iterations."""
CONVERGED, NEARLY = 1e-15, 1e-11
"""Change of the motion, relative to the extent, at the level of rounding; and one that may stay."""


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
