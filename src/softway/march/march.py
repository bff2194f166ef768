"""The march: propose a slab, advance, judge, and hand out the step."""

import logging
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.bodies.section import wave_speed
from softway.errors import Halts, InputError, NoConvergence, NumericsError, TooFast, Unbalanced
from softway.march.advance import Method, Rule, advance, rule
from softway.march.begin import begin
from softway.march.breakaway import breakaway
from softway.march.certificate import certified, violation
from softway.march.control import StepControl, crushing, may_grow
from softway.march.halt import halt
from softway.march.ledger import audited, opening
from softway.march.outcome import Outcome
from softway.march.situation import Situation, joined, parted
from softway.march.step import Certificate, Ledger, Report, Step
from softway.model import Model, build
from softway.scene import Scene, State
from softway.solve.balance import BOUND, SLIGHT
from softway.solve.carry import Carry
from softway.solve.explicit import Explicit
from softway.solve.fixed_point import FixedPoint
from softway.solve.stability import require_stable, stable_step
from softway.time.slab import Slab
from softway.time.weight import EndPeaks, TimeWeight
from softway.units import Second

log = logging.getLogger("softway")
PATIENCE = 1
"""Halvings after which an energy balance that the scalar cannot close is closed along the motion, for as long as it
takes."""
SETTLING = EndPeaks(theta=1.0)
"""Virtual time function of the slab after a stop: the forces at its end count for all of it, so that friction may turn
at once and what the stop has set vibrating comes to rest.  It has the operator of a slab longer by the root of 2."""
STRAINED = 0.2
"""Fraction of the length asked for below which a great scalar asks for no shorter slab."""


def march(
    scene: Scene | Model,
    *,
    until: Second,
    step: Second | Literal["auto"] = "auto",
    weight: TimeWeight = EndPeaks(),
    method: Method = FixedPoint(),
    state: State | None = None,
    control: StepControl = StepControl(),
) -> Iterator[Step]:
    """Accepted slabs from the start, or from ``state``, to the time ``until``.

    Parameters
    ----------
    scene
        What moves; a built model is taken as it is.
    until
        End time [s].
    step
        Slab length [s], shortened so that the slabs divide the duration evenly; ``auto`` is the time in which a wave
        crosses the shortest edge, over the square root of 2: there the leading dispersion of a consistent mass and of
        the end peaks cancel (docs/theory/time.md).
    weight
        Virtual time function.
    method
        Fixed point, Newton, or explicit.
    state
        Where to begin; by default the start of the scene.
    control
        Limits of a slab; one that breaks them is tried again shorter.

    Raises
    ------
    InputError
        Before the first step: a step beyond the stability limit, a start inside an obstacle.
    NumericsError
        When a slab fails at every length that was tried; steps handed out before stay valid.

    Examples
    --------
    >>> import softway as sw
    >>> bar = sw.Solid(mesh=sw.Interval(length=1.0, cells=2), material=sw.LinearElastic(E=1.0), density=1.0,
    ...                velocity=sw.Uniform(value=1.0))
    >>> wall = sw.Tool(shape=sw.HalfSpace(point=1.25, normal=-1.0))
    >>> scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    >>> steps = list(march(scene, until=4.0, step=0.05))
    >>> abs(steps[-1].ledger.energy_error) < 1e-12
    True
    """
    model = scene if isinstance(scene, Model) else build(scene)
    span = proposed(model, step, weight, until - (0.0 if state is None else state.time), method)
    now = begin(model, span) if state is None else joined(model, state)
    prepared = rule(model, method, weight)
    require_stable(model, now.start.displacement, method if isinstance(method, Explicit) else weight, span)
    return _steps(prepared, now, until, span, weight, control)


def proposed(
    model: Model,
    step: Second | Literal["auto"],
    weight: TimeWeight,
    duration: float,
    method: Method = FixedPoint(),
) -> float:
    """The slab length: the one asked for, or the crossing time of the shortest edge over sqrt(2), evenly divided.

    Central differences take a share of their stability limit.

    Raises
    ------
    InputError
        If the duration or the step is not positive.
    """
    if duration <= 0.0:
        raise InputError("time.end", f"the march would last {duration:g} s", "an end after the start")
    if step != "auto":
        if not 0.0 < step < np.inf:
            raise InputError("time.step", f"{step:g} s", "a positive time, or 'auto'")
        return evenly(duration, step)
    if isinstance(method, Explicit):
        return evenly(duration, method.safety * stable_step(model, model.displacement, method))
    crossing = min(p.mesh.edge() / wave_speed(p.internal.material, p.density, p.internal.section) for p in model.parts)
    bound = 0.9 * stable_step(model, model.displacement, weight)
    return evenly(duration, min(crossing / np.sqrt(2.0), bound))


def evenly(duration: float, step: float) -> float:
    """The greatest length up to ``step`` that divides the duration evenly; equal slabs share one operator.

    Examples
    --------
    >>> evenly(1.0, 0.3)
    0.25
    """
    return float(duration / np.ceil(duration / step - 1e-9))


