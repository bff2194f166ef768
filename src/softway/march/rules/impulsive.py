"""Slab (time step) with contact nodes with inertia: the rules Paper and Impulse.

The slab is first solved with the rows closed at its start, and then again with the same operator and the touches and
releases that the solution requires, until there are no new ones.
"""

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from softway.arrays import Array
from softway.contact.impact_rule import Paper
from softway.contact.slab_motion.trajectory import Trajectory, bent
from softway.errors import NoConvergence
from softway.march.model_state import ModelState
from softway.march.results.friction_result import FrictionResult
from softway.march.results.slab_result import (
    Balances,
    SlabResult,
    contact_event,
    ordered_events,
    support_work,
    supports,
)
from softway.march.results.step import Event
from softway.march.rules.event_iteration import (
    EventIteration,
    with_new_events,
    with_new_facets,
    without_adhesion,
    without_events,
)
from softway.march.rules.slab_rule import Attempt, Solutions, require_frictionless, require_nodal
from softway.march.rules.split_elements import split_elements
from softway.march.rules.touch import InelasticImpact, NodalStop, Touch, VelocityJump, without_own_inertia
from softway.march.rules.velocity_jumps import velocity_jumps
from softway.march.step_control import require_slow
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import TimeWeight
from softway.solve.constraints.impact_multipliers import ImpactMultipliers, impact_multipliers
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.equations.slab_contact import FixedContact, InitialContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.cancellable import cancellable
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess, Solution, iterate
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory
from softway.tolerances import KEEP_FACETS_AFTER

