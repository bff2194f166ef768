"""Slab (time step) of solids and rigid bodies: their motions and forces in turn, until both agree.

The solids see the rigid bodies as tools in a motion, and push them; with these forces the rigid bodies have another
motion.  Nodes that they carry move along inside the iteration of the solids (``carried_motion.py``), so that one turn
is enough without contact.  The heat of stops between rigid bodies is that of the turn before, until it agrees, too.
The contraction of the turns with contact is about the mass of the cells at the contact over
that of the rigid body; mixing the last motions takes care of light bodies (docs/theory/contact/rigid_bodies.md).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.errors import NoConvergence
from softway.marching.results.slab_result import SlabResult
from softway.marching.rules.slab_rule import Attempt, SlabRule
from softway.marching.slab.rigid.rigid_iteration import AGREES, PATIENCE, RigidIteration
from softway.marching.state.model_state import ModelState
from softway.mechanisms.members.stops import StopEvent
from softway.model.field import feel_stops, with_stops
from softway.model.model import Model
from softway.model.rigid.rigid_state import RigidState
from softway.model.slab import Slab
from softway.solve.methods.anderson import Anderson
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.stagnation import Stagnation

DEPTH = 6
"""Number of last motions that are mixed."""
LIMIT = 40
"""Greatest number of turns."""
ROUGH, SHARE = 1e-5, 0.003
"""Greatest tolerance of the solids, and tolerance relative to the difference of the motions, while they disagree."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoupledSlab:
    """Slab of solids, with the state of the rigid bodies at its end that belongs to the forces on them, and the events
    of their stops.
    """

    out: SlabResult
    rigid: RigidState
    memory: OperatorMemory
    events: tuple[StopEvent, ...]


def coupled_slabs(
    rule: SlabRule, model: Model, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt
) -> Iterator[CoupledSlab]:
    """Solutions of a slab, each more accurate than the previous one.

    Raises
    ------
    NoConvergence, TooFast
        If the motions do not come to agree, or as for the rule of the solids.
    """
    it = RigidIteration.of(model, now, slab)
    first, others, response = it.after(it.before.given), np.zeros_like(it.before.given), None
    x, stops, felt, waited = it.motion(first), first.stops, feel_stops(model.companions), 0
    mixing, seen, closest, iterations = Anderson(DEPTH), Stagnation(), np.inf, 0
    attempt = replace(attempt, tolerance=ROUGH if it.touched and it.before.given.any() else 0.0)
    for _ in range(LIMIT):
        moving = it.moving(x)
        moving = replace(moving, companions=with_stops(moving.companions, stops)) if felt else moving
        attempt = replace(attempt, follower=it.follower(moving, now, x, others, response))
        for out, after in rule.solve(moving, now, slab, memory, attempt):
            found = it.answer(out, now, x)
            seen = seen.after(found.change, it.least)
            agrees = found.agrees(seen, it.least) and (not felt or it.feels(found, stops, waited))
            waited += felt and found.agrees(seen, it.least)
            if agrees and found.change < 0.5 * closest and attempt.tolerance <= AGREES:
                closest, whole = found.change, replace(out, iterations=iterations + out.iterations)
                yield CoupledSlab(out=whole, rigid=found.after.state, memory=after, events=found.after.events)
            if closest < np.inf and (seen.since >= PATIENCE or found.change <= it.least):
                return
            if it.touched or not found.joint:
                break
        iterations, memory, others = iterations + out.iterations, after, found.others
        stops = found.after.stops
        response = response or it.response(out)
        step = (found.motion - found.seen).ravel()
        step = step if response is None else response.newton @ step
        x = mixing.mix(x.ravel(), found.seen.ravel() + step).reshape(x.shape)
        attempt = replace(attempt, guess=replace(out.solution.last.guess, near=True), tolerance=0.0)
        if it.touched and not agrees:
            attempt = replace(attempt, tolerance=min(SHARE * found.change / max(found.scale, 1e-300), ROUGH))
    if closest == np.inf:
        problem = f"rigid bodies and solids do not agree on their motion: {found.change:.1e} of {found.scale:.1e} m"
        raise NoConvergence(problem)
