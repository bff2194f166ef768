"""Events of ties that break: the instant at which the force at a node vanishes."""

import numpy as np

from softway.marching.results.slab_result import SlabResult
from softway.marching.results.step import Event
from softway.marching.state.model_state import ModelState
from softway.model.cohesive_ties import CohesiveTie
from softway.model.model import Model
from softway.model.slab import Slab


def tie_breaks(model: Model, now: ModelState, slab: Slab, out: SlabResult) -> list[Event]:
    """Breaks of the nodes of all ties in a solved slab."""
    found: list[Event] = []
    for bond in model.bonds:
        end = out.solution.end.fields[model.companions.index(bond)].end.values
        for k, tie in enumerate(bond.ties):
            node = tie.jump.node
            new = np.flatnonzero((end[node, k] >= 1.0) & (bond.damage[node, k] < 1.0))
            found += _breaks(model, tie, now, slab, out, new.tolist()) if len(new) else []
    return found


def _breaks(
    model: Model, tie: CohesiveTie, now: ModelState, slab: Slab, out: SlabResult, rows: list[int]
) -> list[Event]:
    """Breaks of some rows of a tie; the opening changes linearly in the slab."""
    u0, u1 = now.start.displacement, out.solution.end.displacement
    one, two = (tie.effective(*tie.opened(u, model.points + u)[:2]) for u in (u0, u1))
    last = tie.law.openings(two[1])[1]
    found = []
    for row in rows:
        change = two[0][row] - one[0][row]
        part = min(max((last[row] - one[0][row]) / change, 0.0), 1.0) if change > 0.0 else 1.0
        node, body = int(tie.jump.node[row]), model.parts[model.part_of[tie.jump.node[row]]]
        place = model.points[node] + u0[node] + part * (u1[node] - u0[node])
        found.append(
            Event(
                time=slab.start + part * slab.span,
                contact=tie.tie.label,
                kind="break",
                node=node - body.nodes.start,
                position=place,
                velocity_before=float(change / slab.span),
                velocity_after=float(change / slab.span),
                impulse=0.0,
                bodies=tie.tie.bodies if body.name == tie.tie.bodies[0] else tie.tie.bodies[::-1],
            )
        )
    return found
