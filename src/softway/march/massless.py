"""One slab of the Energy rule: contact nodes without inertia, in constrained equilibrium at the slab's end."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from softway.contact.candidates import Candidates
from softway.contact.encounters import Pairs
from softway.contact.located import LocatedMean
from softway.contact.path import Path, passage
from softway.kernels.dense import shared
from softway.kernels.impact import fading
from softway.march.control import require_slow
from softway.march.outcome import Outcome, contact_event, supports
from softway.march.rub import Rub, first_impulses, rub, slipping
from softway.march.situation import Situation
from softway.march.step import Event
from softway.march.transitions import transitions
from softway.model import Model
from softway.solve.carry import Carry
from softway.solve.driver import Solution, solutions
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.solve.normal import Rows, delassus, rounded
from softway.solve.system import SlabSystem
from softway.solve.watched import Watched
from softway.time.slab import Slab
from softway.time.weight import EndPeaks, moments
from softway.typing import Array, BoolArray


def solve_massless(
    model: Model,
    now: Situation,
    slab: Slab,
    carry: Carry,
    method: FixedPoint | Newton | Watched,
    located: LocatedMean | None,
    approach: float,
    fallback: bool,
    held: bool = False,
) -> Iterator[tuple[Outcome, Carry]]:
    """Solutions of the slab, each closer than the one before; contact rows are inequalities on the gap at its end."""
    h, start = slab.span, now.start
    rate = start.velocity + h * now.acceleration
    coasting = start.displacement + h * np.where(model.massive[:, None], 0.5 * (start.velocity + rate), rate)
    pairs = model.encounters.meet(start.displacement, coasting, slab.start, slab.end)
    require_slow(model, pairs, coasting, approach)
    system = replace(equations(model, now, slab, pairs, located, held), fallback=fallback)
    guess = np.where(model.free, np.where(model.massive[:, None], rate, 2.0 * rate), system.given)
    impulse, active = first_impulses(now, slab, system.path.rows)
    iterates = method.iterate(system, guess, carry, impulse, active)
    for solution in solutions(system, iterates, method.tolerance, method.limit):
        yield outcome(model, now, slab, system, solution, pairs.found), solution.last.carry


def equations(
    model: Model, now: Situation, slab: Slab, pairs: Pairs, located: LocatedMean | None, held: bool = False
) -> SlabSystem:
    """The equations of the slab."""
    h, start = slab.span, now.start
    rows = pairs.start(start.displacement)
    way = passage(np.zeros(len(rows.node), bool))
    path = Path(
        span=h,
        start=start.displacement,
        velocity=start.velocity,
        massive=model.massive,
        free=model.free,
        rows=rows,
        way=way,
    )
    fixed = model.encounters.fixed
    last = model.prescribed(slab.end)
    given = last if not model.driven else np.where(model.massive[:, None], last, model.prescribed(slab.start) + last)
    target = -2.0 * rows.gap(path.end(given)) / h if fixed else np.zeros(len(rows.node))
    return SlabSystem(
        model=model,
        start=start,
        weight=slab.weight,
        path=path,
        rows=Rows(
            target=target,
            equal=way.closed,
            unilateral=rows.reachable(model.free),
            slipping=slipping(model, now, slab, rows, held),
            rounding=2.0 / h * rounded(model.points + start.displacement),
        ),
        balanced=located is None and (slab.weight == EndPeaks() or now.sliding is not None),
        located=located,
        pairs=None if fixed else pairs,
        searched=None if fixed else pairs,
        given=given,
        carrying=now.carrying(rows),
        pressure=now.pressure,
        traction=now.traction,
    )


def outcome(
    model: Model, now: Situation, slab: Slab, system: SlabSystem, solution: Solution, pairs: int, v: Array | None = None
) -> Outcome:
    """What a solution says of forces, works and events of the slab; q tells the velocity v where none is given."""
    h, q, end = slab.span, solution.last.q, solution.end
    rows = end.near or system.path.rows
    velocity = np.where(model.massive[:, None], q, 0.5 * q) if v is None else v
    pressure = solution.last.impulse[: len(rows.node)] / (h * moments(slab.weight)[1])
    closed = pressure > 0.0
    first, a = system.first, end.scalar[model.part_of[rows.node]]
    rubbed, tools = rub(now, slab, solution, (first, rows), a), 0.0
    if system.located is not None:
        light = ~model.massive[:, None]
        force = rows.shares((end.mean_force - model.load) * light, closed | now.closed, model.free)
        push = rows.spread(force, model.shape)
    else:
        old, new = (0.5 - a) * now.pressure, (0.5 + a) * pressure
        force = old + new
        push, tools = _spread((first, rows), old, new, model.shape), float(old @ first.drive + new @ rows.drive)
    if rubbed is not None:
        push, tools = push + rubbed.push, tools + rubbed.work
    support = supports(model, now, end, velocity, push, h)
    return Outcome(
        system=system,
        solution=solution,
        rows=rows,
        velocity=velocity,
        acceleration=(velocity - now.start.velocity) * (model.massive.any() / h),  # without inertia, speed may jump
        closed=closed,
        pressure=pressure,
        force=force,
        push=push,
        support=support,
        work=tools + (float(np.sum(support * (end.displacement - now.start.displacement))) if model.driven else 0.0),
        dissipation=0.0 if rubbed is None else rubbed.dissipation,
        events=_events(model, now, slab, system, solution, rubbed),
        pairs=pairs,
        passes=1,
        iterations=solution.iterations,
        rub=rubbed,
    )


def _spread(rows: tuple[Candidates, Candidates], old: Array, new: Array, shape: tuple[int, int]) -> Array:
    """Nodal forces (n, d) of the rows at both ends."""
    first, last = rows
    if first is last:
        return last.spread(old + new, shape)
    return first.spread(old, shape) + last.spread(new, shape)


def _events(
    model: Model, now: Situation, slab: Slab, system: SlabSystem, solution: Solution, rubbed: Rub | None
) -> tuple[Event, ...]:
    """Touches and releases, places that stick and slip, in order."""
    first = system.first
    rows = solution.end.near or system.path.rows
    closed = solution.last.impulse[: len(rows.node)] > 0.0
    if system.located is not None:
        events = _branched(model, now, slab, rows, system.located, solution)
    else:
        events = _touches(model, now, slab, system, solution, closed)
        events += _releases(model, now, slab, rows, solution, closed)
    if rubbed is not None:
        events += transitions(model, now, slab, solution, (first, rows), rubbed)
    return tuple(sorted(events, key=lambda e: (round((e.time - slab.start) / slab.span, 9), e.contact, e.node)))


def _touches(
    model: Model, now: Situation, slab: Slab, system: SlabSystem, solution: Solution, closed: BoolArray
) -> list[Event]:
    """Touches at the root of the gap along the free motion, exact in free flight.

    A row that faced nothing at the start, or that its free motion there does not close, is followed back from where
    its nodes come to without contact, or else from the end.  What only its neighbours bring to touch does so at the
    end, with the mean speed of its way.
    """
    h, rows, end = slab.span, system.path.rows, solution.end
    last = end.near or rows
    fresh = closed & ~now.closed
    if not fresh.any():
        return []
    gap = np.where(rows.near, rows.gap(now.start.displacement), 0.0)
    speed = 0.5 * solution.predicted[: len(last.node)] - last.drive / h
    unseen = ~rows.near | (gap + h * speed >= 0.0)
    coasting = now.start.displacement + h * now.start.velocity
    for seen in (last, rows if system.pairs is None else system.pairs.at(coasting)):
        first = np.where(seen.near, seen.gap(now.start.displacement), 0.0) + seen.drive
        rate = seen.along(now.start.velocity) - seen.drive / h
        closes = unseen & (first > 0.0) & (first + h * rate < 0.0)
        gap, speed = np.where(closes, first, gap), np.where(closes, rate, speed)
    speed = np.where(gap + h * speed < 0.0, speed, -gap / h)
    tau = fading(gap, np.minimum(gap + h * speed, -1e-300))
    return [
        contact_event(model, now, slab, last, end.displacement, int(r), "touch", float(tau[r]), (float(speed[r]), 0.0))
        for r in np.flatnonzero(fresh)
    ]


def _releases(
    model: Model, now: Situation, slab: Slab, rows: Candidates, solution: Solution, closed: BoolArray
) -> list[Event]:
    """Releases at the root of the reaction, continued into tension by the compliance of the rows that let go."""
    h, end = slab.span, solution.end.displacement
    left = np.flatnonzero(now.closed & ~closed & rows.near)
    frozen = solution.last.carry.frozen
    if not len(left) or frozen is None:
        return []
    give = delassus(frozen, frozen.coefficients(rows, solution.last.system.model.free).part(left))
    tension = shared(give, rows.gap(end)[left]) * 2.0 / h / (h * moments(slab.weight)[1])
    tau = fading(now.pressure[left], -np.maximum(tension, 1e-300))
    after = 0.5 * rows.along(solution.last.q) - rows.drive / h
    return [
        contact_event(model, now, slab, rows, end, int(r), "release", float(t), (0.0, float(after[r])))
        for r, t in zip(left, tau, strict=True)
    ]


def _branched(
    model: Model, now: Situation, slab: Slab, rows: Candidates, located: LocatedMean, solution: Solution
) -> list[Event]:
    """The located touches and releases."""
    branches = located.branches(
        now.start.displacement, solution.end.displacement, now.closed, solution.last.impulse > 0.0
    )
    speed = 0.5 * rows.along(solution.last.q)
    before = rows.along(now.start.velocity)
    return [
        contact_event(
            model,
            now,
            slab,
            rows,
            solution.end.displacement,
            b.row,
            "touch" if b.closes else "release",
            b.instant,
            (float(before[b.row]), 0.0) if b.closes else (0.0, float(speed[b.row])),
        )
        for b in branches
    ]
