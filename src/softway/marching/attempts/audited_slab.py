"""One attempt at a slab (time step): its solution, audited."""

import logging
from dataclasses import dataclass, replace
from functools import partial

from softway.bodies.assembled.dashpots import Dashpots
from softway.errors import Halts, NoConvergence
from softway.marching.audit.certificate import balance, certify, violation
from softway.marching.audit.ledger import audit
from softway.marching.friction.slip_end import slip_end
from softway.marching.friction.slip_start import slip_start
from softway.marching.results.slab_result import SlabResult
from softway.marching.results.step import Certificate, Ledger
from softway.marching.rules.slab_rule import Attempt
from softway.marching.slab.slab_step import Stepper, advance
from softway.marching.start.ladder import before_event, fault
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import above
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks
from softway.solve.operators.operator_memory import OperatorMemory

log = logging.getLogger(__name__)
DAMPED = EndPeaks(theta=1.0)
"""Virtual time function of the slab after a stop: the forces at its end act over the whole slab.  Friction may reverse
at once, and vibrations caused by the stop are damped.  The operator is that of a slab longer by the root of 2."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AcceptedSlab:
    """Accepted slab, with the reasons of rejected attempts, and the dashpots in it."""

    after: ModelState
    out: SlabResult
    memory: OperatorMemory
    slab: Slab
    ledger: Ledger
    certificate: Certificate
    rejections: tuple[str, ...]
    energy_along_motion: bool
    halted: bool = False
    dashpots: Dashpots | None = None


class Dropped(Exception):
    """Slab above the lowest rung that is dropped; ``length`` [s] and ``memory`` are those of the next attempt."""

    def __init__(self, reason: str, length: float, memory: OperatorMemory) -> None:
        self.length, self.memory = length, memory
        super().__init__(reason)


def audited_slab(
    stepper: Stepper, march_state: MarchState, slab: Slab, memory: OperatorMemory, attempt: Attempt
) -> AcceptedSlab:
    """Solve and audit one slab; above the lowest rung of a ladder it must be smooth, and nothing may happen in it.

    Raises
    ------
    Dropped
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
        raise Dropped(str(stop), 0.5 * slab.span, memory) from stop
    except NoConvergence as failure:
        raise Dropped(str(failure), 0.5 * slab.span, memory.failed()) from failure
    dropped = fault(stepper.model, settings, history, now, slab, found.out, found.after)
    if dropped:
        kept = replace(found.memory, stale=False)  # what happened in the slab, not the operator, made it expensive
        raise Dropped(dropped, before_event(slab, history.span, found.out), kept)
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
