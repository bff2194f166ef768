"""The contact events of a slab as they become known, for nodes with inertia.

Nodes that end below the obstacle get a touch, closed rows whose reaction ends in tension a release, both located
inside the slab.  A row touches once and is released once a slab; one that would come back is held instead.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.contact.candidates import Candidates
from softway.contact.encounters import Pairs
from softway.contact.path import Passage, passage
from softway.contact.timing import Paper
from softway.kernels.impact import crossing, fading
from softway.march.jumps import at, instants
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.driver import Solution
from softway.solve.reaction import Reaction
from softway.solve.system import SlabSystem
from softway.typing import Array, BoolArray

APART = 1e-9
"""Gap at the start of a slab, relative to the coordinates, beyond which a row does not touch."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Course:
    """What is known of a slab.

    ``rows`` are the contact rows at the end of the slab; ``way`` is what each row does; ``reaction`` (m,) the force at
    the start of its closed phase; ``held`` (m,) rows that may not let go again.
    """

    rows: Candidates
    way: Passage
    reaction: Array
    held: BoolArray

    @property
    def impulse(self) -> Array:
        """Impulse over h (m,) of the force that fades linearly between the start of contact and the release [N]."""
        begin = np.nan_to_num(self.way.touch)
        length = np.where(np.isfinite(self.way.release), np.nan_to_num(self.way.release) - begin, 0.0)
        return 0.5 * np.maximum(self.reaction, 0.0) * length


def undisturbed(model: Model, now: Situation, pairs: Pairs, rows: Candidates) -> Course:
    """The course without events; closed rows that do not touch at the start, where a node slid off a face, let go."""
    first, u0 = pairs.start(now.start.displacement), now.start.displacement
    reach = float(np.abs(model.points + u0).max())
    gone = now.closed & ~(rows.near & first.near & (first.gap(u0) <= APART * reach))
    way = passage(now.closed & ~gone)
    way = replace(way, release=np.where(gone, 0.0, way.release))
    return Course(rows=rows, way=way, reaction=now.pressure, held=np.zeros(len(now.closed), bool))


def revised(
    model: Model, now: Situation, system: SlabSystem, known: Course, found: Solution, inertia: Reaction
) -> Course | None:
    """The course with the touches and releases that the solution asks for; None when it asks for none."""
    rows, way, end = known.rows, known.way, found.end
    gap = rows.gap(end.displacement)
    below = ~way.closed & (gap < -rounding(model, rows, end.displacement)) & rows.reachable(model.free)
    if below.any():
        return _touching(model, now, system, known, found.last.q, below)
    pull = inertia.multiplier(rows, end.force, way.closed)
    floor = 1e-11 * max(float(np.abs(end.force).max(initial=0.0)), float(np.abs(pull).max(initial=0.0)))
    tense = way.closed & ~known.held & (pull < -floor)
    if tense.any():
        return _releasing(model, system, known, found.last.q, tense, pull, inertia)
    return None


def turned(model: Model, pairs: Pairs, known: Course, found: Solution) -> Course | None:
    """The course with the rows at the end that the solution has; None when they have settled."""
    if pairs.known is not None:
        return None
    u1 = found.end.displacement
    rows = pairs.at(u1)
    looked_at = rows.near & known.rows.near
    looked_at = looked_at & known.way.kinked
    off = rows.gap(u1)[looked_at] - known.rows.gap(u1)[looked_at]
    fresh = rows.near & ~known.rows.near & (rows.gap(u1) < 0.0)
    if not fresh.any() and np.abs(off).max(initial=0.0) <= 8.0 * rounding(model, rows, u1):
        return None
    return replace(known, rows=rows)


def rounding(model: Model, rows: Candidates, u: Array) -> float:
    """A length [m] below which a gap is rounding: a few units in the last place of the coordinates."""
    reach = max(float(np.abs(p.mesh.points).max()) for p in model.parts)
    return 4e-16 * (reach + float(np.abs(u).max(initial=0.0)) + float(np.abs(rows.offset[rows.near]).max(initial=0.0)))


def _touching(model: Model, now: Situation, system: SlabSystem, known: Course, q: Array, below: BoolArray) -> Course:
    """Close the rows that end below the obstacle; one that was released in this slab is held instead."""
    rows, way, h = known.rows, known.way, system.path.span
    back = below & np.isfinite(way.release)
    fresh = below & ~back
    gap = np.where(rows.near, rows.gap(now.start.displacement) + rows.drive, 0.0)
    jumped = sum((j for _, j in system.path.jumps), np.zeros(model.shape))
    speed, solved = rows.along(now.start.velocity), rows.along(q - now.start.velocity - jumped)
    slope = solved
    if isinstance(model.timing, Paper):
        slope = h * rows.along(now.acceleration) if model.timing.approach == "extrapolated" else np.zeros_like(solved)
    closing = h * speed - rows.drive
    tau = crossing(gap, closing, h * slope)
    missed = ~np.isfinite(tau)
    slope = np.where(missed, solved, slope)
    tau = _reached(rows, system, (gap, closing, h * slope), tau)
    return replace(
        known,
        way=Passage(
            closed=way.closed | below,
            touch=np.where(fresh, tau, way.touch),
            speed=np.where(fresh, speed, way.speed),
            slope=np.where(fresh, slope, way.slope),
            release=np.where(back, np.nan, way.release),
        ),
        held=known.held | back,
    )


def _reached(rows: Candidates, system: SlabSystem, motion: tuple[Array, Array, Array], tau: Array) -> Array:
    """Instants (m,) at which the gap closes; jumps of earlier touches of the slab bend the path on the way."""
    gap, speed, slope = motion
    bent = gap
    for _ in range(1 if not system.path.jumps else 6):
        found = np.where(np.isfinite(tau) & (bent == gap), tau, crossing(bent, speed, slope))
        found = np.where(np.isfinite(found), found, np.where(gap <= 0.0, 0.0, 1.0))
        bent = gap.copy()
        for instant, field in system.path.jumps:
            bent += system.path.span * rows.along(field) * np.maximum(found - instant, 0.0)
        tau = np.where(bent == gap, found, np.nan)
    return found


def _releasing(
    model: Model, system: SlabSystem, known: Course, q: Array, tense: BoolArray, pull: Array, inertia: Reaction
) -> Course:
    """Let go of the closed rows whose reaction ends in tension, at the instant where it vanishes."""
    way = known.way
    first = known.reaction.copy()
    for instant in instants(np.where(tense, way.touch, np.nan)):
        here = tense & at(way.touch, instant)
        after = way.closed & (~(way.touch > instant) | here)
        first[here] = inertia.multiplier(known.rows, model.force(system.path.at(instant, q)), after)[here]
    begin = np.nan_to_num(way.touch)
    release = np.minimum(begin + (1.0 - begin) * fading(first, pull), 1.0 - 1e-9)
    return replace(
        known,
        way=replace(way, closed=way.closed & ~tense, release=np.where(tense, release, way.release)),
        reaction=np.where(tense, first, known.reaction),
    )
