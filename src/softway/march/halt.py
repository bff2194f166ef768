"""The end of slip inside a slab: a body that comes to rest on its opponent ends the slab at that instant."""

import numpy as np

from softway.errors import Halts
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.model import Model
from softway.typing import Array

SLOWED = 0.5
"""Share of the velocity at its start that a body has at the end of a slab in which it does not come to rest."""
EARLY = 1e-6
"""Share of a slab before which a body counts as at rest from its start."""
LATE = 1.0 - 1e-9
"""Share of a slab after which its end is the instant."""
STIFF = 4.0
"""Energy of the change of the slip, in units of the strain energy that its friction holds, above which friction stops
the body, and not its elasticity."""


def halt(model: Model, now: Situation, out: Outcome, span: float) -> None:
    """Refuse a slab inside which a contact that slipped comes to rest.

    Friction turns round or vanishes where its power crosses zero: a slab that goes on beyond that instant would push
    the body back.

    Raises
    ------
    Halts
        With the share of the slab after which the first contact does.
    """
    first = out.system.first
    if first.shear is None or now.traction is None or now.sliding is None:
        return
    weight = -now.traction * (now.sliding & now.closed)[:, None]
    ends = now.start.velocity, out.solution.last.q
    found = []
    for contact in np.unique(first.contact[weight.any(axis=1)]).tolist():
        here = weight * (first.contact == contact)[:, None]
        one, other = (float(np.sum(here * first.shear.slip(span * (model.follow @ v)))) for v in ends)
        if other < SLOWED * one:
            share = _stopped(model, out, here, span, ends)
            if EARLY < share < LATE:
                found.append(share)
    if found:
        raise Halts(min(found))


def _stopped(model: Model, out: Outcome, weight: Array, span: float, ends: tuple[Array, Array]) -> float:
    """Share of the slab after which friction stops a body that forces ``weight`` (m, d) hold; 1 if it does not.

    The answer z of the slab to these forces is the motion that they take up, with the kinetic part e = z.Mz and the
    elastic one E = z.Az - z.Mz.  The power of the slip is ``z.Mv``.  To change it by P the forces take the energy
    ``P^2/2e``; they hold the strain energy ``h^2 E/8``: friction stops the body where the first is greater, and its
    elasticity where the second is.
    """
    frozen, rows = out.solution.last.carry.frozen, out.system.first
    assert frozen is not None and rows.shear is not None
    moving = out.solution.last.system.model.free
    every = frozen.coefficients(rows, moving)
    forces = np.concatenate([np.zeros(len(rows.node)), rows.shear.flat(weight).ravel()])
    answer = frozen.answer(every.spread(forces))
    field = np.zeros(model.shape)
    field[moving] = answer
    moved = model.mass @ field
    inertia = float(np.sum(field * moved))
    elastic = max(float(forces @ every.along(frozen.sense(answer))) - inertia, 0.0)
    tool = float(np.sum(weight * rows.shear.moved)) / span
    before, after = (float(np.sum(moved * v)) - tool for v in ends)
    if not before > 0.0 > after or (before - after) ** 2 <= STIFF * 0.25 * span**2 * inertia * elastic:
        return 1.0
    return before / (before - after)
