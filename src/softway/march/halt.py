"""The end of slip inside a slab: a body that comes to rest on its opponent ends the slab at that instant."""

import numpy as np

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


def halt(model: Model, now: Situation, out: Outcome, span: float) -> float | None:
    """Share of the slab after which a contact that slipped comes to rest; None if there is none.

    The velocity of a contact is the mean over the places that slipped, weighted by their friction at the start, of the
    velocities of the nodes with inertia behind, relative to the opponent.  Friction turns round or vanishes where it
    crosses zero: a slab that goes on beyond that instant would push the body back.
    """
    first = out.system.path.rows
    if first.shear is None or now.traction is None or now.sliding is None:
        return None
    weight = -now.traction * (now.sliding & now.closed)[:, None]
    if not weight.any():
        return None
    shares = []
    for contact in np.unique(first.contact[weight.any(axis=1)]).tolist():
        here = weight * (first.contact == contact)[:, None]
        before, after = (
            float(np.sum(here * first.shear.slip(span * (model.follow @ v)))) / span
            for v in (now.start.velocity, out.solution.last.q)
        )
        share = before / (before - after) if before > 0.0 > after else 1.0
        if EARLY < share < LATE and _stops(model, out, here, before, span):
            shares.append(share)
    return min(shares, default=None)


def _stops(model: Model, out: Outcome, weight: Array, power: float, span: float) -> bool:
    """Whether friction with the forces ``weight`` (m, d) and the power stops a body, or its elasticity does.

    The answer z of the slab to these forces has the kinetic part e = z.Mz and the elastic one E = z.Az - z.Mz.  What
    they take to stop the slip is the energy ``power^2/2e``, and they hold the strain energy ``h^2 E/8``.
    """
    frozen, rows = out.solution.last.carry.frozen, out.system.path.rows
    assert frozen is not None and rows.shear is not None
    every = frozen.coefficients(rows, model.free)
    forces = np.concatenate([np.zeros(len(rows.node)), rows.shear.flat(weight).ravel()])
    answer = frozen.answer(every.spread(forces))
    field = np.zeros(model.shape)
    field[model.free] = answer
    inertia = float(np.sum(field * (model.mass @ field)))
    elastic = float(forces @ every.along(frozen.sense(answer))) - inertia
    return power**2 > STIFF * 0.25 * span**2 * inertia * max(elastic, 0.0)
