"""Newton's method for the forces of touching rows with friction.

The unknowns are the changes of the previous multipliers
(:class:`~softway.solve.constraints.friction_conditions.FrictionProblem`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import lstsq, lu_solve
from scipy.linalg.lapack import dgetrf

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NoConvergence
from softway.solve.constraints.friction_conditions import (
    FrictionProblem,
    FrictionResidual,
    friction_residual,
    gauss_seidel,
    linearised,
)
from softway.solve.constraints.return_map import SlipConditions
from softway.solve.stagnation import Stagnation

NEWTON = 25
"""Steps of Newton's method before proximal problems are solved."""
HALVINGS = 6
"""Halvings of a step that would increase the violation."""
FALLS = 0.1
"""Reduction of a residual by a step above which a new factor is cheaper than more steps."""
STUCK = 3
"""Searches without result for forces that let rows at rest stick, after which an attempt at a slab makes no more."""
SWEEPS = 10
"""Gauss-Seidel sweeps after Newton's method has failed on a proximal problem."""
ROUNDS = 30
"""Greatest number of proximal problems."""
PATIENCE = 5
"""Proximal problems without progress after which there is no solution to be found."""
FIRMER = 0.3
"""Part of the compliance along the surface in the trial forces of further attempts by Newton's method: with a law that
falls steeply with the speed several slips belong to the trial force of a row, but only one to the forces of all rows.
"""
FIRST, NEARER, LEAST = 0.1, 0.1, 1e-7
"""First proximal term relative to the compliance of the rows, its reduction each time, and its least value."""
FINAL = 1e-8
"""Residual, relative to the motion by the forces, below which dependent rows are treated separately."""
DEPENDENT, SUSPECT = 1e-11, 1e-9
"""Pivots, relative to the greatest, below which rows depend on each other, and below which a factor with exchange of
columns is computed."""
CONVERGED = 1e-14
"""Residual, relative to the motion by the forces, at the level of rounding."""
INCONSISTENT = 1e-7
"""Residual, relative to the motion by the forces, left in the end by dependent rows that contradict each other: rows of
one point that stick on several walls leave no motion to close all their gaps."""
ACCURATE = 1e-13
"""Residual, relative to the motion of the rows, at which steps with a kept factor end."""


def solve_multipliers(problem: FrictionProblem, x: Array) -> tuple[Array, BoolArray]:
    """Changes of the multipliers (c (1 + k),) from a guess x, and slipping rows (c,).

    If friction drops with the slip, rows at rest first stick at any force.  Then rows with a force beyond the limit are
    released, and so on: a released row does not stick again.  If no forces let them stick, rows at rest first slip with
    their stick limit as resistance, and the rows that slip are released.  An attempt at a slab in which this happened
    ``STUCK`` times does not look for forces that let them stick any more.

    Raises
    ------
    NoConvergence
        If no forces are found.
    """
    law, count, effort = problem.law, problem.count, problem.effort
    if law.stick_at_any_force or not count:
        return _solved(problem, x)
    try:
        if not law.drops(np.maximum(problem.multipliers(x)[0], 0.0)):
            return _solved(problem, x)
        if effort.unstuck < STUCK:
            return _released(problem, x, replace(law, stick_at_any_force=True), rounds=0)
    except NoConvergence:
        if not law.drops(np.ones(count)):
            raise
        effort.unstuck += 1
    return _released(problem, x, replace(law, slip_at_limit=True))


