"""One slab of the Energy rule: contact nodes without inertia, in constrained equilibrium at the slab's end."""

import numpy as np

from softway.contact.located import LocatedMean
from softway.contact.path import Path, passage
from softway.kernels.impact import fading
from softway.march.outcome import Outcome, contact_event
from softway.march.situation import Situation
from softway.march.step import Event
from softway.model import Model
from softway.solve.driver import Solution, drive
from softway.solve.fixed_point import FixedPoint
from softway.solve.frozen import Carry
from softway.solve.newton import Newton
from softway.solve.normal import Rows
from softway.solve.system import SlabSystem
from softway.time.slab import Slab
from softway.time.weight import EndPeaks, moments
from softway.typing import BoolArray


def solve_massless(
    model: Model, now: Situation, slab: Slab, carry: Carry, method: FixedPoint | Newton, located: LocatedMean | None
) -> tuple[Outcome, Carry]:
    """Solve the slab; the contact rows are inequalities on the gap at its end."""
    h, start = slab.span, now.start
    rows = model.pairs.at(start.displacement)
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
    still = np.zeros(model.shape)
    target = -2.0 * rows.gap(path.end(still)) / h
    conditions = Rows(target=target, equal=way.closed, unilateral=rows.reachable(model.free))
    system = SlabSystem(
        model=model,
        start=start,
        weight=slab.weight,
        path=path,
        rows=conditions,
        balanced=located is None and slab.weight == EndPeaks(),
        located=located,
        pairs=None if model.pairs.flat else model.pairs,
    )
    rate = start.velocity + h * now.acceleration
    guess = np.where(model.massive[:, None], rate, 2.0 * rate)
    iterates = method.iterate(system, guess, carry, now.pressure * h * moments(slab.weight)[1])
    solution = drive(system, iterates, method.tolerance, method.limit)
    return _outcome(model, now, slab, system, solution), solution.last.carry


def _outcome(model: Model, now: Situation, slab: Slab, system: SlabSystem, solution: Solution) -> Outcome:
    h = slab.span
    q, end = solution.last.q, solution.end
    rows = model.pairs.at(end.displacement)
    massive = model.massive[:, None]
    velocity = np.where(massive, q, 0.5 * q)
    closed = solution.last.impulse > 0.0
    pressure = solution.last.impulse / (h * moments(slab.weight)[1])
    force = rows.shares((end.mean_force - model.load) * ~massive, closed | now.closed, model.free)
    if system.located is not None:
        events = _branched(model, now, slab, system.located, solution)
    else:
        events = _touches(model, now, slab, solution, closed) + _releases(model, now, slab, solution, closed)
    return Outcome(
        system=system,
        solution=solution,
        velocity=velocity,
        acceleration=(velocity - now.start.velocity) / h,
        closed=closed,
        pressure=pressure,
        force=force,
        dissipation=0.0,
        events=tuple(sorted(events, key=lambda e: (round((e.time - slab.start) / slab.span, 9), e.contact, e.node))),
        passes=1,
        iterations=solution.iterations,
    )


def _touches(model: Model, now: Situation, slab: Slab, solution: Solution, closed: BoolArray) -> list[Event]:
    """Touches at the root of the gap along the free motion, exact in free flight."""
    h, gap = slab.span, model.pairs.gap(now.start.displacement)
    before = 0.5 * solution.predicted
    tau = fading(gap, np.minimum(gap + h * before, -1e-300))
    return [
        contact_event(
            model, now, slab, solution.end.displacement, int(r), "touch", float(tau[r]), (float(before[r]), 0.0)
        )
        for r in np.flatnonzero(closed & ~now.closed)
    ]


def _releases(model: Model, now: Situation, slab: Slab, solution: Solution, closed: BoolArray) -> list[Event]:
    """Releases at the root of the reaction, continued into tension by the compliance of the row."""
    rows, h = model.pairs.at(solution.end.displacement), slab.span
    left = np.flatnonzero(now.closed & ~closed)
    frozen = solution.last.carry.frozen
    if not len(left) or frozen is None:
        return []
    give = np.diag(frozen.delassus(left))
    tension = model.pairs.gap(solution.end.displacement)[left] * 2.0 / (h * give) / (h * moments(slab.weight)[1])
    tau = fading(now.pressure[left], -np.maximum(tension, 1e-300))
    after = 0.5 * rows.along(solution.last.q)
    return [
        contact_event(model, now, slab, solution.end.displacement, int(r), "release", float(t), (0.0, float(after[r])))
        for r, t in zip(left, tau, strict=True)
    ]


def _branched(model: Model, now: Situation, slab: Slab, located: LocatedMean, solution: Solution) -> list[Event]:
    """The located touches and releases."""
    branches = located.branches(
        now.start.displacement, solution.end.displacement, now.closed, solution.last.impulse > 0.0
    )
    speed = 0.5 * model.candidates.along(solution.last.q)
    before = model.candidates.along(now.start.velocity)
    return [
        contact_event(
            model,
            now,
            slab,
            solution.end.displacement,
            b.row,
            "touch" if b.closes else "release",
            b.instant,
            (float(before[b.row]), 0.0) if b.closes else (0.0, float(speed[b.row])),
        )
        for b in branches
    ]
