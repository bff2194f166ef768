"""Normal contact on the frozen operator: a dual active set on the compliance of the contact rows.

Given the free solution ``y`` of A y = b, find multipliers P such that ``z = y + A^-1 G^T P`` satisfies

    G z = c  on closed rows,     G z >= c,  P >= 0,  P (G z - c) = 0  on unilateral rows.

The Schur complement eliminates the active rows, and one factor of A serves every active set.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray, greatest
from softway.errors import NoConvergence
from softway.kernels.linalg.active_set import exchanged, most_sweeps, one_by_one
from softway.kernels.linalg.dense import DenseFactor, factored
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.recent_factor import FEW
from softway.solve.constraints.return_map import NO_SLIP, SlipConditions
from softway.solve.constraints.row_basis import CombinedRows, RowCoefficients
from softway.solve.effort import Effort

BATCH = 16
"""Rows close to contact whose columns are computed along with a new one: in a batch they cost a third."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RowConditions:
    """Conditions of one slab on the contact rows: ``target`` (m,), ``equal`` and ``unilateral`` rows (m,), and slip
    conditions ``slipping``.

    A row without multiplier may miss its target by ``rounding``, the rounding error of gaps.  Otherwise rows that
    depend on each other (flush blocks) would alternate between the active and the inactive set.
    """

    target: Array
    equal: BoolArray
    unilateral: BoolArray
    slipping: SlipConditions = NO_SLIP
    rounding: float = 0.0

    def subset(self, which: IntArray) -> "RowConditions":
        """Conditions on a subset of the rows, without friction."""
        equal, unilateral = self.equal[which], self.unilateral[which]
        return RowConditions(target=self.target[which], equal=equal, unilateral=unilateral, rounding=self.rounding)

    def missable(self, slack: Array) -> float:
        """Admissible violation of the targets by rounding; ``slack`` (m,) are the present differences from them."""
        target = np.where(self.equal | self.unilateral, self.target, 0.0)
        return max(1e-14 * max(greatest(slack), greatest(target), 1e-300), self.rounding)


REDUNDANT = 10
"""Number of sweeps after which rows are taken for redundant and added one by one."""


def rounded(extent: float) -> float:
    """Rounding error of differences of positions: a few units in the last place of the greatest coordinate ``extent``.

    Examples
    --------
    >>> rounded(1.0) == 2.0**-50
    True
    """
    return 4.0 * float(np.finfo(float).eps) * extent


def solve_normal_contact(
    free: Array,
    frozen: FrozenOperator,
    coefficients: RowCoefficients,
    rows: RowConditions,
    guess: BoolArray,
    previous: Array | None = None,
    effort: Effort | None = None,
) -> tuple[Array, Array, BoolArray]:
    """Solve the contact problem: solution (f,), multipliers (m,) and active rows (m,).

    The contact rows are ``G = C B^T`` with their ``coefficients`` C along the contact directions B.  The free solution
    contains the ``previous`` multipliers (m,) already; the returned multipliers are total values.  The unknowns are
    their changes: for converged multipliers no digits cancel between the free solution and the effect of the total
    multipliers, as they would for a body supported by contact only.

    Primal-dual active set iteration from the ``guess``; after 30 sweeps single exchanges of least index (Murty), which
    terminate for every symmetric positive definite compliance.
    """
    count = rows.equal | rows.unilateral
    active = rows.equal | (guess & rows.unilateral)
    previous = np.zeros(len(count)) if previous is None else previous
    loaded = np.where(count, coefficients.from_basis(frozen.restrict(free)) - rows.target, 0.0)
    slack = loaded - _caused(frozen, coefficients, count, coefficients.spread(previous))
    floor, effort = rows.missable(slack), effort or Effort()
    for sweep in range(most_sweeps(len(active))):
        index = np.flatnonzero(active)
        effort.step(f"contact of {len(active)} rows, {len(index)} active, exchange {sweep}")
        _expect(frozen, coefficients, index, np.where(rows.unilateral, slack, np.inf))
        lifted = coefficients.spread(np.where(active, 0.0, previous))
        now = loaded - _caused(frozen, coefficients, count, lifted)
        change, push = multipliers(frozen, coefficients.subset(index), -now[index])
        gap = now + coefficients.from_basis(push.sensed)
        multiplier = np.zeros(len(active))
        multiplier[index] = previous[index] + change
        wrong = rows.unilateral & ((active & (multiplier < 0.0)) | (~active & (gap < -floor)))
        if not wrong.any():
            break
        if sweep == REDUNDANT and not rows.equal.any():
            multiplier = _without_cycles(frozen, coefficients, rows.unilateral, slack, previous, floor, effort)
            pushed = frozen.solve_push(coefficients.spread(multiplier - previous))
            return free + pushed, multiplier, multiplier > 0.0
        active = exchanged(active, wrong, sweep)
    else:
        raise NoConvergence(f"the {len(active)} contact rows have no solution")
    return free + frozen.solve_push(push.directions - lifted), multiplier, active


