"""Iteration of a method until its iterates converge, and further for more accurate solutions."""

import logging
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.errors import NoConvergence
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.stagnation import Stagnation

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Guess:
    """Initial values of an iteration: ``q`` (n, d), multipliers ``impulse`` (m,) of the contact rows, the
    ``active`` rows (m,), and the operator of the slab before; ``near`` if the values nearly solve the equations.
    """

    q: Array
    impulse: Array
    active: BoolArray
    memory: OperatorMemory
    near: bool = False


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Iterate:
    """One iterate of a method.

    ``q`` (n, d) satisfies the contact rows; ``change`` is its distance from the point of the residual; ``impulse`` (m,)
    are the multipliers of the rows, ``active`` (m,) the rows with a multiplier; ``free`` (m,) are the normal components
    of the first iterate without contact; ``system`` are the equations with its rows; the iterate is ``sound`` if the
    surfaces do not overlap; ``end`` is its evaluation if it is known.
    """

    q: Array
    change: float
    impulse: Array
    active: BoolArray
    free: Array
    memory: OperatorMemory
    system: SlabEquations
    sound: bool
    end: Evaluation | None = None

    @property
    def guess(self) -> Guess:
        """Iterate as initial values of another iteration."""
        return Guess(q=self.q, impulse=self.impulse, active=self.active, memory=self.memory)


