"""What a contact rule hands to the march: the solved slab and its contact events, as arrays."""

from dataclasses import dataclass

import numpy as np

from softway.bodies.solid import Tool
from softway.contact.candidates import Candidates
from softway.march.rub import Rub
from softway.march.situation import Situation
from softway.march.step import Event
from softway.model import Model
from softway.solve.driver import Solution
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.time.slab import Slab
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Outcome:
    """A solved slab.

    Parameters
    ----------
    system, solution
        The equations and their solution.
    rows
        Contact rows at the end of the slab.
    velocity, acceleration
        (n, d) at the end of the slab.
    closed, pressure
        (m,) contact rows that touch at the end, and their normal force there [N].
    force
        (m,) normal force over the slab, impulse / h [N].
    push, support
        (n, d) mean forces of contact and of supports on the nodes [N].
    work
        Work of driven tools and supports [J].
    dissipation
        Energy lost in velocity jumps [J].
    events
        Touches and releases, places that stick and slip.
    pairs
        Number of pairs that the search found.
    passes
        How often the slab was solved.
    iterations
        Over all passes.
    rub
        Friction over the slab; None where there is none.
    """

    system: SlabSystem
    solution: Solution
    rows: Candidates
    velocity: Array
    acceleration: Array
    closed: BoolArray
    pressure: Array
    force: Array
    push: Array
    support: Array
    work: float
    dissipation: float
    events: tuple[Event, ...]
    pairs: int
    passes: int
    iterations: int
    rub: Rub | None = None


def supports(model: Model, now: Situation, end: Evaluation, velocity: Array, push: Array, span: float) -> Array:
    """Mean force (n, d) of the supports on the nodes [N]; ``push`` (n, d) is that of contact."""
    if model.free.all():
        return np.zeros(model.shape)
    inertia = model.mass @ ((velocity - now.start.velocity) / span)
    return np.where(model.free, 0.0, inertia + end.mean_force - model.slab_load(end.scalar) - push)


def contact_event(
    model: Model,
    now: Situation,
    slab: Slab,
    rows: Candidates,
    end: Array,
    row: int,
    kind: str,
    tau: float,
    speeds: tuple[float, float],
    impulse: float = 0.0,
) -> Event:
    """The event of a contact row at ``tau``; its place lies between those at both slab ends, on a tool exactly."""
    node, contact = int(rows.node[row]), int(rows.contact[row])
    part = model.parts[model.part_of[node]]
    u0 = now.start.displacement[node]
    time, place = slab.start + tau * slab.span, model.points[node] + u0 + tau * (end[node] - u0)
    opponent = model.scene.bodies[model.scene.contacts[contact].opponent]
    if isinstance(opponent, Tool):
        gap, normal = opponent.at(time).gap_and_normal(place[None])
        place = place - gap[0] * normal[0]
    return Event(
        time=time,
        contact=rows.labels[contact],
        kind=kind,
        node=node - part.rows.start,
        position=place,
        velocity_before=speeds[0],
        velocity_after=speeds[1],
        impulse=impulse,
    )