def _caused(frozen: FrozenOperator, coefficients: RowCoefficients, count: BoolArray, push: Array) -> Array | float:
    """Components (m,) of the motion that forces ``push`` (b,) along the directions cause, on rows that ``count``."""
    if not push.any():
        return 0.0
    return np.where(count, coefficients.from_basis(frozen.compliance_times(push)), 0.0)


def _without_cycles(
    frozen: FrozenOperator,
    coefficients: RowCoefficients,
    rows: BoolArray,
    bare: Array,
    start: Array,
    floor: Array | float,
    effort: Effort,
) -> Array:
    """Multipliers (m,) of rows that are added one by one, so that no set comes twice even if rows depend on each other.

    ``bare`` (m,) are the components of the solution without contact beyond their targets, ``start`` (m,) admissible
    multipliers of the ``rows``.
    """
    sweep = itertools.count()

    def solve(index: IntArray) -> tuple[Array, Callable[[], Array]]:
        effort.step(f"contact of {len(rows)} rows, {len(index)} active, addition {next(sweep)}")
        _expect(frozen, coefficients, index, np.where(rows, bare, np.inf))
        force, push = multipliers(frozen, coefficients.subset(index), -bare[index])
        return force, lambda: bare + coefficients.from_basis(push.sensed)

    force, left = one_by_one(rows, start, floor, solve)
    if left.any():
        raise NoConvergence(f"the {len(rows)} contact rows have no solution")
    return force


def _expect(frozen: FrozenOperator, coefficients: RowCoefficients, index: IntArray, slack: Array) -> None:
    """Compute the columns of the active rows (k,); with new ones also those of rows close to contact."""
    if not len(frozen.table.missing(coefficients.subset(index).used)):
        return
    soon = np.argsort(slack, kind="stable")[: len(index) + BATCH]
    frozen.fill(np.union1d(coefficients.subset(index).used, coefficients.subset(soon[slack[soon] < np.inf]).used))


def without_contact(free: Array, frozen: FrozenOperator, before: Array) -> Array:
    """Components (b,) along the directions of a solution (f,) without the contact forces ``before`` (b,) in it."""
    return frozen.restrict(free)[: len(before)] - frozen.compliance_times(before)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactPush:
    """Forces along the contact ``directions`` (b,), and the motion ``sensed`` (b,) along them that they cause."""

    directions: Array
    sensed: Array


def delassus(frozen: FrozenOperator, active: RowCoefficients) -> Array:
    """Compliance (Delassus operator) ``G A^-1 G^T`` (k, k) of the active rows."""
    if isinstance(active, CombinedRows):
        return frozen.folded(active.matrix)
    return active.folded(frozen.square(active.used))


def multipliers(frozen: FrozenOperator, active: RowCoefficients, wanted: Array) -> tuple[Array, ContactPush]:
    """Multipliers (k,) of the active rows that move them by ``wanted`` (k,), and their contact forces."""

    def pushed(force: Array) -> ContactPush:
        directions = active.spread(force)
        return ContactPush(directions=directions, sensed=frozen.compliance_times(directions))

    recent = frozen.recent if isinstance(active, CombinedRows) and len(wanted) >= FEW else None
    if recent is not None:
        found = recent.refined(wanted, pushed, lambda push: active.from_basis(push.sensed))
        if found is not None:
            return found
    factor = _factored_compliance(frozen, active)
    if recent is not None:
        recent.factor = factor
    force = factor.solve(wanted / frozen.scale)
    return force, pushed(force)


def _factored_compliance(frozen: FrozenOperator, active: RowCoefficients) -> DenseFactor:
    """Factored compliance of the active rows (k,), unscaled; kept for all slabs if directions are rows."""
    plain = frozen.scaled(1.0)
    if isinstance(active, CombinedRows):
        return factored(delassus(plain, active))
    key = active.index.tobytes()
    if key not in frozen.factored_sets:
        frozen.factored_sets.clear()
        frozen.factored_sets[key] = factored(delassus(plain, active))
    return frozen.factored_sets[key]
