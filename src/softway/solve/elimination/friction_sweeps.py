"""Contact with friction by elimination: rows that stick do not move, rows that slip push with the force of the law.

Normals of touching rows and tangents of sticking ones are closed rows.  The forces of slipping rows are those of the
iterate before; the step gives the slip, and the return map of the trial ``s - slip/c`` the next force, with c a
part of the compliance of a row against the nodal blocks alone.  A solution is independent of c.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.constraints.return_map import SlipConditions, return_map
from softway.solve.constraints.turning_slip import chord_force, end_force
from softway.solve.effort import Effort
from softway.solve.elimination.contact_sweeps import SWEEPS, Answer, Elimination, Equations, Swept

FIRMER = 0.5
"""Part of the compliance c in the trial forces: the solution does not depend on it, and the iterations least here."""


@dataclass(frozen=True, slots=True, eq=False)
class Friction:
    """Status of the rows: they ``touch`` (m,) and ``slip`` (m,), with forces of slip ``push`` (m, k)."""

    touch: BoolArray
    slip: BoolArray
    push: Array

    def same(self, other: "Friction") -> bool:
        """True if the same rows touch and slip."""
        return bool((self.touch == other.touch).all() and (self.slip == other.slip).all())

    @property
    def closed(self) -> BoolArray:
        """Closed rows (m (1 + k),): normals of touching rows, and tangents of those that stick."""
        return np.concatenate([self.touch, np.repeat(self.touch & ~self.slip, self.push.shape[1])])

    @property
    def forces(self) -> Array:
        """Forces (m (1 + k),) of slip."""
        return np.concatenate([np.zeros(len(self.touch)), np.where(self.slip[:, None], self.push, 0.0).ravel()])


def served(law: SlipConditions, pressed: Array) -> bool:
    """True for friction that does not drop with the slip at the multipliers (m,), on rows that only touch or not."""
    return law.given is None and law.undriven is None and not law.drops(np.maximum(pressed, 0.0))


def friction_sweeps(
    elimination: Elimination,
    equations: Equations,
    rows: RowConditions,
    guess: tuple[BoolArray, Array],
    effort: Effort,
) -> Swept:
    """Step with contact and friction, from the active and slipping rows (2 m,) and multipliers (m (1 + k),) before.

    Rows touch or lift, stick or slip, at most ``SWEEPS`` times.
    """
    m, k = rows.slipping.shift.shape
    moved = np.diff(equations.matrix.indptr) > 0
    offset = np.concatenate([rows.target, rows.slipping.shift.ravel()])
    slack = np.where(moved, equations.matrix @ equations.y - offset, 0.0)
    law = _Law(
        rows, moved[:m] & (rows.unilateral | rows.equal), rows.missable(slack[:m]), _soft(elimination, equations, m)
    )
    status = law.first(*guess)
    answer: Answer | None = None
    for sweep in range(SWEEPS):
        index = np.flatnonzero(status.closed & moved)
        effort.step(f"friction of {m} rows, {np.count_nonzero(status.touch)} touch, exchange {sweep}")
        pushed = replace(equations, residual=equations.residual - equations.matrix.T @ status.forces)
        answer = elimination.solve(pushed, index, offset[index], answer)
        multiplier = status.forces
        multiplier[index] = answer.multiplier
        motion = slack + equations.matrix @ answer.d
        now, status = status, law.next(status, multiplier, motion)
        if now.same(status):
            break
    assert answer is not None
    both = now.slip & status.slip
    missed = float((law.soft[:, None] * np.abs(status.push - now.push))[both].max(initial=0.0))
    tangential = np.where(both[:, None], status.push, multiplier[m:].reshape(m, k))
    active = np.concatenate([status.touch, status.slip])
    found = np.concatenate([np.where(rows.equal, multiplier[:m], np.maximum(multiplier[:m], 0.0)), tangential.ravel()])
    return Swept(answer.d, found, active, now.same(status), missed)


def _soft(elimination: Elimination, equations: Equations, m: int) -> Array:
    """Compliance (m,) of the rows along their surface, against the nodal blocks alone."""
    tangents = equations.matrix[m:]
    felt = FIRMER * tangents.multiply(elimination.local.solve(sp.csc_array(tangents.T)).T)
    soft = np.asarray(felt.sum(axis=1)).reshape(m, -1).mean(axis=1)
    return np.maximum(soft, 1e-12 * max(float(soft.max(initial=0.0)), 1e-300))


@dataclass(frozen=True, slots=True, eq=False)
class _Law:
    """Conditions of the ``rows``, those that may touch (``normal``, (m,)), the admissible overlap ``floor``, and the
    compliance ``soft`` (m,) along the surface.
    """

    rows: RowConditions
    normal: BoolArray
    floor: float
    soft: Array

    def first(self, active: BoolArray, multiplier: Array) -> Friction:
        """Status from active and slipping rows (2 m,) or active rows (m,), and multipliers (m (1 + k),)."""
        m, k = self.rows.slipping.shift.shape
        touch = (self.rows.equal | active[:m]) & self.normal
        slip = touch & (active[m:] if len(active) == 2 * m else self.rows.slipping.sliding)
        return Friction(touch, slip, multiplier[m:].reshape(m, k))

    def next(self, status: Friction, multiplier: Array, motion: Array) -> Friction:
        """Status after a step with multipliers and ``motion`` beyond the targets (m (1 + k),).

        Rows that start to touch slip without force, until the next step tells how hard they press.
        """
        m, law = len(status.touch), self.rows.slipping
        p, gap = multiplier[:m], motion[:m]
        touch = np.where(status.touch, self.rows.equal | (p >= 0.0), gap < -self.floor) & self.normal
        s, slip = (v[m:].reshape(law.shift.shape) for v in (multiplier, motion))
        trial = chord_force(law.turning, s) - np.where(status.slip[:, None], slip, 0.0) / self.soft[:, None]
        size = np.linalg.norm(trial, axis=1)
        found = return_map(law, size, np.where(self.rows.equal, p, np.maximum(p, 0.0)), 1.0 / self.soft)
        force = end_force(law.turning, trial * (found.force / np.maximum(size, 1e-300))[:, None])
        fresh = touch & ~status.touch
        return Friction(touch, touch & (found.slips | fresh), np.where((touch & ~fresh)[:, None], force, 0.0))
