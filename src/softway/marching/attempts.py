"""Attempts at the next slab (time step), with cutbacks until a slab is accepted."""

import logging
from dataclasses import dataclass, replace
from functools import partial
from typing import cast

import numpy as np

from softway.errors import Halts, NoConvergence, NumericsError, TooFast, Unbalanced, heed
from softway.marching.audit.certificate import balance, certify, violation
from softway.marching.audit.ledger import audit
from softway.marching.friction.slip_end import slip_end
from softway.marching.friction.slip_start import slip_start
from softway.marching.results.slab_result import SlabResult
from softway.marching.results.step import Certificate, Ledger
from softway.marching.results.trying import watched
from softway.marching.rules.slab_rule import Attempt, SlabRule
from softway.marching.slab.endings import crushed, reason, remedy, touching
from softway.marching.slab.slab_step import Stepper, advance
from softway.marching.start.knots import slab_end
from softway.marching.start.ladder import before_event, fault
from softway.marching.start.slab_length import proposed
from softway.marching.state.march_state import MarchState, StepHistory
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import CRAWL, ENDLESS, above
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.effort import Effort
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory

log = logging.getLogger(__name__)
PATIENCE = 1
"""Cutbacks after which an energy balance that the scalar cannot close is closed along the motion."""
STEPS = 24
"""Steps of the contact problems for each iterate above which an attempt is given up; accepted slabs take up to 10."""
DAMPED = EndPeaks(theta=1.0)
"""Virtual time function of the slab after a stop: the forces at its end act over the whole slab.  Friction may reverse
at once, and vibrations caused by the stop are damped.  The operator is that of a slab longer by the root of 2."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AcceptedSlab:
    """Accepted slab, with the reasons of rejected attempts."""

    after: ModelState
    out: SlabResult
    memory: OperatorMemory
    slab: Slab
    ledger: Ledger
    certificate: Certificate
    rejections: tuple[str, ...]
    energy_along_motion: bool
    halted: bool = False


def accept_slab(stepper: Stepper, march_state: MarchState, length: float, memory: OperatorMemory) -> AcceptedSlab:
    """Find the next accepted slab, with cutbacks to half its length; ``memory`` has an operator if available.

    A slab that fails with an old operator is first tried again with a new one, one in which Newton's method does not
    converge by the fixed point, and one with an indefinite operator by a positive definite one, and then by Newton's
    method.  If the scalar cannot
    close the energy balance at half the length either, it is closed along the motion, also in the following slabs.  A
    slab inside which a body comes to rest is tried again with its end at that instant; the slab after it is damped.

    Raises
    ------
    NumericsError
        If no slab was accepted.
    """
    now, settings = march_state.state, march_state.settings
    history = march_state.step_history
    least, crawls = settings.control.least * history.span, history.recent_rejections > settings.control.patience
    reasons: list[str] = []
    halted = positive_definite = False
    fresh, first, unbalanced = memory.origin is None, stepper, PATIENCE if history.energy_along_motion else 0
    while length > least and not (crawls and reasons):
        heed(stepper.cancel, now.time)
        end = slab_end(stepper.ends, settings.until, now.time, length)
        slab = Slab(start=now.time, end=end, weight=_weight(stepper.model, march_state))
        try:
            attempt = _attempt(stepper, march_state, slab, unbalanced >= PATIENCE, positive_definite)
            found = _on_rung(stepper, march_state, slab, memory, attempt)
            return replace(found, rejections=tuple(reasons), halted=halted)
        except _Dropped as failure:
            length, memory = failure.length, failure.memory
            reasons.append(f"h = {slab.span:.3g} s: {failure}")
        except Halts as stop:
            length, halted = stop.fraction * length, True
            continue
        except (TooFast, Unbalanced) as failure:
            length = 0.5 * length
            unbalanced += isinstance(failure, Unbalanced) and not above(slab.span, history.span)
            reasons.append(f"h = {slab.span:.3g} s: {failure}")
        except NoConvergence as failure:
            reasons.append(f"h = {slab.span:.3g} s: {failure}")
            rule, positive_definite = _other_way(first, stepper.rule, attempt)
            length = 0.5 * length if fresh and rule is first.rule and not positive_definite else length
            stepper, fresh, memory = replace(first, rule=rule), True, memory.failed()
        log.info("slab at t = %.6g s rejected: %s", now.time, reasons[-1])
    told = reason(march_state, reasons, crawls) + touching(stepper.model, now) + crushed(stepper.model, now)
    raise NumericsError(told, now.time, _remedy(stepper, march_state))


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


def _weight(model: Model, march_state: MarchState) -> TimeWeight:
    """Virtual time function of the next slab: after a stop that of a damped slab if there are massless nodes."""
    damped = march_state.step_history.halted and not model.space.every(model.massive)
    return DAMPED if damped else march_state.settings.weight


def _attempt(
    stepper: Stepper, march_state: MarchState, slab: Slab, energy_along_motion: bool, positive_definite: bool
) -> Attempt:
    """Attempt at the next slab."""
    settings, history = march_state.settings, march_state.step_history
    return Attempt(
        approach=settings.control.approach,
        lowest=np.inf if settings.tolerance is None else history.span,
        energy_along_motion=energy_along_motion,
        cancel=stepper.cancel,
        effort=_effort(stepper, march_state.slabs + 1, slab),
        positive_definite=positive_definite,
        rested=history.halted,
    )


def _remedy(stepper: Stepper, march_state: MarchState) -> str:
    """Possible remedies if no time step was accepted."""
    settings = march_state.settings
    usual = proposed(stepper.model, "auto", settings.weight, settings.until, settings.method)
    return remedy(stepper, march_state, usual)


def _effort(stepper: Stepper, number: int, slab: Slab) -> Effort:
    """Counted work of an attempt at the slab of this number."""
    return Effort(STEPS, watched(stepper.trying, number, slab.start, slab.span))


def require_progress(stepper: Stepper, march_state: MarchState, length: float) -> None:
    """End a march whose slabs stay far below the requested length, with more than ``ENDLESS`` of them ahead.

    Raises
    ------
    NumericsError
        With the length, the contacts and the last rejection, once the patience is used up.
    """
    history, now, control = march_state.step_history, march_state.state, march_state.settings.control
    left = (march_state.settings.until - now.time) / length
    if history.recent_rejections <= control.patience or length > CRAWL * history.span or left <= ENDLESS:
        return
    last = f"; the last rejection: {history.last_rejection}" if history.last_rejection else ""
    raise NumericsError(
        f"the time step stays at h = {length:.3g} s of the {history.span:.3g} s given, {left:.1g} more of them lead to "
        f"the end{last}{touching(stepper.model, now)}{crushed(stepper.model, now)}",
        now.time,
        f"{_remedy(stepper, march_state)}, or to go on regardless time.control.patience = {10 * control.patience:.0f}",
    )


def recent_rejections(before: StepHistory, span: float, rejections: int, left: float = 0.0) -> float:
    """Number of recent rejections in slabs far below the requested length; four such slabs without any cancel one.

    A slab after which more than ``ENDLESS`` of its length are ``left`` counts as a rejection.

    Examples
    --------
    >>> history, found = StepHistory(span=1.0, length=1.0), []
    >>> for span, rejections in [(0.5, 3), (0.009, 2), (0.009, 2), (0.009, 0), (0.02, 1)]:
    ...     history = replace(history, recent_rejections=recent_rejections(history, span, rejections))
    ...     found.append(history.recent_rejections)
    >>> found
    [0.0, 2.0, 4.0, 3.75, 0.0]
    >>> recent_rejections(history, 1e-7, 0, left=9e6)
    1.0
    """
    more = rejections or (1.0 if left > ENDLESS else -0.25)
    return max(0.0, before.recent_rejections + more) if span <= CRAWL * before.span else 0.0


class _Dropped(Exception):
    """Slab above the lowest rung that is dropped; ``length`` [s] and ``memory`` are those of the next attempt."""

    def __init__(self, reason: str, length: float, memory: OperatorMemory) -> None:
        self.length, self.memory = length, memory
        super().__init__(reason)


def _on_rung(
    stepper: Stepper, march_state: MarchState, slab: Slab, memory: OperatorMemory, attempt: Attempt
) -> AcceptedSlab:
    """Solve and audit one slab; above the lowest rung of a ladder it must be smooth, and nothing may happen in it.

    Raises
    ------
    _Dropped
        If a slab above the lowest rung has an event or too great an error, or is not solved.
    NoConvergence, Halts
        As for :func:`_tried`, on the lowest rung.
    """
    settings, history, now = march_state.settings, march_state.step_history, march_state.state
    if settings.tolerance is None or not above(slab.span, history.span):
        return _tried(stepper, march_state, slab, memory, attempt)
    try:
        found = _tried(stepper, march_state, slab, memory, attempt)
    except Halts as stop:
        raise _Dropped(str(stop), 0.5 * slab.span, memory) from stop
    except NoConvergence as failure:
        raise _Dropped(str(failure), 0.5 * slab.span, memory.failed()) from failure
    dropped = fault(stepper.model, settings, history, now, slab, found.out, found.after)
    if dropped:
        kept = replace(found.memory, stale=False)  # what happened in the slab, not the operator, made it expensive
        raise _Dropped(dropped, before_event(slab, history.span, found.out), kept)
    return found


def _tried(
    stepper: Stepper, march_state: MarchState, slab: Slab, memory: OperatorMemory, attempt: Attempt
) -> AcceptedSlab:
    """Solve and audit one slab: the first solution with a valid certificate.

    Raises
    ------
    NoConvergence, Halts
        If there is none, or a body comes to rest inside the slab.
    """
    model, now = stepper.model, march_state.state
    broken: str | None = "no solution"
    for after, out, new in advance(stepper, now, slab, memory, attempt):
        if slab.weight != DAMPED and not attempt.rested:
            slip_end(model, now, out, slab.span)
            slip_start(model, now, out, partial(_stuck, stepper, now, slab, new, attempt))
        ledger = audit(model, march_state.account, now, out, after)
        certificate = certify(model, out, after, march_state.account, ledger, balance(model, now, out, after))
        broken = violation(model, now, out, after, ledger, certificate)
        if broken is None:
            return AcceptedSlab(
                after=after,
                out=out,
                memory=_used(stepper, march_state, new, out.iterations // out.passes),
                slab=slab,
                ledger=ledger,
                certificate=certificate,
                rejections=(),
                energy_along_motion=attempt.energy_along_motion and out.solution.end.bounded,
            )
        log.debug("after %d iterations: %s; iterating further", out.iterations, broken)
    raise NoConvergence(f"certificate: {broken}")


def _used(stepper: Stepper, march_state: MarchState, memory: OperatorMemory, iterations: int) -> OperatorMemory:
    """Memory after a slab with a number of iterations; the operators of a ladder are not worn if they are exact."""
    after = memory.after(iterations)
    exact = march_state.settings.tolerance is not None and stepper.model.linear
    return replace(after, stale=memory.stale) if exact else after


def _stuck(stepper: Stepper, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt) -> SlabResult:
    """Slab with sticking at any force of all rows at rest."""
    return next(advance(stepper, now, slab, memory, replace(attempt, stick_at_any_force=True)))[1]
