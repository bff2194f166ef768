"""One slab with contact nodes that carry inertia: the Paper and Impulse rules on one path.

The slab is solved with the rows that were closed, and again on the same operator with the touches and releases that
the solution asks for, until it asks for none.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from softway.contact.encounters import Pairs
from softway.contact.fig4 import Split
from softway.contact.path import Path
from softway.contact.timing import Paper
from softway.errors import NoConvergence
from softway.march.certificate import DEPTH
from softway.march.control import require_slow
from softway.march.course import Course, revised, turned, undisturbed
from softway.march.jumps import Jump, jumps, loss
from softway.march.outcome import Outcome, contact_event, supports
from softway.march.situation import Situation
from softway.march.step import Event
from softway.model import Model
from softway.solve.carry import Carry
from softway.solve.driver import Solution, solutions
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.solve.normal import Rows
from softway.solve.reaction import Reaction
from softway.solve.system import SlabSystem
from softway.solve.watched import Watched
from softway.time.slab import Slab
from softway.typing import Array

PASSES = 60
"""A slab whose events ask for more solutions than this is tried again shorter."""
STEADY = 15
"""Solutions after which nodes are kept on the faces where they are: one between two faces would go to and fro."""


def solve_carrying(
    model: Model,
    now: Situation,
    slab: Slab,
    carry: Carry,
    method: FixedPoint | Newton | Watched,
    inertia: Reaction,
    approach: float,
    split: Split | None = None,
) -> Iterator[tuple[Outcome, Carry]]:
    """Solutions of the slab, each closer than the one before, with touches and releases added until none is missing."""
    ahead = now.start.velocity + slab.span * now.acceleration
    given = model.prescribed(slab.end)
    guess = np.where(model.free, ahead, given)
    coasting = now.start.displacement + 0.5 * slab.span * (now.start.velocity + guess)
    pairs = model.encounters.meet(now.start.displacement, coasting, slab.start, slab.end)
    require_slow(model, pairs, coasting, approach)
    known, faces = undisturbed(model, now, pairs, pairs.at(coasting)), pairs
    iterations = 0
    for passes in range(1, PASSES + 1):
        found = jumps(model, known.rows, known.way, now.closed, inertia, slab.span)
        system = replace(_system(model, now, slab, known, found, given), split=split)
        iterates = method.iterate(system, guess, carry, np.zeros(len(known.way.closed)), known.way.closed)
        for solution in solutions(system, iterates, method.tolerance, method.limit):
            u1, carry = solution.end.displacement, solution.last.carry
            faces = pairs.held(u1) if passes == STEADY and pairs.known is None else faces
            revision = turned(model, faces, known, solution) or revised(model, now, system, known, solution, inertia)
            if revision is not None:
                break
            if faces is not pairs and not _apart(model, pairs, u1):
                raise NoConvergence("the nodes that were kept on their faces overlap others")
            work = passes, iterations + solution.iterations
            yield _outcome(now, slab, system, known, solution, found, inertia, pairs.found, work), carry
        else:
            return
        iterations += solution.iterations
        known, guess = revision, solution.last.q
    raise NoConvergence(f"the contact events of the slab do not settle in {PASSES} passes")


def _apart(model: Model, pairs: Pairs, u1: Array) -> bool:
    """Whether faces that were kept leave no overlap at the end position ``u1`` (n, d)."""
    return pairs.overlap(u1) <= DEPTH * float(np.abs(model.points + u1).max())


def _system(
    model: Model, now: Situation, slab: Slab, known: Course, found: tuple[Jump, ...], given: Array
) -> SlabSystem:
    """The equations of the slab for a course of events."""
    rows, way, literal = known.rows, known.way, isinstance(model.timing, Paper)
    balanced = () if literal else found
    kicks = sum((j.impulse for j in balanced), np.zeros(len(way.closed)))
    impulses = known.impulse * slab.span + np.where(way.closed, 0.0, kicks)
    path = Path(
        span=slab.span,
        start=now.start.displacement,
        velocity=now.start.velocity,
        massive=model.massive,
        free=model.free,
        rows=rows,
        way=way,
        jumps=tuple((j.instant, j.field) for j in found),
    )
    none = np.zeros(len(way.closed))
    moving = rows.along(np.where(model.free, 0.0, given))
    return SlabSystem(
        model=model,
        start=now.start,
        weight=slab.weight,
        path=path,
        rows=Rows(target=rows.drive / slab.span - moving, equal=way.closed, unilateral=none > 0.0),
        unbalanced=sum((j.field for j in found if literal), np.zeros(model.shape)),
        impulses=rows.spread(impulses, model.shape),
        given=given,
    )


def _outcome(
    now: Situation,
    slab: Slab,
    system: SlabSystem,
    known: Course,
    solution: Solution,
    found: tuple[Jump, ...],
    inertia: Reaction,
    pairs: int,
    work: tuple[int, int],
) -> Outcome:
    model, h, way, q, rows = system.model, slab.span, known.way, solution.last.q, known.rows
    jumped = sum((j.field for j in found), np.zeros(model.shape))
    slope = (q - now.start.velocity - jumped) / h
    with np.errstate(divide="ignore", invalid="ignore"):
        released = np.where(way.freedom > 0.0, (rows.along(q) - rows.drive / h) / (h * way.freedom), 0.0)
    kinked = np.where(way.kinked, released - rows.along(slope), 0.0)
    through = _through(known, solution, found, h, isinstance(model.timing, Paper))
    pull = inertia.multiplier(rows, solution.end.force, way.closed)
    push = rows.spread(through / h, model.shape)
    support = supports(model, now, solution.end, q, push, h)
    moved = solution.end.displacement - now.start.displacement
    return Outcome(
        system=system,
        solution=solution,
        rows=rows,
        velocity=q,
        acceleration=slope + rows.motion(kinked, way.kinked, model.free),
        closed=way.closed,
        pressure=np.maximum(pull, 0.0),
        force=through / h,
        push=push,
        support=support,
        work=float(through @ rows.drive) / h + float(np.sum(support * moved)),
        dissipation=loss(model, rows, way, found, now.start.velocity, q, h),
        events=_events(now, slab, system, known, solution, found),
        pairs=pairs,
        passes=work[0],
        iterations=work[1],
    )


def _through(known: Course, solution: Solution, found: tuple[Jump, ...], span: float, literal: bool) -> Array:
    """Impulses (m,) of the contact rows over the slab [N s]."""
    closed = known.way.closed
    kicks = sum((j.impulse for j in found), np.zeros(len(closed)))
    held = np.where(closed, solution.last.impulse, 0.0)
    return known.impulse * span + held + np.where(closed & (not literal), 0.0, kicks)


def _events(
    now: Situation, slab: Slab, system: SlabSystem, known: Course, solution: Solution, found: tuple[Jump, ...]
) -> tuple[Event, ...]:
    model, way, end = system.model, known.way, solution.end.displacement
    after: Array = known.rows.along(solution.last.q) - known.rows.drive / slab.span
    events = [
        contact_event(
            model, now, slab, known.rows, end, int(r), "touch", j.instant, (float(j.speed[r]), 0.0), float(j.impulse[r])
        )
        for j in found
        for r in np.flatnonzero(j.hits)
    ]
    events += [
        contact_event(
            model, now, slab, known.rows, end, int(r), "release", float(way.release[r]), (0.0, float(after[r]))
        )
        for r in np.flatnonzero(np.isfinite(way.release))
    ]
    return tuple(
        sorted(
            events, key=lambda e: (round((e.time - slab.start) / slab.span, 9), e.contact, e.node, e.kind == "release")
        )
    )
