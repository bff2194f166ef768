"""Contact with friction on the frozen operator: Newton's method on the forces of the rows that touch.

Given the free solution ``y`` of A y = b, find normal and tangential multipliers of the contact rows such that
``z = y + A^-1 (G^T p + T^T s)`` satisfies

    G z >= c,  p >= 0,  p (G z - c) = 0,    s = -resistance(T z - shift, p) along the slip, or no slip within a limit.

The tangential condition is the return map of a trial ``s - r (T z - shift)``.  Nothing is regularised: rows that stick
do not move, rows that slip have the force of the law (docs/theory/friction.md).  The unknowns are the changes of the
multipliers that an iterate carries (:class:`~softway.solve.touching.Touching`).
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import lstsq, lu_factor, lu_solve

from softway.errors import NoConvergence
from softway.solve.along import Along
from softway.solve.frozen import Frozen
from softway.solve.normal import Rows, delassus, untouched
from softway.solve.touching import Look, Touching, linearised, looked, swept, touching
from softway.typing import Array, BoolArray, IntArray

NEWTON = 25
"""Steps of Newton's method, after which the multipliers are drawn to those before."""
HALVINGS = 6
"""Halvings of a step that would miss the conditions by more than before."""
FALLS = 0.1
"""Share to which a step must bring the violation, or the next one has a linearisation of its own."""
SWEEPS = 10
"""Sweeps over the rows that help Newton's method out there."""
ROUNDS = 30
"""Problems that draw the multipliers to those of the one before."""
FIRST, NEARER, LEAST = 0.1, 0.1, 1e-7
"""How much they are drawn at first, as a share of what the rows give way, how much less each time, and the least."""
FINAL = 1e-8
"""Residual, relative to what the forces move, from which on dependent rows are told from others."""
DEPENDENT, SUSPECT = 1e-11, 1e-9
"""Share of the greatest pivot below which rows depend on each other, and below which a factor without exchange of
columns asks for those pivots."""
SETTLED = 1e-14
"""Residual, relative to what the forces move, that is rounding."""


def rubbed(
    free: Array, frozen: Frozen, coefficients: Along, rows: Rows, guess: BoolArray, carried: Array
) -> tuple[Array, Array, BoolArray]:
    """Solution (f,), multipliers and active rows of the contact problem with friction for the free solution.

    Multipliers are those of the normals (m,) followed by the tangential ones (m k,), row by row; active are the rows
    that touch (m,) followed by those that slip (m,).  Multipliers ``carried`` are in ``free`` already.

    Raises
    ------
    NoConvergence
        If no forces are found.
    """
    law = rows.slipping
    assert law is not None
    m, k = law.shift.shape
    before = coefficients.spread(carried)
    offset = np.concatenate([rows.target, law.shift.ravel()])
    open_ = np.concatenate([rows.unilateral, np.repeat(rows.unilateral, k)])
    loaded = np.where(open_, coefficients.along(frozen.sense(free)) - offset, 0.0)
    slack = np.where(open_, coefficients.along(untouched(free, frozen, before)) - offset, 0.0)
    floor = rows.missable(slack[:m])
    near = rows.unilateral & guess[:m]
    x = np.zeros(len(carried))
    for _ in range(30 + m):
        index = np.flatnonzero(near)
        every = stacked(index, m, k)
        part, rest = coefficients.part(every), carried.copy()
        rest[every] = 0.0
        lifted = coefficients.spread(rest)
        now = loaded - np.where(open_, coefficients.along(frozen.give(lifted)), 0.0)
        problem = touching(delassus(frozen, part), now[every], law.part(index), carried[every], rows.rounding)
        x[every], slips = settled(problem, x[every])
        push = part.spread(x[every])
        gap = now[:m] + coefficients.along(frozen.give(push))[:m]
        fresh = rows.unilateral & ~near & (gap < -floor)
        if not fresh.any():
            break
        near = near | fresh
    else:
        raise NoConvergence(f"the {m} contact rows have no solution")
    multiplier = np.zeros(len(carried))
    multiplier[every] = carried[every] + x[every]
    sliding = np.zeros(m, bool)
    sliding[index] = slips
    active = np.concatenate([multiplier[:m] > 0.0, sliding])
    return free + frozen.answer(push - lifted), multiplier, active


def stacked(index: IntArray, m: int, k: int) -> IntArray:
    """Places of some rows out of m, and of their k tangential directions.

    Examples
    --------
    >>> stacked(np.array([1]), 2, 2).tolist()
    [1, 4, 5]
    """
    return np.concatenate([index, (m + k * index[:, None] + np.arange(k)).ravel()])


def settled(problem: Touching, x: Array) -> tuple[Array, BoolArray]:
    """Changes of the multipliers (c (1 + k),) from a guess x, and which rows slip (c,).

    Where friction drops with the slip, rows that rest are held at any force, then those let go whose force is beyond
    the limit, and so on: a row that let go is not held again.

    Raises
    ------
    NoConvergence
        If no forces are found.
    """
    law = problem.law
    if not problem.count or not law.drops(np.maximum(problem.whole(x)[0], 0.0)):
        return _solved(problem, x)
    going = law.sliding
    while True:
        x, slips = _solved(replace(problem, law=replace(law, sliding=going, held=True)), x)
        p, s = problem.whole(x)
        more = ~going & (np.linalg.norm(s, axis=1) > law.limit(p))
        if law.held or not more.any():
            return x, slips
        going = going | more


