"""Velocity jumps of nodes with inertia at the touches inside a slab (time step)."""

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.trajectory import ContactEvents
from softway.march.rules.touch import Touch, VelocityJump
from softway.model.model import Model

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
    speed, found = events.approach - np.where(np.isfinite(events.touch), rows.tool_motion / span, 0.0), []
    for instant in instants(events.touch):
        hits = at(events.touch, instant)
        approach = np.where(hits, speed, 0.0)
        gone = events.release <= instant
        stopped = ((closed | (events.touch < instant)) & ~gone) | hits
        field, impulse = touch.jump(model, rows, approach, hits, stopped)
        if touch.balanced:
            later = np.isfinite(events.touch) & (events.touch > instant) & ~hits
            speed = speed + np.where(later, rows.normal_component(field), 0.0)
        found.append(VelocityJump(instant=instant, hits=hits, field=field, impulse=impulse, speed=approach))
    return tuple(found)
