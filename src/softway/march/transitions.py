"""Places that come to rest or begin to slip while they touch."""

import numpy as np

from softway.contact.candidates import Candidates
from softway.march.outcome import contact_event
from softway.march.rub import Rub
from softway.march.situation import Situation
from softway.march.step import Event
from softway.model import Model
from softway.solve.driver import Solution
from softway.time.slab import Slab


def transitions(
    model: Model, now: Situation, slab: Slab, solution: Solution, rows: tuple[Candidates, Candidates], rubbed: Rub
) -> list[Event]:
    """Places that come to rest or begin to slip while they touch.

    Slip begins where the force, continued linearly, reaches the limit; it ends where the velocity of the nodes with
    inertia behind does, relative to the opponent.
    """
    first, last = rows
    assert now.traction is not None and now.sliding is not None and first.shear is not None and last.shear is not None
    both = now.closed & (rubbed.traction.any(axis=1) | (solution.last.impulse[: len(now.closed)] > 0.0))
    h, end = slab.span, solution.end.displacement
    follow = model.follow
    before = np.linalg.norm(first.shear.slip(h * (follow @ now.start.velocity)), axis=1) / h
    after = np.linalg.norm(last.shear.slip(h * (follow @ solution.last.q)), axis=1) / h
    slip = np.linalg.norm(last.shear.slip(end - now.start.displacement), axis=1) / h
    held = np.linalg.norm(now.traction, axis=1)
    events = []
    for r in np.flatnonzero(both & (now.sliding != rubbed.sliding)).tolist():
        if rubbed.sliding[r]:
            limit = float(model.rubbing.limit(now.pressure)[r]) if model.rubbing is not None else 0.0
            tau = _share(limit - held[r], slip[r] * h)
            speeds, kind = (0.0, float(slip[r])), "slip"
        else:
            tau, speeds, kind = _share(before[r], after[r]), (float(before[r]), 0.0), "stick"
        events.append(contact_event(model, now, slab, last, end, r, kind, tau, speeds))
    return events


def _share(one: float, other: float) -> float:
    """Where a line from ``one`` to ``-other`` crosses zero; in the middle where both vanish.

    >>> _share(1.0, 3.0)
    0.25
    """
    one, other = max(float(one), 0.0), max(float(other), 0.0)
    return one / (one + other) if one + other > 0.0 else 0.5
