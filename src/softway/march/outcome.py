"""What a contact rule hands to the march: the solved slab and its contact events, as arrays."""

from dataclasses import dataclass

from softway.march.situation import Situation
from softway.march.step import Event
from softway.model import Model
from softway.solve.driver import Solution
from softway.solve.system import SlabSystem
from softway.time.slab import Slab
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Outcome:
    """A solved slab.

    Parameters
    ----------
    system, solution
        The equations and their solution.
    velocity, acceleration
        (n, d) at the end of the slab.
    closed, pressure
        (m,) contact rows that touch at the end, and their normal force there [N].
    force
        (m,) normal force over the slab, impulse / h [N].
    dissipation
        Energy lost in velocity jumps [J].
    events
        Touches and releases.
    passes
        How often the slab was solved.
    iterations
        Over all passes.
    """

    system: SlabSystem
    solution: Solution
    velocity: Array
    acceleration: Array
    closed: BoolArray
    pressure: Array
    force: Array
    dissipation: float
    events: tuple[Event, ...]
    passes: int
    iterations: int


def contact_event(
    model: Model,
    now: Situation,
    slab: Slab,
    end: Array,
    row: int,
    kind: str,
    tau: float,
    speeds: tuple[float, float],
    impulse: float = 0.0,
) -> Event:
    """The event of a contact row at ``tau``; its place lies on the obstacle, between those at both slab ends."""
    pairs = model.pairs
    node, contact = int(pairs.node[row]), int(pairs.contact[row])
    part = next(p for p in model.parts if p.rows.start <= node < p.rows.stop)
    u0 = now.start.displacement[node]
    u = u0 + tau * (end[node] - u0)
    place = pairs.points[row] + u
    shape = pairs.shapes[contact]
    place = place - shape.gap(place) * shape.normal_at(place)
    return Event(
        time=slab.start + tau * slab.span,
        contact=pairs.reference.labels[contact],
        kind=kind,
        node=node - part.rows.start,
        position=place,
        velocity_before=speeds[0],
        velocity_after=speeds[1],
        impulse=impulse,
    )
