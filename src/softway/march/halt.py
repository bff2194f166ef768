"""The end of slip inside a slab: a body that comes to rest on its opponent ends the slab at that instant."""

import numpy as np

from softway.errors import Halts
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.model import Model
from softway.typing import Array

EARLY = 1e-6
"""Share of a slab before which a body counts as at rest from its start."""
LATE = 1.0 - 1e-9
"""Share of a slab after which its end is the instant."""
STIFF = 4.0
"""Energy of the slip, in units of the strain energy that its friction holds, above which friction stops the body, and
not its elasticity."""


def halt(model: Model, now: Situation, out: Outcome, span: float) -> None:
    """Refuse a slab inside which a contact that slipped comes to rest.

    The velocity of a contact is the mean over the places that slipped, weighted by their friction at the start, of the
    velocities of the nodes with inertia behind, relative to the opponent.  Friction turns round or vanishes where it
    crosses zero: a slab that goes on beyond that instant would push the body back.

    Raises
    ------
    Halts
        With the share of the slab after which the first contact does.
    """
    first = out.system.path.rows
    if first.shear is None or now.traction is None or now.sliding is None:
        return
    weight = -now.traction * (now.sliding & now.closed)[:, None]
    found = []
    for contact in np.unique(first.contact[weight.any(axis=1)]).tolist():
        here = weight * (first.contact == contact)[:, None]
        before, after = (
            float(np.sum(here * first.shear.slip(span * (model.follow @ v)))) / span
            for v in (now.start.velocity, out.solution.last.q)
        )
        share = before / (before - after) if before > 0.0 > after else 1.0
        if EARLY < share < LATE:
            inertia, elastic = _answer(model, out, here)
            if before**2 > STIFF * 0.25 * span**2 * inertia * elastic:
                found.append((share, np.pi * 0.5 * span * np.sqrt(elastic / inertia)))
    if found:
        raise Halts(*min(found))


def _answer(model: Model, out: Outcome, weight: Array) -> tuple[float, float]:
    """Kinetic part e = z.Mz and elastic part E = z.Az - z.Mz of the answer z of the slab to forces (m, d).

    To stop a slip with the power P these forces take the energy ``P^2/2e``; they hold the strain energy ``h^2 E/8``:
    friction stops a body where the first is greater, and its elasticity where the second is.  What they have strained
    swings back in half a period, ``pi h/2 (E/e)^(1/2)``.
    """
    frozen, rows = out.solution.last.carry.frozen, out.system.path.rows
    assert frozen is not None and rows.shear is not None
    every = frozen.coefficients(rows, model.free)
    forces = np.concatenate([np.zeros(len(rows.node)), rows.shear.flat(weight).ravel()])
    answer = frozen.answer(every.spread(forces))
    field = np.zeros(model.shape)
    field[model.free] = answer
    inertia = float(np.sum(field * (model.mass @ field)))
    return inertia, max(float(forces @ every.along(frozen.sense(answer))) - inertia, 0.0)