PASSES = 60
"""Greatest number of solutions of a slab; one that needs more is tried again with half the length."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Impulsive:
    """Slabs with contact nodes with inertia: touches and releases are added until none is missing."""

    method: FixedPoint | Newton
    inertia: ImpactMultipliers
    touch: Touch

    def solve(self, model: Model, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt) -> Solutions:
        """Solutions of the slab, each more accurate than the previous one."""
        ahead = now.start.velocity + slab.span * now.acceleration
        given = model.prescribed(slab.end)
        guess = np.where(model.free, ahead, given)
        coasting = now.start.displacement + 0.5 * slab.span * (now.start.velocity + guess)
        coasting = coasting + bent(model.bends(slab.start, slab.end), slab.span)
        pairs = model.contacts.meet(now.start.displacement, coasting, slab.start, slab.end)
        require_slow(model, pairs, now.start.displacement, coasting, attempt.approach)
        current, facets = without_events(model, now, pairs, pairs.at(coasting), guess, slab.span), pairs
        method, iterations = cancellable(self.method, attempt.cancel, slab.start), 0
        for passes in range(1, PASSES + 1):
            found = velocity_jumps(model, current.rows, current.events, now.closed, self.touch, slab.span)
            system = _system(model, now, slab, current, found, given, self.touch)
            system = replace(system, effort=attempt.effort, positive_definite=attempt.positive_definite)
            closed = current.events.closed
            first = Guess(q=guess, impulse=np.zeros(len(closed)), active=closed, memory=memory)
            iterates = method.iterate(system, first)
            for solution in iterate(system, iterates, method.tolerance, method.limit):
                u1, memory = solution.end.displacement, solution.last.memory
                if passes == KEEP_FACETS_AFTER and pairs.fixed_rows is None:
                    facets = pairs.with_kept_facets(u1)
                revision = with_new_facets(model, now, facets, current, solution, slab.span) or with_new_events(
                    model, now, system, current, solution, self.inertia, self.touch
                )
                if revision is None and self.touch.balanced:
                    revision = without_adhesion(current, found)
                if revision is not None:
                    break
                if facets is not pairs and not pairs.apart(u1):
                    raise NoConvergence("nodes kept on their facets overlap other facets")
                work = passes, iterations + solution.iterations
                yield _outcome(now, slab, system, current, solution, found, self, pairs.found, work), memory
            else:
                return
            iterations += solution.iterations
            current, guess = revision, solution.last.q
        raise NoConvergence(f"the contact events were not found in {PASSES} solutions of the slab")


def inelastic_impact(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Impulsive:
    """Prepare the rule of mass-consistent jumps.

    Raises
    ------
    InputError
        If a contact has friction.
    """
    _require_nodes(model)
    inertia = impact_multipliers(model)
    return Impulsive(method=method, inertia=inertia, touch=InelasticImpact(inertia=inertia))


def nodal_stop(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Impulsive:
    """Prepare the literal rule of the paper.

    Raises
    ------
    InputError
        If a contact has friction, or elements that cannot be split are to be split.
    """
    _require_nodes(model)
    declared = cast(Paper, model.timing)
    split = split_elements(model) if declared.split == "triangle" else None
    inertia = impact_multipliers(model)
    touch = NodalStop(inertia=inertia, shared=without_own_inertia(model), approach=declared.approach, split=split)
    return Impulsive(method=method, inertia=inertia, touch=touch)


def _require_nodes(model: Model) -> None:
    require_frictionless(model, str(model.timing))
    require_nodal(model, str(model.timing))


def _system(
    model: Model,
    now: ModelState,
    slab: Slab,
    current: EventIteration,
    found: tuple[VelocityJump, ...],
    given: Array,
    touch: Touch,
) -> SlabEquations:
    """Equations of the slab with its contact events."""
    rows, events = current.rows, current.events
    balanced = found if touch.balanced else ()
    kicks = sum((j.impulse for j in balanced), np.zeros(len(events.closed)))
    impulses = current.impulse * slab.span + np.where(events.closed, 0.0, kicks)
    path = Trajectory(
        span=slab.span,
        start=now.start.displacement,
        velocity=now.start.velocity,
        massive=model.massive,
        free=model.free,
        rows=rows,
        events=events,
        jumps=tuple((j.instant, j.field) for j in found),
        bends=model.bends(slab.start, slab.end),
    )
    target = rows.tool_motion / slab.span - rows.normal_component(np.where(model.free, 0.0, given))
    return SlabEquations(
        model=model,
        start=now.start,
        weight=slab.weight,
        path=path,
        average=touch.average(slab.weight),
        contact=FixedContact(
            rows=rows,
            conditions=RowConditions(target=target, equal=events.closed, unilateral=np.zeros_like(events.closed)),
            initial=InitialContact(rows=rows, pressure=now.pressure, traction=now.traction),
        ),
        unbalanced=sum((j.field for j in found if not touch.balanced), np.zeros(model.shape)),
        impulses=rows.spread(impulses, model.shape),
        given=given,
    )


def _outcome(
    now: ModelState,
    slab: Slab,
    system: SlabEquations,
    current: EventIteration,
    solution: Solution,
    found: tuple[VelocityJump, ...],
    rule: Impulsive,
    pairs: int,
    work: tuple[int, int],
) -> SlabResult:
    model, h, events, q, rows = system.model, slab.span, current.events, solution.last.q, current.rows
    through = _through(current, solution, found, h, rule.touch)
    pull = rule.inertia.multiplier(rows, solution.end.force, events.closed)
    push = rows.spread(through / h, model.shape)
    support = supports(model, now, solution.end, q, push, h)
    moved = solution.end.displacement - now.start.displacement
    return SlabResult(
        system=system,
        solution=solution,
        rows=rows,
        velocity=q,
        acceleration=_acceleration(model, now, current, found, q, h),
        closed=events.closed,
        pressure=np.maximum(pull, 0.0),
        force=through / h,
        push=push,
        support=support,
        work=float(through @ rows.tool_motion) / h + support_work(model, system.path, support, moved, q),
        dissipation=rule.touch.loss(model, rows, events, found, (now.start.velocity, q), h),
        events=_events(now, slab, system, current, solution, found),
        pairs=pairs,
        passes=work[0],
        iterations=work[1],
        friction=FrictionResult.none(rows, model.shape),
        required=_required(rule.touch.balanced, bool(found or events.closed.any())),
    )


def _required(balanced: bool, touched: bool) -> Balances:
    """Balances that a slab has to keep: in free flight, weights may let the energy swing about its mean."""
    return Balances(energy="limited" if balanced and touched else "free", momentum=balanced)


def _acceleration(
    model: Model, now: ModelState, current: EventIteration, found: tuple[VelocityJump, ...], q: Array, h: float
) -> Array:
    """Slope (n, d) of the velocity at the end of the slab, without the jumps."""
    events, rows = current.events, current.rows
    jumped = sum((j.field for j in found), np.zeros(model.shape))
    slope = (q - now.start.velocity - jumped) / h
    with np.errstate(divide="ignore", invalid="ignore"):
        released = np.where(
            events.freedom > 0.0, (rows.normal_component(q) - rows.tool_motion / h) / (h * events.freedom), 0.0
        )
    kinked = np.where(events.kinked, released - rows.normal_component(slope), 0.0)
    return np.asarray(slope + rows.motion(kinked, events.kinked, model.free))


def _through(
    current: EventIteration, solution: Solution, found: tuple[VelocityJump, ...], span: float, touch: Touch
) -> Array:
    """Impulses (m,) of the contact rows over the slab [N s]."""
    closed = current.events.closed
    kicks = sum((j.impulse for j in found), np.zeros(len(closed)))
    kept = np.where(closed, solution.last.impulse, 0.0)
    return current.impulse * span + kept + np.where(closed & touch.balanced, 0.0, kicks)


def _events(
    now: ModelState,
    slab: Slab,
    system: SlabEquations,
    current: EventIteration,
    solution: Solution,
    found: tuple[VelocityJump, ...],
) -> tuple[Event, ...]:
    """Touches and releases in order; of a node that touches and releases at one instant the touch comes first."""
    model, events, end = system.model, current.events, solution.end.displacement
    after: Array = current.rows.normal_component(solution.last.q) - current.rows.tool_motion / slab.span
    out = [
        contact_event(
            model,
            now,
            slab,
            current.rows,
            end,
            int(r),
            "touch",
            j.instant,
            (float(j.speed[r]), 0.0),
            float(j.impulse[r]),
        )
        for j in found
        for r in np.flatnonzero(j.hits)
    ]
    out += [
        contact_event(
            model, now, slab, current.rows, end, int(r), "release", float(events.release[r]), (0.0, float(after[r]))
        )
        for r in np.flatnonzero(np.isfinite(events.release))
    ]
    return ordered_events(out, slab)
