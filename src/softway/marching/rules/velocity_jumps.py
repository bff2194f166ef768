"""Velocity jumps of nodes with inertia at the touches inside a slab (time step)."""

from dataclasses import replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.trajectory import ContactEvents
from softway.marching.rules.touch import Touch, VelocityJump
from softway.model.model import Model
from softway.solve.constraints.impact_sequence import ImpactSequence, contact_order

SIMULTANEOUS = 1e-9
"""Fraction of a slab within which touches are simultaneous."""


def instants(tau: Array) -> list[float]:
    """Distinct finite instants in order; instants within ``SIMULTANEOUS`` are merged to the first of them.

    Examples
    --------
    >>> instants(np.array([0.5, np.nan, 0.25, 0.5 + 1e-12]))
    [0.25, 0.5]
    """
    found: list[float] = []
    for t in np.unique(tau[np.isfinite(tau)]):
        if not found or t > found[-1] + SIMULTANEOUS:
            found.append(float(t))
    return found


def at(tau: Array, instant: float) -> BoolArray:
    """Rows (m,) with ``tau`` at the instant."""
    return np.asarray((tau >= instant) & (tau <= instant + SIMULTANEOUS))


def velocity_jumps(
    model: Model, rows: ContactRows, events: ContactEvents, closed: BoolArray, touch: Touch, span: float
) -> tuple[VelocityJump, ...]:
    """Velocity jumps of a slab in order of time; ``closed`` (m,) are the rows closed at its start."""
    if not np.isfinite(events.touch).any():
        return ()
    speed = events.approach - np.where(np.isfinite(events.touch), rows.tool_motion / span, 0.0)
    together = ImpactSequence(touch.inertia, rows, contact_order(events.touch, closed))
    jumps: list[VelocityJump] = []
    shared: list[int] = []
    for instant in instants(events.touch):
        hits = at(events.touch, instant)
        approach = np.where(hits, speed, 0.0)
        alone = touch.jump(model, rows, approach, hits)
        if alone is None:
            gone = events.release <= instant
            impulse, change = together.stopped(approach, ((closed | (events.touch < instant)) & ~gone) | hits)
            speed = speed + np.where((events.touch > instant) & ~hits, change, 0.0)
            shared.append(len(jumps))
        field, impulse = (np.zeros(model.shape), impulse) if alone is None else alone
        jumps.append(VelocityJump(instant=instant, hits=hits, field=field, impulse=impulse, speed=approach))
    for k, field in zip(shared, together.fields([jumps[k].impulse for k in shared]), strict=True):
        jumps[k] = replace(jumps[k], field=field)
    return tuple(jumps)
