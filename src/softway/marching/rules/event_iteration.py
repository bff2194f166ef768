"""Iteration over the contact events of a slab (time step), for nodes with inertia.

Nodes that end inside the obstacle get a touch, closed rows with a reaction in tension at the end a release, both at
instants inside the slab.  A row touches once and is released once in a slab; one that would touch again stays closed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import SlabContacts
from softway.contact.slab_motion.trajectory import ContactEvents, contact_events
from softway.kernels.geometry.event_times import crossing, fading
from softway.marching.rules.touch import Touch, VelocityJump
from softway.marching.rules.velocity_jumps import at, instants
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.constraints.impact_multipliers import ImpactMultipliers
from softway.solve.constraints.impact_sequence import ImpactSequence, contact_order
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.iteration import Solution

SEPARATES = 1e-9
"""Velocity of separation, relative to the greatest speed of a touch in the slab, beyond which rows do not touch."""
APART = 1e-9
"""Gap at the start of a slab, relative to the coordinates, beyond which a row does not touch."""

SHALLOW = 1e-3
"""Depth behind a plane, relative to the edges at the node, that a node may be lifted by without a touch before."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EventIteration:
    """Contact events of a slab found so far.

    ``rows`` are the contact rows at the end of the slab, ``events`` their events, ``reaction`` (m,) the forces at the
    start of their closed phases; the rows ``may_not_release`` (m,) stay closed.
    """

    rows: ContactRows
    events: ContactEvents
    reaction: Array
    may_not_release: BoolArray

    @property
    def impulse(self) -> Array:
        """Impulse divided by h (m,), for a force that fades linearly from the start of contact to the release [N]."""
        begin = np.nan_to_num(self.events.touch)
        length = np.where(np.isfinite(self.events.release), np.nan_to_num(self.events.release) - begin, 0.0)
        return 0.5 * np.maximum(self.reaction, 0.0) * length


def without_events(
    model: Model, now: ModelState, pairs: SlabContacts, rows: ContactRows, guess: Array, span: float
) -> EventIteration:
    """Contact events without touches; closed rows without contact at the start (node slid off a facet) are released.

    ``guess`` (n, d) is the velocity expected at the end of the slab of length ``span``.
    """
    first, u0 = pairs.start(now.start.displacement), now.start.displacement
    extent = model.extent(u0)
    there = within_reach(model, rows, now, guess, span)
    gone = now.closed & ~(rows.near & first.near & there & (first.gap(u0) <= APART * extent))
    events = contact_events(now.closed & ~gone)
    events = replace(events, release=np.where(gone, 0.0, events.release))
    return EventIteration(
        rows=rows, events=events, reaction=now.pressure, may_not_release=np.zeros(len(now.closed), bool)
    )


def with_new_events(
    model: Model,
    now: ModelState,
    system: SlabEquations,
    current: EventIteration,
    found: Solution,
    inertia: ImpactMultipliers,
    touch: Touch,
    friction: Array | float = 0.0,
) -> EventIteration | None:
    """Add the touches and releases that the solution requires; None if there are none.

    ``friction`` (n, d) are the nodal forces of friction, which closed rows may have to balance.
    """
    rows, events, end = current.rows, current.events, found.end
    gap = rows.gap(end.displacement)
    below = ~events.closed & (gap < -rounding(model, rows, end.displacement)) & rows.reachable(model.dofs)
    below &= within_reach(model, rows, now, found.last.q, system.path.span)
    if below.any():
        return _touching(model, now, system, current, found.last.q, below, touch)
    pull = inertia.multiplier(rows, end.force - friction, events.closed)
    floor = 1e-11 * max(model.space.greatest(end.force), float(np.abs(pull).max(initial=0.0)))
    tense = events.closed & ~current.may_not_release & (pull < -floor)
    if tense.any():
        return _releasing(model, system, current, found.last.q, tense, pull, inertia, friction)
    return None


def without_adhesion(current: EventIteration, jumps: Sequence[VelocityJump]) -> EventIteration | None:
    """Remove the touches whose rows separate when they come, because of other touches; None if there are none.

    A jump would pull these rows back, and give energy to the bodies.
    """
    greatest = max((float(np.abs(j.speed).max()) for j in jumps), default=0.0)
    leaving = np.zeros(len(current.events.closed), bool)
    for jump in jumps:
        leaving |= jump.hits & (jump.speed > SEPARATES * greatest)
    if not leaving.any():
        return None
    events = current.events
    touch, release = np.where(leaving, np.nan, events.touch), np.where(leaving, np.nan, events.release)
    return replace(current, events=replace(events, closed=events.closed & ~leaving, touch=touch, release=release))


