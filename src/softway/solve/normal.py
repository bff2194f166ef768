"""Normal contact on the frozen operator: a dual active set on the compliance of the contact rows.

Given the free solution ``y`` of A y = b, find multipliers P such that ``z = y + A^-1 G^T P`` satisfies

    G z = c  on closed rows,     G z >= c,  P >= 0,  P (G z - c) = 0  on unilateral rows.

The closed degrees of freedom are thereby eliminated through their Schur complement, and the factor of A serves
every contact status.
"""

from dataclasses import dataclass

import numpy as np

from softway.errors import NoConvergence
from softway.kernels.dense import Shared, factored
from softway.solve.along import Along, Mixed
from softway.solve.frozen import Frozen
from softway.solve.return_map import Slipping
from softway.typing import Array, BoolArray, IntArray

BATCH = 16
"""Rows next to touch whose columns are made along with a new one: a column of a batch costs a third of a lone one."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rows:
    """Conditions of one slab on the contact rows: ``target`` (m,), which are ``equal`` or ``unilateral`` (m,), and on
    their ``slipping`` where there is friction.

    A row without multiplier that misses its target by no more than ``rounding`` keeps it: that is what the last digits
    of positions make of a gap.  Without it rows that depend on each other (flush blocks) would go in and out by turns.
    """

    target: Array
    equal: BoolArray
    unilateral: BoolArray
    slipping: Slipping | None = None
    rounding: float = 0.0

    def part(self, which: IntArray) -> "Rows":
        """The conditions on some of the rows, where there is no friction."""
        equal, unilateral = self.equal[which], self.unilateral[which]
        return Rows(target=self.target[which], equal=equal, unilateral=unilateral, rounding=self.rounding)

    def missable(self, slack: Array) -> float:
        """What rows may miss their targets by, for values (m,) that differ from the targets by ``slack``."""
        target = np.where(self.equal | self.unilateral, self.target, 0.0)
        return max(1e-14 * max(greatest(slack), greatest(target), 1e-300), self.rounding)


def greatest(values: Array) -> float:
    """Greatest magnitude of values of any shape, without a copy of them; zero if there are none.

    Examples
    --------
    >>> greatest(np.array([[0.5, -2.0]])), greatest(np.zeros(0))
    (2.0, 0.0)
    """
    return max(float(values.max(initial=0.0)), -float(values.min(initial=0.0)))


def rounded(x: Array) -> float:
    """Rounding of differences of positions x (n, d): a few units in the last place of the greatest.

    Examples
    --------
    >>> rounded(np.array([[0.5, -1.0]])) == 2.0**-50
    True
    """
    return 4.0 * float(np.finfo(float).eps) * greatest(x)


def constrain(
    free: Array,
    frozen: Frozen,
    coefficients: Along,
    rows: Rows,
    guess: BoolArray,
    carried: Array | None = None,
) -> tuple[Array, Array, BoolArray]:
    """Solution (f,), multipliers (m,) and active rows (m,) of the contact problem for the free solution.

    The contact rows are ``G = C B^T`` with their ``coefficients`` C along the contact directions B.  Multipliers
    ``carried`` (m,) are in ``free`` already; what comes out are the whole ones.  Their changes are what is solved for:
    where they are settled, the digits that cancel between the free solution and what the whole multipliers move (a
    body that only contact holds) are not lost.

    Primal-dual sweeps from the ``guess``; after 30 of them single exchanges of least index (Murty), which end for
    every symmetric positive definite compliance.
    """
    count = rows.equal | rows.unilateral
    active = rows.equal | (guess & rows.unilateral)
    carried = np.zeros(len(count)) if carried is None else carried
    loaded = np.where(count, coefficients.along(frozen.sense(free)) - rows.target, 0.0)
    slack = loaded - np.where(count, coefficients.along(frozen.give(coefficients.spread(carried))), 0.0)
    floor = rows.missable(slack)
    for sweep in range(30 + 4 * len(active)):
        index = np.flatnonzero(active)
        _expect(frozen, coefficients, index, np.where(rows.unilateral, slack, np.inf))
        lifted = coefficients.spread(np.where(active, 0.0, carried))
        now = loaded - np.where(count, coefficients.along(frozen.give(lifted)), 0.0)
        change, push = balance(frozen, coefficients.part(index), -now[index])
        gap = now + coefficients.along(push.sensed)
        multiplier = np.zeros(len(active))
        multiplier[index] = carried[index] + change
        wrong = rows.unilateral & ((active & (multiplier < 0.0)) | (~active & (gap < -floor)))
        if not wrong.any():
            break
        other = np.flatnonzero(wrong)[:1] if sweep >= 30 else np.flatnonzero(wrong)
        active = active.copy()
        active[other] = ~active[other]
    else:
        raise NoConvergence(f"the {len(active)} contact rows have no solution")
    return free + frozen.answer(push.directions - lifted), multiplier, active


def _expect(frozen: Frozen, coefficients: Along, index: IntArray, slack: Array) -> None:
    """Make the columns of the active rows (k,), and if any is new those of the rows next to touch along with them."""
    if not len(frozen.table.missing(coefficients.part(index).used)):
        return
    soon = np.argsort(slack, kind="stable")[: len(index) + BATCH]
    frozen.fill(np.union1d(coefficients.part(index).used, coefficients.part(soon[slack[soon] < np.inf]).used))


def untouched(free: Array, frozen: Frozen, before: Array) -> Array:
    """What a solution (f,) that has pushes ``before`` (b,) in it would be without them, along the directions (b,)."""
    return frozen.sense(free) - frozen.give(before)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Push:
    """Forces along the contact ``directions`` (b,), and what they move along them, ``sensed`` (b,)."""

    directions: Array
    sensed: Array


def delassus(frozen: Frozen, active: Along) -> Array:
    """Compliance ``G A^-1 G^T`` (k, k) of some rows."""
    used = active.used
    return active.folded(frozen.compliance(used)[used])


def _held(frozen: Frozen, active: Along) -> Shared:
    """The factored compliance of the active rows (k,), unscaled; the same for all slabs where directions are rows."""
    plain = frozen.scaled(1.0)
    if isinstance(active, Mixed):
        return factored(delassus(plain, active))
    key = active.index.tobytes()
    if key not in frozen.held:
        frozen.held.clear()
        frozen.held[key] = factored(delassus(plain, active))
    return frozen.held[key]


def balance(frozen: Frozen, active: Along, wanted: Array) -> tuple[Array, Push]:
    """Multipliers (k,) of the active rows that move them by ``wanted`` (k,), and the push that they make."""
    force = _held(frozen, active).solve(wanted / frozen.scale)
    directions = active.spread(force)
    return force, Push(directions=directions, sensed=frozen.give(directions))
