"""State as arrays over all solids of a model."""

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, BoolArray
from softway.bodies.assembled import material_states
from softway.contact.contact_rows import ContactRows
from softway.errors import InputError
from softway.model.field import FieldEquations, FieldOfBodies, FieldState, in_states
from softway.model.model import Model
from softway.model.rigid.rigid_state import RigidState
from softway.model.scene import State
from softway.solve.equations.slab_values import SlabStart

Kind = TypeVar("Kind", np.float64, np.bool_)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ModelState:
    """State of a model as joined arrays, with its force and energy; see :class:`~softway.model.scene.State`.

    ``start`` contains displacement, velocity, internal force and stored energy; ``acceleration`` (n, d) is the slope of
    the velocity in the previous slab; ``closed`` (m,) are the rows in contact, ``pressure`` (m,) and ``traction``
    (m, d) their normal and tangential forces, ``sliding`` (m,) the slipping rows; ``rows`` are the rows of these
    forces, None if a search finds the same rows; ``rigid`` is the state of the rigid bodies; ``slip`` (m, d) is the
    mean velocity of the slip in the previous slab, ``span`` its length: None and zero at the start.
    """

    time: float
    start: SlabStart
    acceleration: Array
    closed: BoolArray
    pressure: Array
    traction: Array
    sliding: BoolArray
    rows: ContactRows | None = None
    rigid: RigidState | None = None
    slip: Array | None = None
    span: float = 0.0

    def force_rows(self, rows: ContactRows) -> ContactRows:
        """Rows of the contact forces at the start of a slab; ``rows`` are those found by its search.

        By rounding, the search may find other facets than in the previous slab if several are possible; the forces stay
        on the previous ones.  Tools move as in the new slab.
        """
        if self.rows is None:
            return rows
        old, new = self.rows.shear, rows.shear
        return replace(self.rows, tool_motion=rows.tool_motion, shear=replace(old, moved=new.moved))


def join_states(model: Model, state: State, span: float = 1.0) -> ModelState:
    """Join a state to arrays of the model; force and energy are computed again.

    Path-dependent materials without history variables in the state reach its displacement in one slab of length
    ``span`` [s].

    Raises
    ------
    InputError
        If the state belongs to another scene.
    """
    ours = {p.name: (p.mesh.n_nodes, p.mesh.dim) for p in model.parts}
    theirs = {name: u.shape for name, u in state.displacement.items()}
    named = {c.field.name for c in model.companions}
    if named != set(state.fields):
        raise InputError("state", f"fields {sorted(state.fields)}", f"a state with the fields {sorted(named)}")
    if ours != theirs or set(state.closed) != set(model.contacts.labels):
        raise InputError("state", f"bodies {theirs} and contacts {sorted(state.closed)}", f"a state of {ours}")
    u = model.join(state.displacement)
    states = _remembered(model, state, u, span)
    energy, force, viscous = material_states.stored_force(model.parts, states, u)
    fields = tuple(_field(model, c, state, u) for c in in_states(model.companions, states))
    labels, count = model.contacts.labels, len(model.contacts.contact)
    rough = not model.friction.frictionless
    return ModelState(
        time=state.time,
        start=SlabStart(
            displacement=u,
            velocity=model.join(state.velocity),
            force=sum((f.force for f in fields), force),
            energy=sum((f.energy for f in fields), energy),
            states=states,
            viscous=viscous,
            fields=fields,
        ),
        acceleration=model.join(state.acceleration),
        closed=np.concatenate([state.closed[n] for n in labels]) if labels else np.zeros(0, bool),
        pressure=np.concatenate([state.pressure[n] for n in labels]) if labels else np.zeros(0),
        traction=np.concatenate([state.traction[n] for n in labels]) if rough else np.zeros((count, model.shape[1])),
        sliding=np.concatenate([state.sliding[n] for n in labels]) if rough else np.zeros(count, bool),
        rigid=None if model.rigid is None else model.rigid.state_of(state.rigid, state.time),
        slip=np.concatenate([state.slip[n] for n in labels]) if rough and state.slip else None,
        span=state.span,
    )


def _field(model: Model, equations: FieldEquations, state: State, u: Array) -> FieldState:
    """State of a companion field."""
    values = state.fields[equations.field.name]
    found = equations.at(model.join(values), u)
    return equations.with_bodies(found, values) if isinstance(equations, FieldOfBodies) else found


def _split_field(model: Model, equations: FieldEquations, state: FieldState) -> dict[str, Array]:
    """Values of a companion field by bodies."""
    rigid = equations.of_bodies(state) if isinstance(equations, FieldOfBodies) else {}
    return {**model.split(state.values), **rigid}


def _remembered(model: Model, state: State, u: Array, span: float) -> material_states.MaterialStates:
    """Material states in a state, and of path-dependent materials without one that of the displacement u (n, d)."""
    known = tuple(state.memory.get(p.name) for p in model.parts)
    if all(m is not None or not p.internal.path_dependent for p, m in zip(model.parts, known, strict=True)):
        return known
    reached = material_states.committed(model.during((), span).parts, u)
    return tuple(r if m is None else m for m, r in zip(known, reached, strict=True))


def split_states(model: Model, state: ModelState) -> State:
    """Split a state by bodies and contacts, with read-only arrays."""
    rows = model.contacts
    for array in (
        state.start.displacement,
        state.start.velocity,
        state.acceleration,
        *(f.values for f in state.start.fields),
    ):
        array.flags.writeable = False
    state.closed.flags.writeable = False
    state.pressure.flags.writeable = False
    state.traction.flags.writeable = state.sliding.flags.writeable = False
    if state.slip is not None:
        state.slip.flags.writeable = False
    return State(
        time=state.time,
        displacement=model.split(state.start.displacement),
        velocity=model.split(state.start.velocity),
        acceleration=model.split(state.acceleration),
        closed={n: state.closed[rows.rows_of(k)] for k, n in enumerate(rows.labels)},
        pressure={n: state.pressure[rows.rows_of(k)] for k, n in enumerate(rows.labels)},
        memory={p.name: m for p, m in zip(model.parts, state.start.states, strict=False) if m is not None},
        traction=_by_contact(model, state.traction),
        sliding=_by_contact(model, state.sliding),
        slip={} if state.slip is None else _by_contact(model, state.slip),
        span=state.span,
        fields={
            c.field.name: _split_field(model, c, f) for c, f in zip(model.companions, state.start.fields, strict=True)
        },
        rigid={} if model.rigid is None or state.rigid is None else model.rigid.bodies(state.rigid),
    )


def _by_contact(model: Model, values: NDArray[Kind]) -> dict[str, NDArray[Kind]]:
    """Values of the rows by contact; empty without friction."""
    rows = model.contacts
    return {} if model.friction.frictionless else {n: values[rows.rows_of(k)] for k, n in enumerate(rows.labels)}
