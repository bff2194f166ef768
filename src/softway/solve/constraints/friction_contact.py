"""Contact with friction on the frozen operator: the touching rows and their forces.

Given the free solution ``y`` of A y = b, find normal and tangential multipliers of the contact rows such that
``z = y + A^-1 (G^T p + T^T s)`` satisfies

    G z >= c,  p >= 0,  p (G z - c) = 0,    s = -resistance(T z - shift, p) along the slip, or no slip within a limit.

The tangential condition is the return map of a trial ``s - r (T z - shift)``.  Nothing is regularised: rows that stick
do not move, rows that slip have the force of the law (docs/theory/contact/friction.md).  The unknowns are the changes
of the previous multipliers (:class:`~softway.solve.constraints.friction_conditions.FrictionProblem`).
"""

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NoConvergence
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.friction_conditions import friction_problem
from softway.solve.constraints.friction_newton import KeptNewton, solve_multipliers
from softway.solve.constraints.normal_active_set import RowConditions, delassus, without_contact
from softway.solve.constraints.recent_factor import FEW
from softway.solve.constraints.return_map import SlipConditions
from softway.solve.constraints.row_basis import RowCoefficients
from softway.solve.effort import Effort


def solve_friction(
    free: Array,
    frozen: FrozenOperator,
    coefficients: RowCoefficients,
    rows: RowConditions,
    guess: BoolArray,
    previous: Array,
    effort: Effort | None = None,
) -> tuple[Array, Array, BoolArray]:
    """Solve the contact problem with friction for a free solution: solution (f,), multipliers and active rows.

    The normal multipliers (m,) are followed by the tangential ones (m k,), row by row; the touching rows (m,) by the
    slipping rows (m,).  The free solution contains the ``previous`` multipliers already.  Rows ``equal`` stay closed,
    also in tension.

    Raises
    ------
    NoConvergence
        If no forces are found.
    """
    law, (m, k) = rows.slipping, rows.slipping.shift.shape
    offset = np.concatenate([rows.target, law.shift.ravel()])
    pressed = np.zeros(m, bool) if law.given is None else law.given > 0.0
    open_ = np.concatenate([some := rows.unilateral | rows.equal | pressed, np.repeat(some, k)])
    loaded = np.where(open_, coefficients.from_basis(frozen.restrict(free)) - offset, 0.0)
    slack = np.where(
        open_, coefficients.from_basis(without_contact(free, frozen, coefficients.spread(previous))) - offset, 0.0
    )
    floor, near = rows.missable(slack[:m]), rows.equal | pressed | (rows.unilateral & guess[:m])
    x = np.zeros(len(previous))
    for _ in range(30 + m):
        index = np.flatnonzero(near)
        here = stacked(index, m, k)
        part, rest = coefficients.subset(here), np.where(np.isin(np.arange(len(previous)), here), 0.0, previous)
        lifted = coefficients.spread(rest)
        now = loaded - np.where(open_, coefficients.from_basis(frozen.compliance_times(lifted)), 0.0)
        known = law.subset(index), previous[here], rows.equal[index]
        x[here], slips = _multipliers(frozen, part, now[here], known, x[here], (rows.rounding, effort))
        push = part.spread(x[here])
        gap = now[:m] + coefficients.from_basis(frozen.compliance_times(push))[:m]
        fresh = rows.unilateral & ~near & (gap < -floor)
        if not fresh.any():
            break
        near = near | fresh
    else:
        raise NoConvergence(f"the {m} contact rows have no solution")
    multiplier = np.zeros(len(previous))
    multiplier[here] = previous[here] + x[here]
    active = np.concatenate([rows.equal | (multiplier[:m] > 0.0), np.isin(np.arange(m), index[slips])])
    return free + frozen.solve_push(push - lifted), multiplier, active


def _multipliers(
    frozen: FrozenOperator,
    part: RowCoefficients,
    free: Array,
    known: tuple[SlipConditions, Array, BoolArray],
    x: Array,
    settings: tuple[float, Effort | None],
) -> tuple[Array, BoolArray]:
    """Changes of the multipliers of some rows, and which of them slip; with the factor of an earlier iteration of the
    slab where that serves.
    """
    recent, (law, previous, equal) = frozen.recent if len(x) >= FEW else None, known
    if recent is not None and recent.friction is not None:
        found = recent.friction.solved(
            free, known, x, lambda y: part.from_basis(frozen.compliance_times(part.spread(y)))
        )
        if found is not None:
            return found
    problem = friction_problem(delassus(frozen, part), free, law, previous, *settings, equal)
    x, slips = solve_multipliers(problem, x)
    if recent is not None and problem.count:
        recent.friction = KeptNewton.at(problem, x)
    return x, slips


def stacked(index: IntArray, m: int, k: int) -> IntArray:
    """Places of the rows ``index`` out of m, followed by those of their k tangential directions.

    Examples
    --------
    >>> stacked(np.array([1]), 2, 2).tolist()
    [1, 4, 5]
    """
    return np.concatenate([index, (m + k * index[:, None] + np.arange(k)).ravel()])
