"""Stick and slip events of touching rows."""

import numpy as np

from softway.contact.contact_rows import ContactRows
from softway.marching.results.friction_result import FrictionResult
from softway.marching.results.slab_result import contact_event
from softway.marching.results.step import Event
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.solve.methods.iteration import Solution


def stick_slip_events(
    model: Model,
    now: ModelState,
    slab: Slab,
    solution: Solution,
    rows: tuple[ContactRows, ContactRows],
    friction: FrictionResult,
) -> list[Event]:
    """Events of touching rows that come to rest or begin to slip.

    Slip begins when the linearly extrapolated force reaches the limit.  It ends when the relative velocity of the
    followed nodes with inertia vanishes.
    """
    first, last = rows
    if not last.shear.count:
        return []
    both = now.closed & (friction.traction.any(axis=1) | (solution.last.impulse[: len(now.closed)] > 0.0))
    h, end = slab.span, solution.end.displacement
    follow = model.follow
    before = np.linalg.norm(first.shear.slip(h * (follow @ now.start.velocity)), axis=1) / h
    after = np.linalg.norm(last.shear.slip(h * (follow @ solution.last.q)), axis=1) / h
    slip = np.linalg.norm(last.shear.slip(end - now.start.displacement), axis=1) / h
    force = np.linalg.norm(now.traction, axis=1)
    events = []
    for r in np.flatnonzero(both & (now.sliding != friction.sliding)).tolist():
        if friction.sliding[r]:
            limit = float(model.friction.limit(now.pressure)[r])
            tau = _zero_crossing(limit - force[r], slip[r] * h)
            speeds, kind = (0.0, float(slip[r])), "slip"
        else:
            tau, speeds, kind = _zero_crossing(before[r], after[r]), (float(before[r]), 0.0), "stick"
        events.append(contact_event(model, now, slab, last, end, r, kind, tau, speeds))
    return events


def _zero_crossing(one: float, other: float) -> float:
    """Zero crossing in [0, 1] of a line from ``one`` to ``-other``; 0.5 if both vanish.

    >>> _zero_crossing(1.0, 3.0)
    0.25
    """
    one, other = max(float(one), 0.0), max(float(other), 0.0)
    return one / (one + other) if one + other > 0.0 else 0.5
