"""End of slip inside a slab (time step): the slab ends at the instant at which a body comes to rest."""

import numpy as np

from softway.arrays import Array
from softway.errors import Halts
from softway.marching.results.slab_result import SlabResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model

SLOWED = 0.5
"""Ratio of the velocities at end and start of a slab above which a body does not come to rest."""
EARLY = 1e-6
"""Fraction of a slab before which a body is at rest from its start."""
LATE = 1.0 - 1e-9
"""Fraction of a slab after which the instant is its end."""
BACK = 1e-3
"""Power of the slip back at the end of a slab, relative to that of the slip at its start, above which a body was driven
back."""
WHOLE = 1.0 - 1e-6
"""Part of the friction of steady slip above which a body is in steady slip up to the end of the slab."""
STIFF = 4.0
"""Energy of the change of slip, relative to the strain energy due to friction, above which friction and not elasticity
stops the body."""


def slip_end(model: Model, now: ModelState, out: SlabResult, span: float) -> None:
    """Refuse a slab inside which a slipping contact comes to rest.

    Friction reverses or vanishes when its power crosses zero: a slab beyond that instant would push the body back.
    Contact nodes with inertia stick then up to the end of the slab: it is refused if the body would slide back earlier.

    Raises
    ------
    Halts
        With the fraction of the slab up to the first such instant.
    """
    first = out.system.contact.initial.rows
    if not first.shear.count:
        return
    weight = -now.traction * (now.sliding & now.closed)[:, None]
    ends, massive = (now.start.velocity, out.solution.last.q), model.space.every(model.massive)
    slipping, found = out.solution.last.active[len(first.node) :], []
    for contact in np.unique(first.contact[weight.any(axis=1)]).tolist():
        here = weight * (first.contact == contact)[:, None]
        slides = here * slipping[:, None] if massive else here
        here = slides if slides.any() else here
        one, other = (float(np.sum(here * first.shear.slip(span * (model.follow @ v)))) for v in ends)
        if other < SLOWED * one:
            stuck = massive and not slipping[here.any(axis=1)].any()
            fraction = _stopped(model, now, out, here, span, stuck)
            if EARLY < fraction < LATE:
                found.append(fraction)
    if found:
        raise Halts(min(found))


def _slides_back(before: float, after: float, steady: float, part: float) -> bool:
    """True if a body whose slip ends in a slab with a ``part`` of the friction of steady slip is driven or slides back.

    ``before`` and ``after`` are the powers at the ends of the slab, ``steady`` the one at its end in steady slip.  They
    change by the other forces and by friction, which has the other sign after the stop.
    """
    friction = (after - steady) / (1.0 - part)
    back = after < -BACK * before or steady - before + 2.0 * friction < 0.0
    return steady < 0.0 < friction and back


def _stopped(model: Model, now: ModelState, out: SlabResult, weight: Array, span: float, stuck: bool) -> float:
    """Fraction of the slab after which friction stops a body with friction forces ``weight`` (m, d); 1 if it does not.

    The response z of the slab to these forces has the kinetic part e = z.Mz and the elastic part E = z.Az - z.Mz.  The
    power of the slip is ``z.Mv``.  To change it by P the forces need the energy ``P^2/2e``; the strain energy due to
    them is ``h^2 E/8``.  Friction stops the body if the first energy is greater, its elasticity if the second is.
    Nodes with inertia are ``stuck`` up to the end of the slab, with a part of their friction: if the body would slide
    back, the power is continued from the start of the slab instead.
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
    velocities = now.start.velocity, out.solution.last.q, now.start.velocity + span * now.acceleration
    before, after, steady = (model.space.total(moved * v) - tool for v in velocities)
    part = -float(np.sum(weight * out.friction.mean)) / float(np.sum(weight**2))
    if stuck:
        after = steady if part < WHOLE and _slides_back(before, after, steady, part) else before
    if not before > 0.0 > after or (before - after) ** 2 <= STIFF * 0.25 * span**2 * inertia * elastic:
        return 1.0
    return before / (before - after)
