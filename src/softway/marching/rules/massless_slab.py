"""Slab (time step) with massless contact nodes: its equations, and the result from their solution."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_set import SlabContacts
from softway.contact.slab_motion.trajectory import Trajectory, bent, contact_events
from softway.errors import InputError
from softway.marching.friction.stick_slip_events import stick_slip_events
from softway.marching.results.friction_result import friction_result, slipping
from softway.marching.results.slab_result import (
    Balances,
    EnergyBalance,
    SlabResult,
    ordered_events,
    support_work,
    supports,
)
from softway.marching.results.step import Event
from softway.marching.rules.slab_rule import Attempt
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks, TimeWeight, moments
from softway.solve.constraints.normal_active_set import RowConditions, rounded
from softway.solve.equations.closure import Closure
from softway.solve.equations.mean_force import MeanForce
from softway.solve.equations.slab_contact import FixedContact, InitialContact, SlabContact, TurningContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.iteration import Solution


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactForces:
    """Normal forces over a slab: of the ``rows`` (m,), on the ``nodes`` (n, d) [N]; ``work`` of driven tools [J]."""

    rows: Array
    nodes: Array
    work: float


class MasslessContact(Protocol):
    """Treatment of massless contact nodes in a slab: mean force, closure, contact forces and events."""

    def average(self, slab: Slab) -> MeanForce:
        """Average of the internal force over a slab."""
        ...

    def closure(self, model: Model, now: ModelState, slab: Slab, attempt: Attempt) -> Closure:
        """Closure of the energy balance of a slab."""
        ...

    def energy_balance(self, model: Model, slab: Slab) -> EnergyBalance:
        """Requirement on the energy balance of a slab."""
        ...

    def forces(
        self, model: Model, now: ModelState, system: SlabEquations, solution: Solution, pressure: Array
    ) -> ContactForces:
        """Normal forces over a slab, with the forces ``pressure`` (m,) at its end [N]."""
        ...

    def events(
        self, model: Model, now: ModelState, slab: Slab, system: SlabEquations, solution: Solution, closed: BoolArray
    ) -> list[Event]:
        """Touches and releases inside a slab; ``closed`` (m,) are the rows in contact at its end."""
        ...


def require_end_points(model: Model, weight: TimeWeight) -> None:
    """Refuse time weights that do not fit contact nodes in equilibrium at the ends of slabs.

    Raises
    ------
    InputError
        If there are massless nodes and the weight is not the default.
    """
    if weight != EndPeaks() and not model.space.every(model.massive):
        raise InputError(
            "time.weight",
            f"{weight} with the Energy rule, whose contact nodes are in equilibrium at the slab's ends",
            "EndPeaks with theta = 0.5, or with inertia and without friction the rule Impulse",
        )


def equations(
    how: MasslessContact,
    model: Model,
    now: ModelState,
    slab: Slab,
    pairs: SlabContacts,
    attempt: Attempt,
) -> SlabEquations:
    """Equations of the slab."""
    start = now.start
    rows = pairs.start(start.displacement)
    path = Trajectory(
        span=slab.span,
        start=start.displacement,
        velocity=start.velocity,
        massive=model.massive,
        free=model.free,
        rows=rows,
        events=contact_events(np.zeros(len(rows.node), bool)),
        bends=model.bends(slab.start, slab.end),
    )
    last = model.prescribed(slab.end)
    given = last if not model.driven else np.where(model.massive[:, None], last, model.prescribed(slab.start) + last)
    return SlabEquations(
        model=model,
        start=start,
        weight=slab.weight,
        path=path,
        average=how.average(slab),
        closure=how.closure(model, now, slab, attempt),
        contact=_contact(model, now, slab, pairs, path, given, attempt),
        given=given,
        effort=attempt.effort,
        positive_definite=attempt.positive_definite,
        follower=attempt.follower,
        dashpots=attempt.dashpots,
    )


def _contact(
    model: Model,
    now: ModelState,
    slab: Slab,
    pairs: SlabContacts,
    path: Trajectory,
    given: Array,
    attempt: Attempt,
) -> SlabContact:
    """Contact rows with their conditions: inequalities on the gap at the end of the slab."""
    h, rows, fixed = slab.span, path.rows, pairs.fixed_rows is not None
    initial = InitialContact(rows=now.force_rows(rows), pressure=now.pressure, traction=now.traction)
    conditions = RowConditions(
        target=np.where(rows.near, -2.0 * rows.gap(path.end(given)) / h, 0.0) if fixed else np.zeros(len(rows.node)),
        equal=path.events.closed,
        unilateral=rows.reachable(model.dofs),
        slipping=slipping(model, now, slab, rows, attempt.stick_at_any_force),
        rounding=2.0 / h * rounded(model.extent(now.start.displacement)),
    )
    if fixed:
        return FixedContact(rows=rows, conditions=conditions, initial=initial)
    return TurningContact(pairs=pairs, facets=pairs, conditions=conditions, initial=initial)


def slab_result(
    how: MasslessContact,
    model: Model,
    now: ModelState,
    slab: Slab,
    system: SlabEquations,
    solution: Solution,
    pairs: int,
    velocity: Array,
) -> SlabResult:
    """Forces, works and events of a solved slab; ``velocity`` (n, d) is that at its end."""
    h, end = slab.span, solution.end
    rows, first = end.rows, system.contact.initial.rows
    pressure = solution.last.impulse[: len(rows.node)] / (h * moments(slab.weight)[1])
    normal = how.forces(model, now, system, solution, pressure)
    friction = friction_result(model, now, slab, solution, (first, rows), end.scalar)
    push, tools = normal.nodes + friction.push, normal.work + friction.work
    events = how.events(model, now, slab, system, solution, solution.last.impulse[: len(rows.node)] > 0.0)
    events += stick_slip_events(model, now, slab, solution, (first, rows), friction)
    support = supports(model, now, end, velocity, push, h)
    moved = end.displacement - now.start.displacement
    return SlabResult(
        system=system,
        solution=solution,
        rows=rows,
        velocity=velocity,
        acceleration=(velocity - now.start.velocity) * (model.inert / h),  # without inertia, speed may jump
        closed=pressure > 0.0,
        pressure=pressure,
        force=normal.rows,
        push=push,
        support=support,
        work=tools + (support_work(model, system.path, support, moved, velocity) if model.driven else 0.0),
        dissipation=friction.dissipation,
        events=ordered_events(events, slab),
        pairs=pairs,
        iterations=solution.iterations,
        required=Balances(energy=how.energy_balance(model, slab)),
        handed_on=rows if model.contacts.paired else None,
        friction=friction,
    )


def end_velocity(model: Model, slab: Slab, q: Array) -> Array:
    """Velocity (n, d) at the end of a slab [m/s]; of massless nodes without driven support the mean of the slab."""
    heavy = model.massive[:, None]
    velocity = np.where(heavy, q, 0.5 * q)
    if not model.driven:
        return velocity
    given = velocity - model.supported(velocity) + model.prescribed(slab.end)
    return np.where(heavy, velocity, given)


def with_prescribed(model: Model, now: ModelState, slab: Slab, coasting: Array) -> Array:
    """Displacement (n, d) without contact at the end of a slab, with the exact one of supported components [m]."""
    if not model.driven:
        return coasting
    start, end = model.prescribed(slab.start), model.prescribed(slab.end)
    moved = slab.span * (0.5 * (start + end)) + bent(model.bends(slab.start, slab.end), slab.span)
    return coasting - model.supported(coasting) + model.supported(now.start.displacement + moved)


def closed_energy_balance(model: Model, slab: Slab) -> EnergyBalance:
    """Requirement on the energy balance of a slab whose mean force or closure keeps the energy."""
    if slab.weight != EndPeaks():
        return "free"
    return "closed" if model.inert else "bounded"