def lost(guess: Guess, system: SlabEquations) -> Iterate:
    """Iterate of a guess that is not admissible, with infinite change."""
    none, at = np.zeros(len(guess.active)), guess
    return Iterate(
        q=at.q, change=np.inf, impulse=none, active=at.active, free=none, memory=at.memory, system=system, sound=False
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Solution:
    """Converged slab: last iterate, its evaluation, free normal components (m,) of the first iterate, and mean ratio of
    successive changes.
    """

    last: Iterate
    end: Evaluation
    predicted: Array
    iterations: int
    contraction: float


LONGEST = 3
"""Greatest number of iterations of a slab with added facets, in units of the limit."""
FINEST = 1e-13
"""Change, relative to the greatest velocity, below which no more accurate solution is computed."""
PATIENCE = 12
"""Number of iterations without halving of the change, after which no more accurate solution can be found."""
STANDSTILL = ((6, 1e-9), (12, 1e-8))
"""Numbers of iterations without progress after which a change is accepted, and the change relative to the greatest
velocity: changes of mixed iterates may stagnate for as many iterations as the mixing uses, and then decrease again.
"""
ITERATIVE = 10.0
"""Greatest such change by an operator that solves approximately, relative to the tolerance: its error is not rounding.
"""
CONTRACTING = 0.5
"""Mean ratio of successive changes below which an iteration that reaches its limit was on its way to a solution."""
WILD = 100.0
"""Velocity of an iterate, relative to all that may cause it, beyond which the iteration has gone astray."""
SELF_BALANCED = 1e-12
"""Rounding error of the velocity by balanced forces, relative to the velocity by their magnitudes."""


def _pushed(system: SlabEquations, it: Iterate) -> float:
    """Greatest velocity that the magnitudes of internal force and load would cause in one slab [m/s]."""
    total = np.abs(system.start.force) + np.abs(system.model.load)
    force = system.model.dofs.forces(system.model.space.filled(total))
    frozen = it.memory.frozen
    return 0.0 if frozen is None else system.model.space.greatest(frozen.solve(system.path.span * force))


def resolved_speed(system: SlabEquations) -> float:
    """Velocity that moves the nodes by a few units in the last place of their coordinates in one slab [m/s]."""
    extent = system.model.extent(system.start.displacement)
    return 8.0 * float(np.finfo(float).eps) * extent / system.path.span


def iterate(system: SlabEquations, iterates: Iterator[Iterate], tolerance: float, limit: int) -> Iterator[Solution]:
    """Solutions of a slab, from the first iterate that changes by less than ``tolerance`` of the greatest velocity.

    More accurate solutions follow on demand: the change of each is less than half of the previous one.  They end if the
    change no longer decreases or is below ``FINEST`` of the greatest velocity.

    If the change no longer decreases, the iteration has reached the rounding level of the problem.  Its iterate is
    accepted if the change is below a fraction of the greatest velocity (``STANDSTILL``), below ``SELF_BALANCED`` of the
    velocity that the forces alone would cause in one slab (a body at rest under load), or at the rounding level of
    positions (bodies at rest that just touch).

    Raises
    ------
    NoConvergence
        If there is no solution after ``limit`` iterations on the same facets, a value is not finite, or a velocity
        leaves all reason.
    """
    seen, closest, resolved = Stagnation(), np.inf, resolved_speed(system)
    contact, begun, space = system.contact, 0, system.model.space
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
        if it.system.contact is not contact:
            contact, begun, seen = it.system.contact, count - 1, Stagnation()
        scale = max(space.greatest(it.q, system.start.velocity), 1e-300)
        system.effort.iterated(count, it.change / scale, int(np.count_nonzero(it.active[: len(it.free)])))
        _require_reason(system, it, scale)
        seen = seen.after(it.change, resolved)
        failure = f"{count} iterations leave a relative change of {it.change / scale:.1e} (tolerance {tolerance:.0e})"
        near = it.change <= tolerance * scale
        if (
            it.sound
            and it.change < 0.5 * closest
            and (near or _stagnates(system, it, seen.since, (scale, resolved), tolerance))
        ):
            closest, end = it.change, it.end or it.system.evaluate(it.q, it.impulse)
            fell = contraction(first, it.change, count)
            yield Solution(last=it, end=end, predicted=predicted, iterations=count, contraction=fell)
            if it.change <= FINEST * scale:
                return
        if closest < np.inf and seen.since >= PATIENCE:
            return
        if count - begun >= limit or count >= LONGEST * limit:
            break
    if closest == np.inf:
        # there is an iterate: methods yield one at least
        fell = contraction(first, it.change, count) if np.isfinite(it.change) else np.inf  # type: ignore[union-attr]
        raise NoConvergence(failure, contracting=fell < CONTRACTING)


def _require_reason(system: SlabEquations, it: Iterate, scale: float) -> None:
    """Refuse an iterate whose greatest velocity ``scale`` [m/s] crosses the whole scene in the slab without a cause.

    Raises
    ------
    NoConvergence
        If it is beyond ``WILD`` times all of: the velocities at the start, those of supports and tools, and what the
        forces at the start and the loads cause in the slab.
    """
    h, space = system.path.span, system.model.space
    if not system.model.inert or scale * h <= system.model.extent(system.start.displacement):
        return
    tools = space.greatest(system.path.rows.tool_motion) / h
    caused = max(space.greatest(system.start.velocity, np.asarray(system.given)), 2.0 * tools, _pushed(system, it))
    if scale > WILD * caused:
        raise NoConvergence(f"an iterate moves a node at {scale:.3g} m/s, where all causes give {caused:.3g} m/s")


def _stagnates(system: SlabEquations, it: Iterate, since: int, speeds: tuple[float, float], tolerance: float) -> bool:
    """True if the iteration stagnates at the rounding level, with ``since`` iterations since the change last halved.

    ``speeds`` are the greatest velocity and that of :func:`resolved_speed` [m/s].
    """
    scale, resolved = speeds
    most = ITERATIVE * tolerance if it.memory.frozen is not None and not it.memory.frozen.exact else np.inf
    if any(since >= n and it.change <= min(fraction, most) * scale for n, fraction in STANDSTILL):
        return True
    return since >= 4 and (it.change <= SELF_BALANCED * _pushed(system, it) or it.change <= resolved)


def contraction(first: float, last: float, count: int) -> float:
    """Mean ratio of the changes of successive iterates; zero for one iteration.

    Examples
    --------
    >>> round(contraction(1.0, 1e-6, 4), 9)
    0.01
    """
    return float((last / first) ** (1.0 / (count - 1))) if count > 1 and first > 0.0 else 0.0
