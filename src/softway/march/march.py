"""The march: propose a slab, advance, judge, and hand out the step."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from softway.bodies.section import wave_speed
from softway.errors import Cancel, InputError
from softway.march.advance import Method, Rule, rule
from softway.march.begin import begin
from softway.march.control import StepControl, crushing, may_grow
from softway.march.ledger import booked, opened, opening
from softway.march.situation import Situation, joined, parted
from softway.march.standing import Pace, Settings, Standing
from softway.march.step import Report, Step
from softway.march.tries import SETTLING, Accepted, accepted, endured
from softway.model import Model, build
from softway.scene import Scene, State
from softway.solve.balance import SLIGHT
from softway.solve.explicit import Explicit
from softway.solve.fixed_point import FixedPoint
from softway.solve.stability import require_stable, stable_step
from softway.time.weight import EndPeaks, TimeWeight
from softway.units import Second

log = logging.getLogger(__name__)
STRAINED = 0.2
"""Fraction of the length asked for below which a great scalar asks for no shorter slab."""


def march(
    scene: Scene | Model,
    *,
    until: Second,
    step: Second | Literal["auto"] = "auto",
    weight: TimeWeight = EndPeaks(),
    method: Method = FixedPoint(),
    state: State | Standing | None = None,
    control: StepControl = StepControl(),
    cancel: Cancel | None = None,
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
        Where to begin: a situation, or where another march stood after a step, ``step.standing``; by default the start
        of the scene.
    control
        Limits of a slab; one that breaks them is tried again shorter.
    cancel
        Asked at every iteration, from the first equilibrium on, whether the caller wants no more.

    Raises
    ------
    InputError
        Before the first step: a step beyond the stability limit, a start inside an obstacle.
    NumericsError
        When a slab fails at every length that was tried; steps handed out before stay valid.
    Cancelled
        When ``cancel`` says so; steps handed out before stay valid.

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
    settings = Settings(until=until, step=step, weight=weight, method=method, control=control)
    stand = _begun(model, settings, state, cancel)
    prepared = replace(rule(model, method, weight), cancel=cancel)
    stepping = method if isinstance(method, Explicit) else weight
    if not stand.slabs and not (isinstance(stepping, Explicit) and step == "auto"):  # then a share of the limit
        require_stable(model, stand.situation.start.displacement, stepping, stand.pace.span)
    return _steps(prepared, stand)


def _begun(model: Model, settings: Settings, state: State | Standing | None, cancel: Cancel | None) -> Standing:
    """Where the march stands at its start."""
    if isinstance(state, Standing) and state.settings == settings:
        return state.fitting(model)
    past = 0.0 if state is None else state.situation.time if isinstance(state, Standing) else state.time
    span = proposed(model, settings.step, settings.weight, settings.until - past, settings.method)
    if isinstance(state, Standing):
        return state.fitting(model).asked(settings, span)
    now = begin(model, span, cancel) if state is None else joined(model, state)
    return Standing(
        settings=settings,
        situation=now,
        account=opened(opening(model, now)),
        pace=Pace(span=span, length=span),
    )


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


def _steps(rules: Rule, stand: Standing) -> Iterator[Step]:
    model, settings, span = rules.model, stand.settings, stand.pace.span
    until, least = settings.until, settings.control.least * span
    carry, before = stand.carry, parted(model, stand.situation)
    watch = crushing(model, rules.method)
    while stand.situation.time < until - 1e-9 * span:
        time = stand.situation.time
        length = min(stand.pace.length, until - time)
        length = until - time if until - time - length < least else length
        found = accepted(rules, stand, length, carry)
        if carry.choice is None and found.carry.choice is not None:
            log.info("operator %s: %s", found.carry.choice.operator, found.carry.choice.reason)
        following = _next(model, settings.control, span, stand.situation, found)
        following = min(following, span * watch.share(found.after.start.displacement))
        stand = Standing(
            settings=settings,
            situation=found.after,
            account=booked(stand.account, found.ledger),
            pace=Pace(
                span=span,
                length=following,
                closed=found.closed,
                halted=found.halted,
                endured=endured(stand.pace, found.slab.span, len(found.rejections)),
            ),
            carry=found.carry.bare(),
            slabs=stand.slabs + 1,
        )
        step = _step(model, before, found, stand)
        log.debug("slab %d to t = %.6g s: %d iterations", stand.slabs, found.after.time, found.out.iterations)
        yield step
        before, carry = step.after, found.carry


def _next(model: Model, control: StepControl, span: float, before: Situation, found: Accepted) -> float:
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


def _step(model: Model, before: State, found: Accepted, stand: Standing) -> Step:
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
        standing=stand,
    )