@dataclass(frozen=True, slots=True, eq=False)
class KeptNewton:
    """Factored linearisation at the solution of a ``problem``, for problems of rows that have turned a little.

    ``status`` tells which rows touched and slipped.
    """

    problem: FrictionProblem
    factor: tuple[Array, IntArray]
    status: bytes

    @classmethod
    def at(cls, problem: FrictionProblem, x: Array) -> "KeptNewton":
        """Factored linearisation at the solution x (c (1 + k),) of a problem."""
        residual = friction_residual(problem, x)
        factor = _factor(linearised(problem, residual))
        return cls(problem, factor, residual.status)

    def solved(
        self,
        free: Array,
        known: tuple[SlipConditions, Array, BoolArray],
        x: Array,
        moved: Callable[[Array], Array],
    ) -> tuple[Array, BoolArray] | None:
        """Changes of the multipliers (c (1 + k),) from a guess x, and slipping rows (c,), without a new factor.

        ``known`` are the law, the previous multipliers and the rows that stay closed.  ``moved`` gives the motion
        (c (1 + k),) of the rows by changes of the multipliers.  None if other rows touch or slip, if friction drops
        with the slip, or where the violation does not fall by ``FALLS`` in each step.
        """
        law, previous, equal = known
        if len(x) != len(self.problem.free) or law.stick_at_any_force:
            return None
        problem = replace(self.problem, free=free, law=law, previous=previous, equal=equal)
        if law.drops(np.maximum(problem.multipliers(x)[0], 0.0)):
            return None
        residual = friction_residual(problem, x, moved(x))
        while residual.status == self.status:
            if residual.worst <= max(ACCURATE * _size(problem, x, residual), problem.rounding):
                return _clean(problem, x, residual), residual.slips
            x, before = x - lu_solve(self.factor, residual.missed, check_finite=False), residual.worst
            residual = friction_residual(problem, x, moved(x))
            if not residual.worst <= FALLS * before:
                break
        return None


def _released(problem: FrictionProblem, x: Array, law: SlipConditions, rounds: int = ROUNDS) -> tuple[Array, BoolArray]:
    """Changes of the multipliers and slipping rows after the release of rows that slip or exceed their limit.

    ``law`` are the slip conditions of the problem with another friction of rows at rest.
    """
    slipping = law.sliding
    while True:
        x, slips = _solved(replace(problem, law=replace(law, sliding=slipping)), x, rounds)
        p, s = problem.multipliers(x)
        more = slips & ~slipping
        if law.stick_at_any_force:
            more = ~slipping & (np.linalg.norm(s, axis=1) > problem.law.limit(p))
        if not more.any():
            return x, slips
        slipping = slipping | more


@np.errstate(over="ignore", invalid="ignore")  # steps that go astray: what is not finite is refused
def _solved(problem: FrictionProblem, x: Array, rounds: int = ROUNDS) -> tuple[Array, BoolArray]:
    """Changes of the multipliers and slipping rows for a law that does not drop."""
    return _approached(_attempted(problem, x), rounds) if problem.count else (x, np.zeros(0, bool))


@dataclass(frozen=True, slots=True, eq=False)
class NewtonAttempt:
    """Changes x (c (1 + k),) of the multipliers by Newton's method on a problem, and True if it has converged."""

    problem: FrictionProblem
    x: Array
    converged: bool


def _attempted(problem: FrictionProblem, x: Array) -> NewtonAttempt:
    """Changes by Newton's method from x, then with less slip in the trial forces, from x and without friction."""
    first = NewtonAttempt(problem, *_newton(problem, x))
    firmer = problem.firmer(FIRMER)
    for start in (x, problem.without_friction(x)):
        if first.converged:
            return first
        again = NewtonAttempt(firmer, *_newton(firmer, start))
        first = again if again.converged else first
    return first


def _approached(attempt: NewtonAttempt, rounds: int = ROUNDS) -> tuple[Array, BoolArray]:
    """Changes of the multipliers and slipping rows, from those where Newton's method has ended.

    If it has not converged, a sequence of proximal problems is solved: their multipliers are drawn to the previous
    ones, less and less (Rockafellar 1976, Monotone operators and the proximal point algorithm, SIAM J. Control Optim.
    14, 877).  The limit of the sequence solves the original problem, up to a residual of ``INCONSISTENT``.

    Raises
    ------
    NoConvergence
        If no forces are found.
    """
    problem, x, converged = attempt.problem, attempt.x, attempt.converged
    pull, seen, residual = FIRST, Stagnation(), friction_residual(problem, x)
    for _ in range(rounds):
        if converged:
            break
        near = problem.drawn(np.nan_to_num(x), pull)
        x, reached = _newton(near, np.nan_to_num(x))
        x = x if reached else _newton(near, gauss_seidel(near, np.nan_to_num(x), SWEEPS))[0]
        residual, pull = friction_residual(problem, x), max(NEARER * pull, LEAST)
        seen = seen.after(residual.worst)
        converged = _converged(problem, x, residual, seen.since)
        if seen.since > PATIENCE:
            break
    size = _size(problem, x, residual)
    if converged or residual.worst <= INCONSISTENT * size:
        return _clean(problem, x, residual), residual.slips
    if not np.isfinite(residual.worst):
        raise NoConvergence(f"friction of {problem.count} contact rows: the forces are not finite")
    raise NoConvergence(f"friction of {problem.count} contact rows leaves {residual.worst:.1e} of {size:.1e}")


