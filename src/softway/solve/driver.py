"""The only loop with a tolerance in it: run a method until its iterates stand still, and on if that is not enough."""

import logging
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.errors import NoConvergence
from softway.solve.carry import Carry
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.typing import Array, BoolArray

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Iterate:
    """One iterate of a method.

    ``q`` (n, d) satisfies the contact rows; ``change`` is its distance from the point where the residual was taken;
    ``impulse`` (m,) are the multipliers of the rows, ``active`` (m,) the rows that carry one; ``free`` (m,) is the
    normal component that the first iterate has without contact; ``system`` holds the rows as they were, and is
    ``sound`` if the surfaces do not overlap.
    """

    q: Array
    change: float
    impulse: Array
    active: BoolArray
    free: Array
    carry: Carry
    system: SlabSystem
    sound: bool


def lost(q: Array, active: BoolArray, carry: Carry, system: SlabSystem) -> Iterate:
    """The iterate that says that q is not admissible: its change is infinite."""
    none = np.zeros(len(active))
    return Iterate(q=q, change=np.inf, impulse=none, active=active, free=none, carry=carry, system=system, sound=False)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Solution:
    """A converged slab: the last iterate, its evaluation, the free normal components (m,) of the first iterate, and the
    mean factor by which the changes fell from one iterate to the next.
    """

    last: Iterate
    end: Evaluation
    predicted: Array
    iterations: int
    contraction: float


LONGEST = 3
"""Limits of iterations after which a slab ends, however often faces were added."""
FINEST = 1e-13
"""Change, as a share of the greatest velocity, below which no closer solution is worth looking for."""
PATIENCE = 12
"""Iterations in which the change does not halve once after which no closer solution is to be had."""
STANDSTILL = ((6, 1e-9), (12, 1e-8))
"""Iterations without progress after which a change is accepted, and as what share of the greatest velocity: mixed
iterates stand still for as many as they look back on, and fall again.
"""
ROUNDING = 1e-12
"""Share of the velocity made by forces that balance each other which is rounding."""


def _pushed(system: SlabSystem, it: Iterate) -> float:
    """Greatest velocity that internal force and load would give in one slab, without regard to their signs [m/s]."""
    force = (np.abs(system.start.force) + np.abs(system.model.load))[system.model.free]
    frozen = it.carry.frozen
    return 0.0 if frozen is None else float(np.abs(frozen.solve(system.path.span * force)).max(initial=0.0))


def _resolved(system: SlabSystem) -> float:
    """Velocity that moves the nodes by a few units in the last place of their coordinates in one slab [m/s]."""
    reach = float(np.abs(system.model.points + system.start.displacement).max())
    return 8.0 * float(np.finfo(float).eps) * reach / system.path.span


def solutions(system: SlabSystem, iterates: Iterator[Iterate], tolerance: float, limit: int) -> Iterator[Solution]:
    """Solutions of a slab, from the first iterate on that changes by less than ``tolerance`` of the greatest velocity.

    Whom the first does not satisfy may ask for more: each changes by less than half of the one before, and they end
    where the change no longer decreases or is below ``FINEST`` of the greatest velocity.

    An iteration whose change no longer decreases has reached the rounding level of the problem: it is accepted within
    some share of the greatest velocity (``STANDSTILL``), within ``ROUNDING`` of the velocity that the forces alone
    would give in one slab (a body at rest under load), or where it moves nothing but the last digits of positions
    (bodies at rest that just touch).

    Raises
    ------
    NoConvergence
        If there is none: after ``limit`` iterations on the same faces, or at the first value that is not finite.
    """
    best, since, closest = np.inf, 0, np.inf
    faces, begun = system.pairs, 0
    predicted: Array | None = None
    it: Iterate | None = None
    scale, first = 1.0, 0.0
    for count, it in enumerate(iterates, 1):
        if not np.isfinite(it.change):
            failure = "the iteration left the admissible configurations (inverted cell or overflow)"
            break
        predicted = it.free if predicted is None else predicted
        first = it.change if count == 1 else first
        log.debug("iterate %d: change %.3g m/s", count, it.change)
        if it.system.pairs is not faces:
            faces, begun, best = it.system.pairs, count - 1, np.inf
        scale = max(np.abs(it.q).max(initial=0.0), np.abs(system.start.velocity).max(initial=0.0), 1e-300)
        best, since = (it.change, 0) if it.change < 0.5 * best else (best, since + 1)
        failure = f"{count} iterations leave a relative change of {it.change / scale:.1e} (tolerance {tolerance:.0e})"
        near = it.change <= tolerance * scale
        if it.sound and it.change < 0.5 * closest and (near or _stands(system, it, since, scale)):
            closest, end = it.change, it.system.evaluate(it.q, it.impulse)
            fell = contraction(first, it.change, count)
            yield Solution(last=it, end=end, predicted=predicted, iterations=count, contraction=fell)
            if not near or it.change <= FINEST * scale:
                return
        if closest < np.inf and since >= PATIENCE:
            return
        if count - begun >= limit or count >= LONGEST * limit:
            break
    if closest == np.inf:
        raise NoConvergence(failure)


def _stands(system: SlabSystem, it: Iterate, since: int, scale: float) -> bool:
    """Whether an iterate stands still at the rounding level, after some iterations ``since`` the change last halved."""
    if any(since >= n and it.change <= share * scale for n, share in STANDSTILL):
        return True
    return since >= 4 and (it.change <= ROUNDING * _pushed(system, it) or it.change <= _resolved(system))


def contraction(first: float, last: float, count: int) -> float:
    """Mean factor between the changes of successive iterates; zero where one iteration was enough.

    Examples
    --------
    >>> round(contraction(1.0, 1e-6, 4), 9)
    0.01
    """
    return float((last / first) ** (1.0 / (count - 1))) if count > 1 and first > 0.0 else 0.0
