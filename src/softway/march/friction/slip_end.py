"""End of slip inside a slab (time step): the slab ends at the instant at which a body comes to rest."""

import numpy as np

from softway.arrays import Array
from softway.errors import Halts
from softway.march.model_state import ModelState
from softway.march.results.slab_result import SlabResult
from softway.model.model import Model

SLOWED = 0.5
"""Ratio of the velocities at end and start of a slab above which a body does not come to rest."""
EARLY = 1e-6
"""Fraction of a slab before which a body is at rest from its start."""
LATE = 1.0 - 1e-9
"""Fraction of a slab after which the instant is its end."""
STIFF = 4.0
"""Energy of the change of slip, relative to the strain energy due to friction, above which friction and not elasticity
stops the body."""


def slip_end(model: Model, now: ModelState, out: SlabResult, span: float) -> None:
    """Refuse a slab inside which a slipping contact comes to rest.

    Friction reverses or vanishes when its power crosses zero: a slab beyond that instant would push the body back.
    Contact nodes with inertia that stick at the end of the slab have come to rest in it.

    Raises
    ------
    Halts
        With the fraction of the slab up to the first such instant.
    """
    first = out.system.contact.initial.rows
    if not first.shear.count:
        return
    slips = now.sliding & now.closed
    if model.space.every(model.massive):
        slips &= out.friction.sliding
    weight = -now.traction * slips[:, None]
    ends = now.start.velocity, out.solution.last.q
    found = []
    for contact in np.unique(first.contact[weight.any(axis=1)]).tolist():
        here = weight * (first.contact == contact)[:, None]
        one, other = (float(np.sum(here * first.shear.slip(span * (model.follow @ v)))) for v in ends)
        if other < SLOWED * one:
            fraction = _stopped(model, out, here, span, ends)
            if EARLY < fraction < LATE:
                found.append(fraction)
    if found:
        raise Halts(min(found))


def _stopped(model: Model, out: SlabResult, weight: Array, span: float, ends: tuple[Array, Array]) -> float:
    """Fraction of the slab after which friction stops a body with friction forces ``weight`` (m, d); 1 if it does not.

    The response z of the slab to these forces has the kinetic part e = z.Mz and the elastic part E = z.Az - z.Mz.  The
    power of the slip is ``z.Mv``.  To change it by P the forces need the energy ``P^2/2e``; the strain energy due to
    them is ``h^2 E/8``.  Friction stops the body if the first energy is greater, its elasticity if the second is.
    """
    frozen, rows = out.solution.last.memory.frozen, out.system.contact.initial.rows
    assert frozen is not None
    dofs = out.solution.last.system.model.dofs
    every = frozen.coefficients(rows, dofs)
    forces = np.concatenate([np.zeros(len(rows.node)), rows.shear.flat(weight).ravel()])
    response = frozen.solve_push(every.spread(forces))
    field = dofs.nodes(response)
    moved = model.mass @ field
    inertia = model.space.total(field * moved)
    elastic = max(float(forces @ every.from_basis(frozen.restrict(response))) - inertia, 0.0)
    tool = float(np.sum(weight * rows.shear.moved)) / span
    before, after = (model.space.total(moved * v) - tool for v in ends)
    if not before > 0.0 > after or (before - after) ** 2 <= STIFF * 0.25 * span**2 * inertia * elastic:
        return 1.0
    return before / (before - after)
