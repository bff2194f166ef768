"""Result of a slab (time step) with contact nodes with inertia, from its solution and its contact events."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from softway.arrays import Array
from softway.marching.friction.impulse_slip import ImpulseSlip, impulse_friction, steady_push
from softway.marching.friction.stick_slip_events import stick_slip_events
from softway.marching.results.friction_result import FrictionResult
from softway.marching.results.slab_result import (
    Balances,
    SlabResult,
    contact_event,
    ordered_events,
    support_work,
    supports,
)
from softway.marching.results.step import Event
from softway.marching.rules.event_iteration import EventIteration
from softway.marching.rules.touch import Touch, VelocityJump
from softway.marching.state.model_state import ModelState
from softway.model.slab import Slab
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.iteration import Solution


@dataclass(frozen=True, slots=True, eq=False)
class ImpulsiveSolution:
    """A slab that was solved with the contact events ``current`` and the velocity jumps ``found``."""

    now: ModelState
    slab: Slab
    system: SlabEquations
    current: EventIteration
    solution: Solution
    found: tuple[VelocityJump, ...]
    touch: Touch


def impulsive_result(solved: ImpulsiveSolution, slip: ImpulseSlip, pairs: int, work: tuple[int, int]) -> SlabResult:
    """Forces, works and events of a slab, and ``work``: numbers of solutions and iterations."""
    now, current, solution, found, touch = solved.now, solved.current, solved.solution, solved.found, solved.touch
    model, h, events, q, rows = solved.system.model, solved.slab.span, current.events, solution.last.q, current.rows
    through, pull = _through(solved), steady_push(now, rows, solution, h)
    pressure = np.maximum(touch.inertia.multiplier(rows, solution.end.force - pull, events.closed), 0.0)
    friction = impulse_friction(model, now, rows, solution, slip, pressure)
    push = rows.spread(through / h, model.shape) + friction.push
    support = supports(model, now, solution.end, q, push, h)
    moved = solution.end.displacement - now.start.displacement
    tools = float(through @ rows.tool_motion) / h + friction.work
    return SlabResult(
        system=solved.system,
        solution=solution,
        rows=rows,
        velocity=q,
        acceleration=_acceleration(solved),
        closed=events.closed,
        pressure=pressure,
        force=through / h,
        push=push,
        support=support,
        work=tools + support_work(model, solved.system.path, support, moved, q),
        dissipation=touch.loss(model, rows, events, found, (now.start.velocity, q), h) + friction.dissipation,
        events=_events(solved, friction),
        pairs=pairs,
        passes=work[0],
        iterations=work[1],
        friction=friction,
        required=_required(touch.balanced, bool(found or events.closed.any())),
    )


def _required(balanced: bool, touched: bool) -> Balances:
    """Balances that a slab has to keep: in free flight, weights may let the energy swing about its mean."""
    return Balances(energy="limited" if balanced and touched else "free", momentum=balanced)


def _acceleration(solved: ImpulsiveSolution) -> Array:
    """Slope (n, d) of the velocity at the end of the slab, without the jumps."""
    model, events, rows = solved.system.model, solved.current.events, solved.current.rows
    q, h = solved.solution.last.q, solved.slab.span
    jumped = sum((j.field for j in solved.found), np.zeros(model.shape))
    slope = (q - solved.now.start.velocity - jumped) / h
    with np.errstate(divide="ignore", invalid="ignore"):
        released = np.where(
            events.freedom > 0.0, (rows.normal_component(q) - rows.tool_motion / h) / (h * events.freedom), 0.0
        )
    kinked = np.where(events.kinked, released - rows.normal_component(slope), 0.0)
    return np.asarray(slope + rows.motion(kinked, events.kinked, model.free))


def _through(solved: ImpulsiveSolution) -> Array:
    """Impulses (m,) of the contact rows over the slab [N s]."""
    closed = solved.current.events.closed
    known = known_impulses(solved.current, solved.found, solved.slab.span, solved.touch)
    return known + np.where(closed, solved.solution.last.impulse[: len(closed)], 0.0)


def known_impulses(current: EventIteration, found: tuple[VelocityJump, ...], span: float, touch: Touch) -> Array:
    """Impulses (m,) of the contact rows that are not multipliers of the slab: of releases and of jumps [N s]."""
    closed = current.events.closed
    kicks = sum((j.impulse for j in found), np.zeros(len(closed)))
    return current.impulse * span + np.where(closed & touch.balanced, 0.0, kicks)


def _events(solved: ImpulsiveSolution, friction: FrictionResult) -> tuple[Event, ...]:
    """Touches and releases in order; of a node that touches and releases at one instant the touch comes first."""
    model, now, slab, rows = solved.system.model, solved.now, solved.slab, solved.current.rows
    release, end = solved.current.events.release, solved.solution.end.displacement
    after: Array = rows.normal_component(solved.solution.last.q) - rows.tool_motion / slab.span
    told = partial(contact_event, model, now, slab, rows, end)
    out = [
        told(int(r), "touch", j.instant, (float(j.speed[r]), 0.0), float(j.impulse[r]))
        for j in solved.found
        for r in np.flatnonzero(j.hits)
    ]
    out += [
        told(int(r), "release", float(release[r]), (0.0, float(after[r]))) for r in np.flatnonzero(np.isfinite(release))
    ]
    out += stick_slip_events(model, now, slab, solved.solution, (rows, rows), friction)
    return ordered_events(out, slab)
