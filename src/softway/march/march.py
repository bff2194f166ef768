"""The march: propose a slab, advance, judge, and hand out the step."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from softway.bodies.section import wave_speed
from softway.errors import InputError, NoConvergence, NumericsError
from softway.march.advance import Rule, advance, rule
from softway.march.begin import begin
from softway.march.ledger import audited, opening
from softway.march.outcome import Outcome
from softway.march.situation import Situation, joined, parted
from softway.march.step import Ledger, Report, Step
from softway.model import Model, build
from softway.scene import Scene, State
from softway.solve.fixed_point import FixedPoint
from softway.solve.frozen import Carry
from softway.solve.newton import Newton
from softway.solve.stability import require_stable, stable_step
from softway.time.slab import Slab
from softway.time.weight import EndPeaks, TimeWeight
from softway.units import Second

log = logging.getLogger("softway")
LEAST = 1e-4
"""Slabs are not cut below this fraction of the length asked for."""


def march(
    scene: Scene | Model,
    *,
    until: Second,
    step: Second | Literal["auto"] = "auto",
    weight: TimeWeight = EndPeaks(),
    method: FixedPoint | Newton = FixedPoint(),
    state: State | None = None,
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
        Fixed point or Newton.
    state
        Where to begin; by default the start of the scene.

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
    now = begin(model) if state is None else joined(model, state)
    span = proposed(model, step, weight, until - now.time)
    require_stable(model, now.start.displacement, weight, span)
    return _steps(rule(model, method, weight), now, until, span, weight)


def proposed(model: Model, step: Second | Literal["auto"], weight: TimeWeight, duration: float) -> float:
    """The slab length: the one asked for, or the crossing time of the shortest edge over sqrt(2), evenly divided.

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


def _steps(rules: Rule, now: Situation, until: float, span: float, weight: TimeWeight) -> Iterator[Step]:
    model = rules.model
    initial = ledger = opening(model, now)
    carry, current, before = Carry(), span, parted(model, now)
    while now.time < until - 1e-9 * span:
        length = min(current, until - now.time)
        length = until - now.time if until - now.time - length < LEAST * span else length
        after, out, carry, slab, rejections = _accepted(rules, now, length, LEAST * span, until, weight, carry)
        made = carry.factorisations
        ledger = audited(model, initial, ledger, now, out, after)
        state = parted(model, after)
        yield _step(model, now, before, state, slab, out, ledger, made, rejections)
        current = min(span, slab.span if rejections else 2.0 * slab.span)
        now, before = after, state


def _accepted(
    rules: Rule, now: Situation, length: float, least: float, until: float, weight: TimeWeight, carry: Carry
) -> tuple[Situation, Outcome, Carry, Slab, tuple[str, ...]]:
    """Advance by the length, or by half of it as often as it takes; a rejected slab leaves no trace but its reason.

    A slab that fails on an old operator is first tried again on a new one.
    """
    reasons: list[str] = []
    fresh = carry.frozen is None
    while length > least:
        end = until if abs(now.time + length - until) < 1e-9 * length else now.time + length
        slab = Slab(start=now.time, end=end, weight=weight)
        try:
            after, out, new = advance(rules, now, slab, carry)
            slow = out.iterations > 25 * out.passes
            return after, out, replace(new, stale=slow), slab, tuple(reasons)
        except NoConvergence as failure:
            reasons.append(f"h = {length:.3g} s: {failure}")
            log.info("slab at t = %.6g s rejected: %s", now.time, reasons[-1])
            length = 0.5 * length if fresh else length
            fresh, carry = True, replace(carry, stale=True)
    raise NumericsError(
        f"no slab converges, the last of {len(reasons)} tries with {reasons[-1]}",
        now.time,
        "a smaller step, a finer mesh where the cells are crushed, or Newton",
    )


def _step(
    model: Model,
    now: Situation,
    before: State,
    after: State,
    slab: Slab,
    out: Outcome,
    ledger: Ledger,
    made: int,
    rejections: tuple[str, ...],
) -> Step:
    end = out.solution.end
    inertia = model.mass @ ((out.velocity - now.start.velocity) / slab.span)
    contact = model.pairs.at(end.displacement).spread(out.force, model.shape)
    support = np.where(model.free, 0.0, inertia + end.mean_force - model.load - contact)
    return Step(
        before=before,
        after=after,
        slab=slab,
        ledger=ledger,
        events=out.events,
        reactions=model.split(support),
        report=Report(
            iterations=out.iterations,
            factorisations=made,
            passes=out.passes,
            rejections=rejections,
            scalars=dict(zip([p.name for p in model.parts], end.scalar.tolist(), strict=True)),
        ),
    )
