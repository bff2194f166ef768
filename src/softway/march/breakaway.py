"""The start of slip inside a slab, where friction drops with it: a body that breaks away ends the slab there."""

from collections.abc import Callable

import numpy as np

from softway.errors import Halts
from softway.march.halt import EARLY, LATE
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.model import Model
from softway.typing import Array, BoolArray

SHORT = 1e-6
"""Share of the time up to the instant that the slab stays short of it, so that the body still rests at its end."""
HALF = 0.5
"""Share of the friction of a contact that must break away at once."""
DROP = 1e-9
"""Share of the limit by which friction must drop."""


def breakaway(model: Model, now: Situation, out: Outcome, held: Callable[[], Outcome]) -> None:
    """Refuse a slab inside which a contact breaks away, and its friction drops.

    ``held`` solves the slab with all that rests held at any force.  The limit is where the forces of the contact,
    linear in time up to there, reach it.

    Raises
    ------
    Halts
        With the share of the slab after which the first contact does.
    """
    if model.rubbing is None or now.sliding is None or now.traction is None or out.rub is None:
        return
    limit = model.rubbing.limit(now.pressure)
    drops = limit * (1.0 - DROP) > model.rubbing.resistance(np.zeros(len(limit)), now.pressure)[0]
    start = np.linalg.norm(now.traction, axis=1)
    going = drops & now.closed & out.closed & ~now.sliding & out.rub.sliding
    contact = out.system.path.rows.contact
    leaving = [k for k in np.unique(contact[going]).tolist() if _most(start, contact == k, going)]
    if not leaving:
        return
    end = held()
    assert end.rub is not None
    last, most = np.linalg.norm(end.rub.traction, axis=1), model.rubbing.limit(end.pressure)
    shares = []
    for k in leaving:
        here = (contact == k) & going
        spare, excess = float((limit - start)[here].sum()), float((last - most)[here].sum())
        if spare > 0.0 and excess > 0.0:
            shares.append(spare / (spare + excess))
    shares = [s * (1.0 - SHORT) for s in shares if EARLY < s < LATE]
    if shares:
        raise Halts(min(shares))


def _most(force: Array, here: BoolArray, going: BoolArray) -> bool:
    return bool(force[here & going].sum() >= HALF * force[here].sum())
