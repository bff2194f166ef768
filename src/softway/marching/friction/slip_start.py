"""Start of slip inside a slab (time step) if friction drops with slip: the slab ends where a body breaks away."""

import logging
from collections.abc import Callable

import numpy as np

from softway.arrays import Array, BoolArray
from softway.errors import Halts, NoConvergence
from softway.marching.friction.slip_end import EARLY, LATE
from softway.marching.results.slab_result import SlabResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model

log = logging.getLogger(__name__)
SHORT = 1e-6
"""Fraction of the time to the instant by which the slab ends earlier: the body is still at rest at its end."""
HALF = 0.5
"""Fraction of the friction of a contact that must break away at once."""
DROP = 1e-9
"""Drop of friction, relative to its limit, above which slip can start inside a slab."""


def slip_start(model: Model, now: ModelState, out: SlabResult, solve_stuck: Callable[[], SlabResult]) -> None:
    """Refuse a slab inside which a contact breaks away and its friction drops.

    ``solve_stuck`` solves the slab with sticking at any force of all rows at rest.  The instant follows from the forces
    of the contact, which are linear in time until they reach the limit.  If no forces let the rows stick, there is no
    such instant, and the slab stays as it is.

    Raises
    ------
    Halts
        With the fraction of the slab up to the first such instant.
    """
    if model.friction.frictionless:
        return
    limit = model.friction.limit(now.pressure)
    drops = limit * (1.0 - DROP) > model.friction.resistance(np.zeros(len(limit)), now.pressure)[0]
    start = np.linalg.norm(now.traction, axis=1)
    breaking = drops & now.closed & out.closed & ~now.sliding & out.friction.sliding
    contact = out.system.path.rows.contact
    leaving = [k for k in np.unique(contact[breaking]).tolist() if _most(start, contact == k, breaking)]
    if not leaving:
        return
    try:
        end = solve_stuck()
    except NoConvergence as failure:
        log.info("slip from t = %.6g s on without the instant of its start: %s", now.time, failure)
        return
    last, most = np.linalg.norm(end.friction.traction, axis=1), model.friction.limit(end.pressure)
    fractions = []
    for k in leaving:
        here = (contact == k) & breaking
        spare, excess = float((limit - start)[here].sum()), float((last - most)[here].sum())
        if spare > 0.0 and excess > 0.0:
            fractions.append(spare / (spare + excess))
    fractions = [s * (1.0 - SHORT) for s in fractions if EARLY < s < LATE]
    if fractions:
        raise Halts(min(fractions))


def _most(force: Array, here: BoolArray, breaking: BoolArray) -> bool:
    return bool(force[here & breaking].sum() >= HALF * force[here].sum())
