"""The next slab: tried at a length, judged, and tried again until one holds."""

import logging
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from softway.errors import Halts, NoConvergence, NumericsError, TooFast, Unbalanced, heed
from softway.march.advance import Rule, advance
from softway.march.breakaway import breakaway
from softway.march.certificate import balance, certified, violation
from softway.march.control import CRAWL
from softway.march.halt import halt
from softway.march.ledger import audited
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.march.standing import Pace, Standing
from softway.march.step import Certificate, Ledger
from softway.solve.balance import BOUND
from softway.solve.carry import Carry
from softway.solve.newton import Newton
from softway.time.slab import Slab
from softway.time.weight import EndPeaks

log = logging.getLogger(__name__)
PATIENCE = 1
"""Halvings after which an energy balance that the scalar cannot close is closed along the motion, for as long as it
takes."""
SETTLING = EndPeaks(theta=1.0)
"""Virtual time function of the slab after a stop: the forces at its end count for all of it, so that friction may turn
at once and what the stop has set vibrating comes to rest.  It has the operator of a slab longer by the root of 2."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Accepted:
    """A slab that holds its certificate, with the reasons of the tries that were dropped."""

    after: Situation
    out: Outcome
    carry: Carry
    slab: Slab
    ledger: Ledger
    certificate: Certificate
    rejections: tuple[str, ...]
    closed: bool
    halted: bool = False


def accepted(rules: Rule, stand: Standing, length: float, carry: Carry) -> Accepted:
    """Advance by the length, or by half of it as often as it takes; a rejected slab leaves no trace but its reason.

    A slab that fails on an old operator is first tried again on a new one; an energy balance that the scalar cannot
    close at half the length either is ``closed`` along the motion, and in the slabs after it.  A slab in which a body
    comes to rest is tried again up to there; the slab after one that ended so settles.  ``carry`` is that of the
    standing, with its operator if that is at hand.
    """
    now, until, settings = stand.situation, stand.settings.until, stand.settings
    least, crawls = settings.control.least * stand.pace.span, stand.pace.endured > settings.control.patience
    reasons: list[str] = []
    halted = False
    unbalanced = PATIENCE if stand.pace.closed else 0
    fresh = carry.origin is None
    while length > least and not (crawls and reasons):
        heed(rules.cancel, now.time)
        end = until if abs(now.time + length - until) < 1e-9 * length else now.time + length
        slab = Slab(start=now.time, end=end, weight=SETTLING if stand.pace.halted else settings.weight)
        try:
            found = _tried(rules, stand, slab, carry, unbalanced >= PATIENCE)
            return replace(found, rejections=tuple(reasons), halted=halted)
        except Halts as stop:
            length, halted = stop.share * length, True
            continue
        except (TooFast, Unbalanced) as failure:
            length = 0.5 * length
            unbalanced += isinstance(failure, Unbalanced)
            reasons.append(f"h = {slab.span:.3g} s: {failure}")
        except NoConvergence as failure:
            reasons.append(f"h = {slab.span:.3g} s: {failure}")
            length = 0.5 * length if fresh else length
            fresh, carry = True, carry.failed()
        log.info("slab at t = %.6g s rejected: %s", now.time, reasons[-1])
    raise NumericsError(_reason(stand, reasons, crawls), now.time, _remedy(rules))


def endured(before: Pace, span: float, rejections: int) -> float:
    """Rejections of late in slabs far shorter than asked for; four such slabs without any make up for one.

    Examples
    --------
    >>> pace, told = Pace(span=1.0, length=1.0), []
    >>> for span, rejections in [(0.5, 3), (0.009, 2), (0.009, 2), (0.009, 0), (0.02, 1)]:
    ...     pace = replace(pace, endured=endured(pace, span, rejections))
    ...     told.append(pace.endured)
    >>> told
    [0.0, 2.0, 4.0, 3.75, 0.0]
    """
    return max(0.0, before.endured + (rejections or -0.25)) if span <= CRAWL * before.span else 0.0


def _reason(stand: Standing, reasons: list[str], crawls: bool) -> str:
    """Why a march ends."""
    if not reasons:
        return "no slab holds, bodies come to rest without end"
    if crawls:
        count = stand.pace.endured + len(reasons)
        return f"{count:.0f} rejections among slabs shorter than {CRAWL:g} of the step, the last with {reasons[-1]}"
    return f"no slab holds, the last of {len(reasons)} tries with {reasons[-1]}"


def _remedy(rules: Rule) -> str:
    """What may help where no slab holds."""
    found = ["a smaller step", "a finer mesh where the cells are crushed"]
    if isinstance(rules.method, Newton):
        found.append("the fixed point, which goes farther than Newton alone")
    if rules.model.encounters.watchers:  # mean gaps
        found.append("the method NodeToSurface where coarse facets lean on each other")
    return ", or ".join(found)


def _tried(rules: Rule, stand: Standing, slab: Slab, carry: Carry, closed: bool) -> Accepted:
    """One slab with its audit: the first solution that holds its certificate.

    Raises
    ------
    NoConvergence, Halts
        If none does, or a body comes to rest inside.
    """
    model, now, approach = rules.model, stand.situation, stand.settings.control.approach
    broken: str | None = "there is no solution"
    for after, out, new in advance(rules, now, slab, carry, approach, closed):
        if slab.weight != SETTLING:
            halt(model, now, out, slab.span)
            breakaway(model, now, out, partial(_held, rules, now, slab, new, approach, closed))
        ledger = audited(model, stand.account, now, out, after)
        certificate = certified(model, out, after, stand.account, ledger, balance(model, now, out, after))
        broken = violation(model, now, out, after, ledger, certificate)
        if broken is None:
            return Accepted(
                after=after,
                out=out,
                carry=new.after(out.iterations // out.passes),
                slab=slab,
                ledger=ledger,
                certificate=certificate,
                rejections=(),
                closed=closed and bool((np.abs(out.solution.end.scalar) >= BOUND).any()),
            )
        log.debug("after %d iterations %s: more of them", out.iterations, broken)
    raise NoConvergence(f"certificate: {broken}")


def _held(rules: Rule, now: Situation, slab: Slab, carry: Carry, approach: float, closed: bool) -> Outcome:
    """The slab with all that rests held at any friction."""
    return next(advance(rules, now, slab, carry, approach, closed, held=True))[1]
