"""Slab (time step) with contact nodes with inertia: the rules Paper and Impulse.

The slab is first solved with the rows closed at its start, and then again with the same operator and the touches and
releases that the solution requires, until there are no new ones.
"""

from dataclasses import dataclass
from typing import cast

import numpy as np

from softway.arrays import Array
from softway.contact.contact_set import SlabContacts
from softway.contact.impact_rule import Paper
from softway.contact.slab_motion.trajectory import Trajectory, bent
from softway.errors import NoConvergence
from softway.marching.friction.impulse_slip import ImpulseSlip, closed_fractions, initial_slip, steady_push
from softway.marching.rules.event_iteration import (
    EventIteration,
    with_new_events,
    with_new_facets,
    without_adhesion,
    without_events,
)
from softway.marching.rules.impulsive_result import ImpulsiveSolution, impulsive_result, known_impulses
from softway.marching.rules.slab_rule import Attempt, Solutions, require_nodal
from softway.marching.rules.touch import (
    InelasticImpact,
    NodalStop,
    Touch,
    VelocityJump,
    split_elements,
    without_own_inertia,
)
from softway.marching.rules.velocity_jumps import velocity_jumps
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import EARLY, above, require_open, require_slow
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import TimeWeight
from softway.solve.constraints.impact_multipliers import ImpactMultipliers, impact_multipliers
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.equations.slab_contact import FixedContact, InitialContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.cancellable import cancellable
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess, iterate
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
        if above(slab.span, attempt.lowest):
            require_open(model, pairs, now, coasting, slab.span, EARLY * attempt.lowest)
        current, facets = without_events(model, now, pairs, pairs.at(coasting), guess, slab.span), pairs
        method, iterations = cancellable(self.method, attempt.cancel, slab.start), 0
        halts = np.zeros(len(now.closed), bool)
        for passes in range(1, PASSES + 1):
            found = velocity_jumps(model, current.rows, current.events, now.closed, self.touch, slab.span)
            slip = initial_slip(model, now, current.rows, current.events, guess, (slab.span, attempt.rested), halts)
            system = _system(model, now, slab, current, found, given, self.touch, slip, attempt)
            iterates = method.iterate(system, _first(system, guess, memory))
            for solution in iterate(system, iterates, method.tolerance, method.limit):
                u1, memory = solution.end.displacement, solution.last.memory
                if passes == KEEP_FACETS_AFTER and pairs.fixed_rows is None:
                    facets = pairs.with_kept_facets(u1)
                solved = ImpulsiveSolution(now, slab, system, current, solution, found, self.touch)
                revision = self._revision(model, solved, facets)
                stopped = slip.halted(current.rows, solution.last.q)
                if revision is None and stopped is not None:
                    revision, halts = current, halts | (slip.onward & ~stopped.onward)
                if revision is not None:
                    break
                if facets is not pairs and not pairs.apart(u1):
                    raise NoConvergence("nodes kept on their facets overlap other facets")
                work = passes, iterations + solution.iterations
                yield impulsive_result(solved, slip, pairs.found, work), memory
            else:
                return
            iterations += solution.iterations
            current, guess = revision, solution.last.q
        raise NoConvergence(f"the contact events were not found in {PASSES} solutions of the slab")

    def _revision(self, model: Model, solved: ImpulsiveSolution, facets: SlabContacts) -> EventIteration | None:
        """Contact events and rows that a solution requires in place of the current ones; None if there are none."""
        now, system, current, solution = solved.now, solved.system, solved.current, solved.solution
        span = system.path.span
        friction = steady_push(now, current.rows, solution, span)
        revision = with_new_facets(model, now, facets, current, solution, span) or with_new_events(
            model, now, system, current, solution, self.inertia, self.touch, friction
        )
        return without_adhesion(current, solved.found) if revision is None and self.touch.balanced else revision


def inelastic_impact(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Impulsive:
    """Prepare the rule of mass-consistent jumps.

    Raises
    ------
    InputError
        If unknowns move several components of contact nodes.
    """
    require_nodal(model, str(model.timing), hanging=True)
    inertia = impact_multipliers(model)
    return Impulsive(method=method, inertia=inertia, touch=InelasticImpact(inertia=inertia))


def nodal_stop(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Impulsive:
    """Prepare the literal rule of the paper.

    Raises
    ------
    InputError
        If unknowns move several components of contact nodes, or elements that cannot be split are to be split.
    """
    require_nodal(model, str(model.timing), hanging=True)
    declared = cast(Paper, model.timing)
    split = split_elements(model) if declared.split == "triangle" else None
    inertia = impact_multipliers(model)
    touch = NodalStop(inertia=inertia, shared=without_own_inertia(model), approach=declared.approach, split=split)
    return Impulsive(method=method, inertia=inertia, touch=touch)


def _system(
    model: Model,
    now: ModelState,
    slab: Slab,
    current: EventIteration,
    found: tuple[VelocityJump, ...],
    given: Array,
    touch: Touch,
    slip: ImpulseSlip,
    attempt: Attempt,
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
    return SlabEquations(
        model=model,
        start=now.start,
        weight=slab.weight,
        path=path,
        average=touch.average(slab.weight),
        contact=_contact(model, now, current, found, (given, touch), slip, attempt),
        unbalanced=sum((j.field for j in found if not touch.balanced), np.zeros(model.shape)),
        impulses=rows.spread(impulses, model.shape),
        given=given,
        effort=attempt.effort,
        positive_definite=attempt.positive_definite,
    )


def _contact(
    model: Model,
    now: ModelState,
    current: EventIteration,
    found: tuple[VelocityJump, ...],
    how: tuple[Array, Touch],
    slip: ImpulseSlip,
    attempt: Attempt,
) -> FixedContact:
    """Contact rows with their conditions; ``how`` are the prescribed velocities (n, d) at the end, and the touches."""
    given, touch = how
    closed, rows = current.events.closed, current.rows
    target = rows.tool_motion / slip.span - rows.normal_component(np.where(model.free, 0.0, given))
    known = known_impulses(current, found, slip.span, touch), closed_fractions(now.closed, current.events), given
    slipping = slip.conditions(model, now, rows, known, attempt.stick_at_any_force)
    conditions = RowConditions(
        target=target,
        equal=closed if slipping.frictionless else closed & rows.reachable(model.dofs),
        unilateral=np.zeros_like(closed),
        slipping=slipping,
    )
    initial = InitialContact(rows=rows, pressure=now.pressure, traction=now.traction)
    return FixedContact(rows=rows, conditions=conditions, initial=initial)


def _first(system: SlabEquations, q: Array, memory: OperatorMemory) -> Guess:
    """Initial values of a solution, without contact impulses."""
    conditions = system.contact.conditions
    k, none = conditions.slipping.shift.size, np.zeros(len(conditions.slipping.shift), bool)
    active = np.concatenate([conditions.equal, none])
    return Guess(q=q, impulse=np.zeros(len(conditions.equal) + k), active=active, memory=memory)
