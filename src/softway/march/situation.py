"""The state as arrays over the whole model, and back."""

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from softway.bodies import past
from softway.contact.candidates import Candidates
from softway.errors import InputError
from softway.model import Model
from softway.scene import State
from softway.solve.values import Start
from softway.typing import Array, BoolArray

Kind = TypeVar("Kind", np.float64, np.bool_)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Situation:
    """A :class:`~softway.scene.State` joined over the model, with the force and energy that belong to it.

    ``start`` holds displacement, velocity, internal force and stored energy; ``acceleration`` (n, d) the slope of
    the velocity in the slab before; ``closed`` and ``pressure`` (m,) the contact rows, ``traction`` (m, d) their
    tangential forces and ``sliding`` (m,) which slip, both None where there is no friction; ``rows`` those that the
    forces were found with, None where a search for them finds the same.
    """

    time: float
    start: Start
    acceleration: Array
    closed: BoolArray
    pressure: Array
    traction: Array | None = None
    sliding: BoolArray | None = None
    rows: Candidates | None = None

    def carrying(self, rows: Candidates) -> Candidates:
        """The rows that carry the forces at the start of a slab, where the search for the slab finds ``rows``.

        Surfaces that meet in more than one way may be found otherwise than in the slab before, by rounding; the
        forces stay where they were.  Tools move as in the new slab.
        """
        if self.rows is None:
            return rows
        old, new = self.rows.shear, rows.shear
        shear = old if old is None or new is None else replace(old, moved=new.moved)
        return replace(self.rows, drive=rows.drive, shear=shear)


def joined(model: Model, state: State) -> Situation:
    """The situation of a state; recomputes force and energy.

    Raises
    ------
    InputError
        If the state is that of another scene.
    """
    ours = {p.name: (p.mesh.n_nodes, p.mesh.dim) for p in model.parts}
    theirs = {name: u.shape for name, u in state.displacement.items()}
    if ours != theirs or set(state.closed) != set(model.encounters.labels):
        raise InputError("state", f"bodies {theirs} and contacts {sorted(state.closed)}", f"a state of {ours}")
    u = model.join(state.displacement)
    memory = tuple(state.memory.get(p.name) for p in model.parts)
    energy, force, viscous = past.remembered(model.parts, memory, u)
    labels = model.encounters.labels
    return Situation(
        time=state.time,
        start=Start(
            displacement=u,
            velocity=model.join(state.velocity),
            force=force,
            energy=energy,
            memory=memory,
            viscous=viscous,
        ),
        acceleration=model.join(state.acceleration),
        closed=np.concatenate([state.closed[n] for n in labels]) if labels else np.zeros(0, bool),
        pressure=np.concatenate([state.pressure[n] for n in labels]) if labels else np.zeros(0),
        traction=np.concatenate([state.traction[n] for n in labels]) if model.rubbing is not None else None,
        sliding=np.concatenate([state.sliding[n] for n in labels]) if model.rubbing is not None else None,
    )


def parted(model: Model, situation: Situation) -> State:
    """The state by bodies and contacts, its arrays read-only."""
    rows = model.encounters
    for array in (situation.start.displacement, situation.start.velocity, situation.acceleration):
        array.flags.writeable = False
    situation.closed.flags.writeable = False
    situation.pressure.flags.writeable = False
    if situation.traction is not None and situation.sliding is not None:
        situation.traction.flags.writeable = situation.sliding.flags.writeable = False
    return State(
        time=situation.time,
        displacement=model.split(situation.start.displacement),
        velocity=model.split(situation.start.velocity),
        acceleration=model.split(situation.acceleration),
        closed={n: situation.closed[rows.of(k)] for k, n in enumerate(rows.labels)},
        pressure={n: situation.pressure[rows.of(k)] for k, n in enumerate(rows.labels)},
        memory={p.name: m for p, m in zip(model.parts, situation.start.memory, strict=False) if m is not None},
        traction=_by_contact(model, situation.traction),
        sliding=_by_contact(model, situation.sliding),
    )


def _by_contact(model: Model, values: NDArray[Kind] | None) -> dict[str, NDArray[Kind]]:
    """Values of the rows by contact; nothing where there is no friction."""
    rows = model.encounters
    return {} if values is None else {n: values[rows.of(k)] for k, n in enumerate(rows.labels)}
