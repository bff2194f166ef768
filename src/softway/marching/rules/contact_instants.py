"""Instants of touch and release inside a slab with contact nodes in equilibrium at its end."""

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.kernels.geometry.event_times import fading
from softway.marching.results.slab_result import contact_event
from softway.marching.results.step import Event
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import moments
from softway.solve.elimination.closed_rows import forces_of_motion
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.iteration import Solution


def touches(
    model: Model, now: ModelState, slab: Slab, system: SlabEquations, solution: Solution, closed: BoolArray
) -> list[Event]:
    """Touches at the root of the gap along the free motion, exact in free flight.

    If a row has no opponent at the start, or its free motion does not close it, its gap is traced back from the end
    position without contact, or else from the actual end position.  A row that is closed by its neighbours only
    touches at the end, with the mean speed of its motion.
    """
    h, rows, end = slab.span, system.path.rows, solution.end
    last = end.rows
    fresh = closed & ~now.closed
    if not fresh.any():
        return []
    gap = np.where(rows.near, rows.gap(now.start.displacement), 0.0)
    speed = 0.5 * solution.predicted[: len(last.node)] - last.tool_motion / h
    unseen = fresh & (~rows.near | (gap + h * speed >= 0.0))
    coasting = now.start.displacement + h * now.start.velocity
    for seen in (last, system.contact.at(coasting)) if unseen.any() else ():
        first = np.where(seen.near, seen.gap(now.start.displacement), 0.0) + seen.tool_motion
        rate = seen.normal_component(now.start.velocity) - seen.tool_motion / h
        closes = unseen & (first > 0.0) & (first + h * rate < 0.0)
        gap, speed = np.where(closes, first, gap), np.where(closes, rate, speed)
    speed = np.where(gap + h * speed < 0.0, speed, -gap / h)
    tau = fading(gap, np.minimum(gap + h * speed, -1e-300))
    return [
        contact_event(model, now, slab, last, end.displacement, int(r), "touch", float(tau[r]), (float(speed[r]), 0.0))
        for r in np.flatnonzero(fresh)
    ]


def releases(
    model: Model, now: ModelState, slab: Slab, rows: ContactRows, solution: Solution, closed: BoolArray
) -> list[Event]:
    """Releases at the root of the reaction, continued into tension by the compliance of the released rows."""
    h, end = slab.span, solution.end.displacement
    left = np.flatnonzero(now.closed & ~closed & rows.near)
    frozen = solution.last.memory.frozen
    if not len(left) or frozen is None:
        return []
    coefficients = frozen.coefficients(rows, solution.last.system.model.dofs).subset(left)
    tension = forces_of_motion(frozen, coefficients, rows.gap(end)[left]) * 2.0 / h / (h * moments(slab.weight)[1])
    tau = fading(now.pressure[left], -np.maximum(tension, 1e-300))
    after: Array = 0.5 * rows.normal_component(solution.last.q) - rows.tool_motion / h
    return [
        contact_event(model, now, slab, rows, end, int(r), "release", float(t), (0.0, float(after[r])))
        for r, t in zip(left, tau, strict=True)
    ]
