"""Slabs (time steps) of a mechanism, by Newton's method near singular positions, where the frozen factor diverges."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.arrays import Array, IntArray
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
    pattern = _pattern(it.joints.sides, rows, n)
    equations = np.concatenate([np.arange(6 * n), 6 * n + rows])
    impulse, last = it.motion.impulse.copy(), np.inf
    missed, slopes, pushes = np.zeros(6 * n + r), np.zeros((6 * n + r, 6 * n)), np.zeros((6 * n, r))
    guess_motion(it.bodies, it.joints, it.springs, it.motion, room, h)
    scale = np.tile([extent] * 3 + [1.0] * 3, n)
    for iteration in range(1, ITERATIONS + 1):
        linearised(it.bodies, it.joints, it.springs, it.motion, room, h, impulse, extent, missed, slopes, pushes)
        step = _step(pattern, slopes, pushes, missed[equations])
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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Pattern:
    """Places of the nonzero entries of Newton's matrix, column by column.

    Parameters
    ----------
    indices, starts
        Rows of the entries, and where each column starts.
    slopes, pushes
        Rows and columns (2, k) of the entries in the tables of the derivatives: those by the motion come first.
    """

    indices: IntArray
    starts: IntArray
    slopes: IntArray
    pushes: IntArray


def _pattern(sides: IntArray, rows: IntArray, n: int) -> _Pattern:
    """Entries of bodies that rows connect, and of the ``rows`` (k,) that take part."""
    six, (r, s) = np.arange(6), sides.shape
    two = [sides[:, [p, q]] for p in range(s) for q in range(s)]
    pairs = np.concatenate([np.repeat(np.arange(n), 2).reshape(-1, 2), *two])
    pairs = np.unique(pairs[(pairs < n).all(axis=1)], axis=0)
    own = np.unique(np.stack([np.repeat(np.arange(r), s), sides.ravel()], axis=1), axis=0)
    own = own[(own[:, 1] < n) & np.isin(own[:, 0], rows)]
    motion, number = (6 * own[:, 1, None] + six).ravel(), np.repeat(np.searchsorted(rows, own[:, 0]), 6)
    one = np.concatenate([np.repeat(6 * pairs[:, 0, None] + six, 6, axis=1).ravel(), 6 * n + number])
    other = np.concatenate([np.tile(6 * pairs[:, 1, None] + six, 6).ravel(), motion])
    order = np.lexsort((one, other))
    one, other = one[order], other[order]
    order = np.lexsort((motion, number))
    motion, number = motion[order], number[order]
    counts = np.bincount(np.concatenate([other, 6 * n + number]), minlength=6 * n + len(rows))
    taken = np.concatenate([np.arange(6 * n), 6 * n + rows])
    return _Pattern(
        indices=np.concatenate([one, motion]),
        starts=np.concatenate([[0], np.cumsum(counts)]),
        slopes=np.stack([taken[one], other]),
        pushes=np.stack([motion, rows[number]]),
    )


def _step(pattern: _Pattern, slopes: Array, pushes: Array, missed: Array) -> Array | None:
    """Newton's step of motion and impulses; None if there is none."""
    values = np.concatenate([slopes[tuple(pattern.slopes)], -pushes[tuple(pattern.pushes)]])
    try:
        step = splu(sp.csc_array((values, pattern.indices, pattern.starts), shape=(len(missed),) * 2)).solve(missed)
    except RuntimeError:  # the matrix is singular
        return None
    return np.asarray(step) if np.isfinite(step).all() else None