def _steps(
    rules: Rule, now: Situation, until: float, span: float, weight: TimeWeight, control: StepControl
) -> Iterator[Step]:
    model = rules.model
    initial = ledger = opening(model, now)
    carry, current, before, closed = Carry(), span, parted(model, now), False
    halted, watch = False, crushing(model, rules.method)
    while now.time < until - 1e-9 * span:
        length = min(current, until - now.time)
        length = until - now.time if until - now.time - length < control.least * span else length
        found = _accepted(rules, now, (initial, ledger), length, span, until, weight, carry, control, closed, halted)
        if carry.choice is None and found.carry.choice is not None:
            log.info("operator %s: %s", found.carry.choice.operator, found.carry.choice.reason)
        step = _step(model, now, before, found)
        yield step
        current, halted = _next(model, control, span, now, found), found.halted
        current = min(current, span * watch.share(found.after.start.displacement))
        now, before, ledger, carry, closed = found.after, step.after, found.ledger, found.carry, found.closed


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Accepted:
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


def _next(model: Model, control: StepControl, span: float, before: Situation, found: _Accepted) -> float:
    """Length of the next slab."""
    length = found.slab.span
    if found.halted:
        return span * float(np.sqrt(0.5))
    if found.slab.weight == SETTLING:
        return span
    end = found.out.solution.end
    strained = ((np.abs(end.scalar) > control.scalar) & (end.share > SLIGHT)).any() and not found.out.events
    if strained and length > STRAINED * span:
        log.info("next slab after t = %.6g s halved: the scalar of the energy balance is great", found.after.time)
        return 0.5 * length
    if found.rejections or length >= span:
        return min(span, length)
    return min(span, 2.0 * length) if may_grow(model, control, length, before, found.after) else length


def _accepted(
    rules: Rule,
    now: Situation,
    ledgers: tuple[Ledger, Ledger],
    length: float,
    span: float,
    until: float,
    weight: TimeWeight,
    carry: Carry,
    control: StepControl,
    closed: bool,
    settling: bool,
) -> _Accepted:
    """Advance by the length, or by half of it as often as it takes; a rejected slab leaves no trace but its reason.

    A slab that fails on an old operator is first tried again on a new one; an energy balance that the scalar cannot
    close at half the length either is ``closed`` along the motion, and in the slabs after it.  A slab in which a body
    comes to rest is tried again up to there; the slab after one that ended so is ``settling``.
    """
    reasons: list[str] = []
    halted = False
    unbalanced = PATIENCE if closed else 0
    fresh = carry.frozen is None
    while length > control.least * span:
        end = until if abs(now.time + length - until) < 1e-9 * length else now.time + length
        slab = Slab(start=now.time, end=end, weight=SETTLING if settling else weight)
        try:
            found = _tried(rules, now, ledgers, slab, carry, control.approach, unbalanced >= PATIENCE)
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
            fresh, carry = True, replace(carry, stale=True)
        log.info("slab at t = %.6g s rejected: %s", now.time, reasons[-1])
    last = reasons[-1] if reasons else f"h = {length:.3g} s: a body comes to rest again and again"
    remedy = "a smaller step, a finer mesh where the cells are crushed, or Newton"
    raise NumericsError(f"no slab holds, the last of {len(reasons)} tries with {last}", now.time, remedy)


def _tried(
    rules: Rule,
    now: Situation,
    ledgers: tuple[Ledger, Ledger],
    slab: Slab,
    carry: Carry,
    approach: float,
    closed: bool,
) -> _Accepted:
    """One slab with its audit.

    Raises
    ------
    NoConvergence, Halts
        If it violates its certificate, or a body comes to rest inside.
    """
    after, out, new = advance(rules, now, slab, carry, approach, closed)
    if slab.weight != SETTLING:
        halt(rules.model, now, out, slab.span)
        breakaway(rules.model, now, out, lambda: advance(rules, now, slab, new, approach, closed, held=True)[1])
    ledger = audited(rules.model, *ledgers, now, out, after)
    certificate = certified(rules.model, now, out, after, ledgers[1], ledger)
    broken = violation(rules.model, now, out, after, ledger, certificate)
    if broken is not None:
        raise NoConvergence(f"certificate: {broken}")
    return _Accepted(
        after=after,
        out=out,
        carry=new.after(out.iterations // out.passes),
        slab=slab,
        ledger=ledger,
        certificate=certificate,
        rejections=(),
        closed=closed and bool((np.abs(out.solution.end.scalar) >= BOUND).any()),
    )


def _step(model: Model, now: Situation, before: State, found: _Accepted) -> Step:
    out = found.out
    names = [p.name for p in model.parts]
    return Step(
        before=before,
        after=parted(model, found.after),
        slab=found.slab,
        ledger=found.ledger,
        certificate=found.certificate,
        events=out.events,
        reactions=model.split(out.support),
        report=Report(
            iterations=out.iterations,
            pairs=out.pairs,
            factorisations=found.carry.factorisations,
            passes=out.passes,
            contraction=out.solution.contraction,
            rejections=found.rejections,
            scalars=dict(zip(names, out.solution.end.scalar.tolist(), strict=True)),
        ),
    )