def with_new_facets(
    model: Model, now: ModelState, pairs: SlabContacts, current: EventIteration, found: Solution, span: float
) -> EventIteration | None:
    """Update the contact rows to those at the end of the solution; None if they have converged.

    Closed rows whose new facet is not within reach are released: their nodes went over an edge.
    """
    if pairs.fixed_rows is not None:
        return None
    u1 = found.end.displacement
    rows = pairs.at(u1)
    compared = rows.near & current.rows.near
    compared = compared & current.events.kinked
    off = rows.gap(u1)[compared] - current.rows.gap(u1)[compared]
    fresh = rows.near & ~current.rows.near & (rows.gap(u1) < 0.0)
    if not fresh.any() and np.abs(off).max(initial=0.0) <= 8.0 * rounding(model, rows, u1):
        return None
    events = current.events
    lost = events.closed & rows.near & ~within_reach(model, rows, now, found.last.q, span)
    events = replace(
        events,
        closed=events.closed & ~lost,
        touch=np.where(lost, np.nan, events.touch),
        release=np.where(lost & now.closed, 0.0, events.release),
    )
    return replace(current, rows=rows, events=events)


def within_reach(model: Model, rows: ContactRows, now: ModelState, end: Array, span: float) -> BoolArray:
    """Rows (m,) whose node is not so deep behind the plane of its facet at the start that no motion brings it there.

    Such a plane is that of a facet round the corner: the node is beyond its edges, and outside of the body.  The
    velocities at the start and at the ``end`` (n, d) of the slab bound the motion of node and facet.
    """
    speed = np.maximum(np.linalg.norm(now.start.velocity, axis=1), np.linalg.norm(end, axis=1))
    travel = span * rows.travel(speed, model.space.greatest(speed))
    depth = -(rows.gap(now.start.displacement) + rows.tool_motion)
    return np.asarray(depth <= travel + SHALLOW * model.edge[rows.node])


def rounding(model: Model, rows: ContactRows, u: Array) -> float:
    """Rounding error of gaps [m]: a few units in the last place of the coordinates."""
    greatest = model.space.greatest
    return 4e-16 * (greatest(model.points) + greatest(u) + float(np.abs(rows.offset[rows.near]).max(initial=0.0)))


def _touching(
    model: Model,
    now: ModelState,
    system: SlabEquations,
    current: EventIteration,
    q: Array,
    below: BoolArray,
    touch: Touch,
) -> EventIteration:
    """Close the rows that end inside the obstacle; a row that was released in this slab stays closed instead."""
    rows, events, h = current.rows, current.events, system.path.span
    back = below & np.isfinite(events.release)
    fresh = below & ~back
    gap = np.where(rows.near, rows.gap(now.start.displacement) + rows.tool_motion, 0.0)
    jumped = sum((j for _, j in system.path.jumps), np.zeros(model.shape))
    speed, solved = rows.normal_component(now.start.velocity), rows.normal_component(q - now.start.velocity - jumped)
    slope = touch.slope(rows, now, h, solved)
    closing = h * speed - rows.tool_motion
    tau = crossing(gap, closing, h * slope)
    missed = ~np.isfinite(tau)
    slope = np.where(missed, solved, slope)
    tau = _reached(rows, system, (gap, closing, h * slope), tau)
    return replace(
        current,
        events=ContactEvents(
            closed=events.closed | below,
            touch=np.where(fresh, tau, events.touch),
            speed=np.where(fresh, speed, events.speed),
            slope=np.where(fresh, slope, events.slope),
            release=np.where(back, np.nan, events.release),
        ),
        may_not_release=current.may_not_release | back,
    )


def _reached(rows: ContactRows, system: SlabEquations, motion: tuple[Array, Array, Array], tau: Array) -> Array:
    """Instants (m,) at which the gap closes, with the velocity jumps of earlier touches in the slab."""
    gap, speed, slope = motion
    bent = gap
    for _ in range(1 if not system.path.jumps else 6):
        found = np.where(np.isfinite(tau) & (bent == gap), tau, crossing(bent, speed, slope))
        found = np.where(np.isfinite(found), found, np.where(gap <= 0.0, 0.0, 1.0))
        bent = gap.copy()
        for instant, field in system.path.jumps:
            bent += system.path.span * rows.normal_component(field) * np.maximum(found - instant, 0.0)
        tau = np.where(bent == gap, found, np.nan)
    return found


def _releasing(
    model: Model,
    system: SlabEquations,
    current: EventIteration,
    q: Array,
    tense: BoolArray,
    pull: Array,
    inertia: ImpactMultipliers,
    friction: Array | float,
) -> EventIteration:
    """Release the closed rows with a reaction in tension at the end, at the instant where it vanishes."""
    events = current.events
    first = current.reaction.copy()
    begun = events.closed & ~np.isfinite(events.touch)
    order = contact_order(np.where(events.closed, events.touch, np.nan), begun)
    sequence = ImpactSequence(inertia, current.rows, order)
    for instant in instants(np.where(tense, events.touch, np.nan)):
        here = tense & at(events.touch, instant)
        after = events.closed & (~(events.touch > instant) | here)
        first[here] = sequence.reactions(model.force(system.path.at(instant, q)) - friction, after)[here]
    begin = np.nan_to_num(events.touch)
    release = np.minimum(begin + (1.0 - begin) * fading(first, pull), 1.0 - 1e-9)
    return replace(
        current,
        events=replace(events, closed=events.closed & ~tense, release=np.where(tense, release, events.release)),
        reaction=np.where(tense, first, current.reaction),
    )