def _newton(problem: FrictionProblem, x: Array) -> tuple[Array, bool]:
    """Changes (c (1 + k),) by Newton's method from x, and True if they converged; x if they are not finite."""
    seen, factor, before, last_status = Stagnation(), None, np.inf, b""
    residual = friction_residual(problem, x)
    for count in range(1, NEWTON + 1):
        seen = seen.after(residual.worst)
        if _converged(problem, x, residual, seen.since):
            return x, True
        problem.effort.step(f"friction of {problem.count} rows, step {count} of Newton's method")
        if factor is None or residual.worst > FALLS * before or residual.status != last_status:
            last_status = residual.status
            factor = _factor(linearised(problem, residual))
        step, before = lu_solve(factor, residual.missed, check_finite=False), residual.worst
        if not np.isfinite(step).all():
            break
        steps = [step, *_shortest(problem, x, residual, factor)] if seen.since else [step]
        x, residual = min((_line_searched(problem, x, one, residual) for one in steps), key=lambda it: it[1].worst)
    return x, False


def _factor(matrix: Array) -> tuple[Array, IntArray]:
    """Factors of a matrix (n, n), which may be singular: solutions are not finite then."""
    factors, swaps, _ = dgetrf(matrix, overwrite_a=True)
    return factors, swaps


def _shortest(
    problem: FrictionProblem, x: Array, residual: FrictionResidual, factor: tuple[Array, IntArray]
) -> list[Array]:
    """Shortest step (c (1 + k),) of Newton's method near convergence, if dependent rows make it ambiguous.

    Otherwise rounding determines the ambiguous part, and may create self-equilibrated forces between these rows that
    prevent convergence to machine precision.
    """
    pivot = np.abs(np.diagonal(factor[0]))
    if residual.worst > FINAL * _size(problem, x, residual) or pivot.min() > SUSPECT * pivot.max():
        return []
    matrix = linearised(problem, residual)
    return [lstsq(matrix, residual.missed, cond=DEPENDENT, lapack_driver="gelsy", check_finite=False)[0]]


def _converged(problem: FrictionProblem, x: Array, residual: FrictionResidual, since: int) -> bool:
    """True if the multipliers satisfy the conditions up to rounding, or nearly and without progress for some steps."""
    least = CONVERGED * _size(problem, x, residual)
    return bool(residual.worst <= max(least, problem.rounding) or (since >= 3 and residual.worst <= 1e3 * least))


def _line_searched(
    problem: FrictionProblem, x: Array, step: Array, residual: FrictionResidual
) -> tuple[Array, FrictionResidual]:
    """Changes after a step and their residual; the step is halved while the violation grows, or full if this fails."""
    now, fraction = float(np.linalg.norm(residual.missed)), 1.0
    full_step = x - step, friction_residual(problem, x - step)
    new, found = full_step
    for _ in range(HALVINGS):
        if float(np.linalg.norm(found.missed)) <= (1.0 - 0.1 * fraction) * now:
            return new, found
        fraction *= 0.5
        new = x - fraction * step
        found = friction_residual(problem, new)
    return full_step


def _size(problem: FrictionProblem, x: Array, residual: FrictionResidual) -> float:
    """Greatest motion by single changes, and of sticking rows without them: the scale of rounding.

    Changes of neighbours may cancel each other: the motion by each single change determines the rounding error.
    """
    gap, slip = problem.split(problem.free)
    sticking = np.abs(slip[~residual.slips]).max(initial=0.0)
    moved = (np.abs(problem.compliance) @ np.abs(x)).max(initial=0.0)
    return float(max(np.abs(gap).max(initial=0.0), sticking, moved, 1e-300))


def _clean(problem: FrictionProblem, x: Array, residual: FrictionResidual) -> Array:
    """Changes with zero multipliers on rows that do not touch, and without tension by rounding."""
    c = problem.count
    touch = np.concatenate([residual.touch, np.repeat(residual.rubs, problem.law.shift.shape[1])])
    out = np.where(touch, x, -problem.previous)
    out[:c] = np.where(problem.equal, out[:c], np.maximum(out[:c], -problem.previous[:c]))
    return out