def _solved(problem: Touching, x: Array) -> tuple[Array, BoolArray]:
    """The changes of the multipliers and the rows that slip under a law that does not drop.

    Where Newton's method does not settle by itself, a sequence of problems is solved whose multipliers are drawn to
    those of the one before, ever less (Rockafellar 1976, Monotone operators and the proximal point algorithm, SIAM J.
    Control Optim. 14, 877): what they converge to solves the problem itself.
    """
    if not problem.count:
        return x, np.zeros(0, bool)
    x, settles = _newton(problem, x)
    share, best, since, look = FIRST, np.inf, 0, looked(problem, x)
    for _ in range(ROUNDS):
        if settles:
            return _clean(problem, x, look), look.slips & look.touch
        near = problem.drawn(np.nan_to_num(x), share)
        x, reached = _newton(near, np.nan_to_num(x))
        x = x if reached else _newton(near, swept(near, np.nan_to_num(x), SWEEPS))[0]
        look, share = looked(problem, x), max(NEARER * share, LEAST)
        best, since = (look.worst, 0) if look.worst < 0.5 * best else (best, since + 1)
        settles = _settles(problem, x, look, since)
    if not np.isfinite(look.worst):
        raise NoConvergence(f"friction of {problem.count} contact rows has no forces that are numbers")
    size = _size(problem, x, look)
    raise NoConvergence(f"friction of {problem.count} contact rows leaves {look.worst:.1e} of {size:.1e}")


def _newton(problem: Touching, x: Array) -> tuple[Array, bool]:
    """Changes (c (1 + k),) by Newton's method from x, and whether they settled; x where they are not numbers."""
    best, since, factor, before, known = np.inf, 0, None, np.inf, b""
    look = looked(problem, x)
    for _ in range(NEWTON):
        best, since = (look.worst, 0) if look.worst < 0.5 * best else (best, since + 1)
        if _settles(problem, x, look, since):
            return x, True
        status = look.touch.tobytes() + look.slips.tobytes()
        if factor is None or look.worst > FALLS * before or status != known:
            known, factor = status, lu_factor(linearised(problem, look), overwrite_a=True, check_finite=False)
        step, before = lu_solve(factor, look.missed, check_finite=False), look.worst
        if not np.isfinite(step).all():
            break
        steps = [step, *_shortest(problem, x, look, factor)] if since else [step]
        x, look = min((_searched(problem, x, one, look) for one in steps), key=lambda it: it[1].worst)
    return x, False


def _shortest(problem: Touching, x: Array, look: Look, factor: tuple[Array, IntArray]) -> list[Array]:
    """The shortest step (c (1 + k),) of Newton's method, if rows that depend on each other leave it open, near the end.

    Rounding settles what they leave open, and may drive forces round between them that keep the last digits away.
    """
    pivot = np.abs(np.diagonal(factor[0]))
    if look.worst > FINAL * _size(problem, x, look) or pivot.min() > SUSPECT * pivot.max():
        return []
    matrix = linearised(problem, look)
    return [lstsq(matrix, look.missed, cond=DEPENDENT, lapack_driver="gelsy", check_finite=False)[0]]


def _settles(problem: Touching, x: Array, look: Look, since: int) -> bool:
    """Whether multipliers meet the conditions to rounding, of positions too, or nearly and no better for some steps."""
    least = SETTLED * _size(problem, x, look)
    return bool(look.worst <= max(least, problem.rounding) or (since >= 3 and look.worst <= 1e3 * least))


def _searched(problem: Touching, x: Array, step: Array, look: Look) -> tuple[Array, Look]:
    """The changes after a step, halved while they miss more than before, or whole if that is no help; the look."""
    now, share = float(np.linalg.norm(look.missed)), 1.0
    whole = x - step, looked(problem, x - step)
    new, found = whole
    for _ in range(HALVINGS):
        if float(np.linalg.norm(found.missed)) <= (1.0 - 0.1 * share) * now:
            return new, found
        share *= 0.5
        new = x - share * step
        found = looked(problem, new)
    return whole


def _size(problem: Touching, x: Array, look: Look) -> float:
    """What the changes move, each by itself, and what the rows that hold would move without them.

    Changes of neighbours may move next to nothing together: what each moves is what is rounded.
    """
    gap, slip = problem.split(problem.free)
    held = np.abs(slip[~look.slips]).max(initial=0.0)
    moved = (np.abs(problem.compliance) @ np.abs(x)).max(initial=0.0)
    return float(max(np.abs(gap).max(initial=0.0), held, moved, 1e-300))


def _clean(problem: Touching, x: Array, look: Look) -> Array:
    """The changes, with which rows that do not touch have no multipliers, and none pulls by its last digits."""
    c = problem.count
    touch = np.concatenate([look.touch, np.repeat(look.touch, problem.law.shift.shape[1])])
    out = np.where(touch, x, -problem.carried)
    out[:c] = np.maximum(out[:c], -problem.carried[:c])
    return out
