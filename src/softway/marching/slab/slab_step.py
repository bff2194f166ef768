"""One slab (time step): from a state to the next, by the contact rule of the model."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled import material_states
from softway.errors import Cancel, InputError, Unbalanced
from softway.heat.coupled.solid_temperature import temperatures_of
from softway.marching.results.slab_result import SlabResult, ordered_events
from softway.marching.results.step import Event
from softway.marching.results.tie_breaks import tie_breaks
from softway.marching.results.trying import TryWatch
from softway.marching.rules.declared import slab_rule
from softway.marching.rules.slab_rule import Attempt, Method, SlabRule
from softway.marching.slab.rigid.with_rigid import coupled_slabs
from softway.marching.state.model_state import ModelState
from softway.mechanisms.members.stops import StopEvent
from softway.model.field import in_slab
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import TimeWeight
from softway.solve.equations.slab_values import SlabStart
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stepper:
    """Model with its contact rule, prepared for a march by a method; ``cancel`` may cancel the march, ``trying`` is
    called after every iterate.

    ``second`` is the rule by another method for slabs in which the method does not converge; by default they are
    shortened.  ``ends`` are instants at which slabs end, see :func:`~softway.marching.start.knots.slab_ends`.
    ``dashpots`` are allowed where massless nodes have no equilibrium, or another remedy goes before them.
    """

    model: Model
    method: Method
    rule: SlabRule
    second: SlabRule | None = None
    ends: tuple[float, ...] = ()
    cancel: Cancel | None = None
    trying: TryWatch | None = None
    dashpots: bool = True


def stepper(
    model: Model, method: Method, weight: TimeWeight, cancel: Cancel | None = None, trying: TryWatch | None = None
) -> Stepper:
    """Prepare a model for a march.

    Raises
    ------
    InputError
        If the contact rule does not fit the material, the method or the time weight.
    """
    if model.rigid is not None and isinstance(method, Explicit):
        raise InputError("solver", "Explicit with rigid bodies", "FixedPoint or Newton")
    rule, second = slab_rule(model, method, weight), None
    match method:
        case Newton(handover=True):
            second = slab_rule(model, FixedPoint(tolerance=method.tolerance), weight)
        case FixedPoint(handover=True):
            second = slab_rule(model, Newton(tolerance=method.tolerance, limit=2 * method.limit), weight)
    return Stepper(model=model, method=method, rule=rule, second=second, cancel=cancel, trying=trying)


def advance(
    stepper: Stepper, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt
) -> Iterator[tuple[ModelState, SlabResult, OperatorMemory]]:
    """States at the end of the slab, each more accurate than the previous one; the initial state is not changed.

    Raises
    ------
    NoConvergence, TooFast, Unbalanced
        If the method does not converge, the slab is too long for the approach, or the energy balance cannot be closed.
    """
    model = stepper.model.during(now.start.states, slab.span).bonded(now.start.fields).pushed(slab.start, slab.end)
    if model.companions:
        start = now.start
        ends = slab.start, slab.end
        fields = in_slab(model.companions, ends, model.parts, start.displacement, start.fields)
        model = replace(model, companions=fields)
        for _, temperature in temperatures_of(fields):
            model = model if temperature.solids is None else replace(model, parts=tuple(temperature.solids))
    if model.rigid is None:
        for out, after in stepper.rule.solve(model, now, slab, memory, attempt):
            yield _state(slab, out), _with_breaks(model, now, slab, out), after
        return
    for found in coupled_slabs(stepper.rule, model, now, slab, memory, attempt):
        events = ordered_events((*found.out.events, *(_told(model, event) for event in found.events)), slab)
        out = _with_breaks(model, now, slab, replace(found.out, events=events))
        yield replace(_state(slab, found.out), rigid=found.rigid), out, found.memory


def _with_breaks(model: Model, now: ModelState, slab: Slab, out: SlabResult) -> SlabResult:
    """Result with the breaks of ties among its events."""
    found = tie_breaks(model, now, slab, out)
    return replace(out, events=ordered_events((*out.events, *found), slab)) if found else out


def _told(model: Model, event: StopEvent) -> Event:
    """Event of a stop between rigid bodies: it has a name, but no node and no place of its own."""
    return Event(
        time=event.time,
        contact=event.stop,
        kind=event.kind,
        node=-1,
        position=np.full(model.shape[1], np.nan),
        velocity_before=event.velocity_before,
        velocity_after=event.velocity_after,
        impulse=event.impulse,
    )


def _state(slab: Slab, out: SlabResult) -> ModelState:
    """State at the end of a solved slab.

    Raises
    ------
    Unbalanced
        If the energy balance cannot be closed.
    """
    if out.solution.end.clipped:
        raise Unbalanced("the scalar that closes the energy balance is outside [-1/2, 1/2]")
    return ModelState(
        time=slab.end,
        start=_committed(out),
        acceleration=out.acceleration,
        closed=out.closed,
        pressure=out.pressure,
        traction=out.friction.traction,
        sliding=out.friction.sliding,
        rows=out.handed_on,
        slip=out.friction.slip,
        span=slab.span,
    )


def _committed(out: SlabResult) -> SlabStart:
    """Initial values of the next slab."""
    model, end = out.system.model, out.solution.end
    states = material_states.committed(model.parts, end.displacement)
    for k, temperature in temperatures_of(model.companions):
        states = temperature.warmed(states, end.fields[k].end)
    of_fields: Array | float = sum(f.end.energy for f in end.fields)
    return SlabStart(
        displacement=end.displacement,
        velocity=out.velocity,
        force=end.force,
        energy=material_states.stored_energy(model.parts, states, end.energy - of_fields) + of_fields,
        states=states,
        viscous=material_states.stored_viscous_force(model.parts, states),
        fields=tuple(f.end for f in end.fields),
    )
