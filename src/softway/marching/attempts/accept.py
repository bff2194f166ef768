"""The next accepted slab (time step): attempts, with cutbacks to half the length."""

import logging
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from softway.bodies.assembled.dashpots import Dashpots
from softway.errors import Halts, NoConvergence, NumericsError, TooFast, Unbalanced, heed
from softway.marching.attempts.audited_slab import DAMPED, AcceptedSlab, Dropped, audited_slab
from softway.marching.attempts.dashpot_slab import SHORT, dashpots, dashpots_serve, without_operator
from softway.marching.attempts.rejections import possible_remedies
from softway.marching.results.trying import watched
from softway.marching.rules.slab_rule import Attempt, SlabRule
from softway.marching.slab.endings import crushed, reason, touching
from softway.marching.slab.slab_step import Stepper
from softway.marching.start.knots import slab_end
from softway.marching.state.march_state import MarchState
from softway.marching.state.step_control import above
from softway.model.slab import Slab
from softway.model.time_weight import TimeWeight
from softway.solve.effort import Effort
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory

log = logging.getLogger(__name__)
PATIENCE = 1
"""Cutbacks after which an energy balance that the scalar cannot close is closed along the motion."""
STEPS = 24
"""Steps of the contact problems for each iterate above which an attempt is given up; accepted slabs take up to 10."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Way:
    """Attempts from a ``length`` down to the ``least`` one [s], with dashpots or without."""

    length: float
    least: float
    dashpots: Dashpots | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Rejection:
    """Reason of a rejection, and whether the attempt lacked iterations, not a solution."""

    reason: str
    contracting: bool

    @classmethod
    def of(cls, span: float, failure: Exception) -> "_Rejection":
        """Rejection of a slab of a length [s]."""
        contracting = isinstance(failure, NoConvergence) and failure.contracting
        return cls(reason=f"h = {span:.3g} s: {failure}", contracting=contracting)


def accept_slab(stepper: Stepper, march_state: MarchState, length: float, memory: OperatorMemory) -> AcceptedSlab:
    """Find the next accepted slab, with cutbacks to half its length; ``memory`` has an operator if available.

    Where slabs of less than ``SHORT`` of the requested length fail, the longer ones are tried once more with dashpots
    between massless nodes and the nodes of their cells, and then the shorter ones without.

    Raises
    ------
    NumericsError
        If no slab was accepted.
    """
    control, history = march_state.settings.control, march_state.step_history
    crawls, rejected = history.recent_rejections > control.patience, list[_Rejection]()
    for way in _ways(stepper, march_state, length, crawls, rejected):
        found = _cut_back(stepper, march_state, way, memory, crawls, rejected)
        if found is not None:
            return found
        memory = memory.failed()
    now = march_state.state
    reasons = [one.reason for one in rejected]
    told = reason(march_state, reasons, crawls) + touching(stepper.model, now) + crushed(stepper.model, now)
    raise NumericsError(told, now.time, possible_remedies(stepper, march_state))


def _ways(
    stepper: Stepper, march_state: MarchState, length: float, crawls: bool, rejected: list[_Rejection]
) -> Iterator[_Way]:
    """Ways to try the next slab, one after another.

    After a slab with dashpots the next one is tried once without them.  Where an iteration only lacks iterations, and
    in a march that crawls, there are none: the method fails, not the equilibrium.  On meshes that have just changed
    there are neither dashpots nor the shortest slabs: the old meshes are tried first.
    """
    history = march_state.step_history
    least = march_state.settings.control.least * history.span
    short = max(least, SHORT * history.span)
    allowed = (history.dashpots or stepper.dashpots) and dashpots_serve(stepper)
    if crawls or not allowed or march_state.meshes_changed:
        yield _Way(length=length, least=short if march_state.meshes_changed else least)
        return
    yield _Way(length=length, least=0.75 * length if history.dashpots else short)
    if not (rejected and rejected[-1].contracting):
        yield _Way(length=min(length, history.span), least=short, dashpots=dashpots(stepper.model, march_state))
    yield _Way(length=length if history.dashpots else short, least=least)


def _cut_back(
    stepper: Stepper,
    march_state: MarchState,
    way: _Way,
    memory: OperatorMemory,
    crawls: bool,
    rejected: list[_Rejection],
) -> AcceptedSlab | None:
    """First accepted slab of a way; None without one.  Its rejections are added to those before.

    A slab that fails with an old operator is first tried again with a new one, one in which Newton's method does not
    converge by the fixed point, and one with an indefinite operator by a positive definite one, and then by Newton's
    method.  If the scalar cannot close the energy balance at half the length either, it is closed along the motion,
    also in the following slabs.  A slab inside which a body comes to rest is tried again with its end at that instant;
    the slab after it is damped.
    """
    now, settings, history = march_state.state, march_state.settings, march_state.step_history
    length, least, halted, positive_definite = way.length, way.least, False, False
    memory = memory if way.dashpots is None else without_operator(memory)
    fresh, first, unbalanced = memory.origin is None, stepper, PATIENCE if history.energy_along_motion else 0
    while length > least and not (crawls and rejected):
        heed(stepper.cancel, now.time)
        end = slab_end(stepper.ends, settings.until, now.time, length)
        slab = Slab(start=now.time, end=end, weight=_weight(stepper, march_state, way))
        try:
            attempt = _attempt(stepper, march_state, slab, way, unbalanced >= PATIENCE, positive_definite)
            found = audited_slab(stepper, march_state, slab, memory, attempt)
            return _accepted(found, way, tuple(one.reason for one in rejected), halted)
        except Dropped as failure:
            length, memory = failure.length, failure.memory
            rejected.append(_Rejection.of(slab.span, failure))
        except Halts as stop:
            length, halted, least = stop.fraction * length, True, settings.control.least * history.span
            continue
        except (TooFast, Unbalanced) as failure:
            length = 0.5 * length
            unbalanced += isinstance(failure, Unbalanced) and not above(slab.span, history.span)
            rejected.append(_Rejection.of(slab.span, failure))
        except NoConvergence as failure:
            rejected.append(_Rejection.of(slab.span, failure))
            rule, positive_definite = _other_way(first, stepper.rule, attempt)
            length = 0.5 * length if fresh and rule is first.rule and not positive_definite else length
            stepper, fresh, memory = replace(first, rule=rule), True, memory.failed()
        log.info("slab at t = %.6g s rejected: %s", now.time, rejected[-1].reason)
    return None


def _accepted(found: AcceptedSlab, way: _Way, rejections: tuple[str, ...], halted: bool) -> AcceptedSlab:
    """The slab with what went before; an operator with dashpots serves no other slab."""
    if way.dashpots is None:
        return replace(found, rejections=rejections, halted=halted)
    memory = without_operator(found.memory)
    return replace(found, rejections=rejections, halted=halted, memory=memory, dashpots=way.dashpots)


def _other_way(first: Stepper, rule: SlabRule, failed: Attempt) -> tuple[SlabRule, bool]:
    """Rule of the next attempt at a slab that failed by ``rule``, and whether its operators are positive definite.

    Newton's method is followed by the fixed point, the fixed point with an indefinite operator by one with positive
    definite operators, and that by Newton's method with such operators.  The last of them is followed by the first.
    """
    other, indefinite = first.second, failed.effort.indefinite
    begins = other is not None and rule is first.rule
    if begins and isinstance(first.method, Newton):
        return cast(SlabRule, other), indefinite
    if indefinite and not failed.positive_definite:
        return rule, True
    return (cast(SlabRule, other), True) if begins and failed.positive_definite else (first.rule, False)


def _weight(stepper: Stepper, march_state: MarchState, way: _Way) -> TimeWeight:
    """Virtual time function of the next slab: that of a damped slab with dashpots or after them, and, if there are
    massless nodes, after a stop.
    """
    damped = march_state.step_history.altered and not stepper.model.space.every(stepper.model.massive)
    return DAMPED if damped or way.dashpots is not None else march_state.settings.weight


def _attempt(
    stepper: Stepper,
    march_state: MarchState,
    slab: Slab,
    way: _Way,
    energy_along_motion: bool,
    positive_definite: bool,
) -> Attempt:
    """Attempt at the next slab."""
    settings, history = march_state.settings, march_state.step_history
    return Attempt(
        approach=settings.control.approach,
        lowest=np.inf if settings.tolerance is None else history.span,
        energy_along_motion=energy_along_motion,
        cancel=stepper.cancel,
        effort=Effort(STEPS, watched(stepper.trying, march_state.slabs + 1, slab.start, slab.span)),
        positive_definite=positive_definite,
        rested=history.halted,
        dashpots=way.dashpots,
    )
