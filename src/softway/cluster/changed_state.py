"""Every array of a march state over nodes, points and contact rows, changed to another numbering of the nodes."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from softway.arrays import Array
from softway.bodies.assembled.material_states import MaterialStates
from softway.bodies.internal_force.material_state import MaterialState
from softway.contact.contact_rows import ContactRows
from softway.marching.state.march_state import MarchState
from softway.solve.operators import Operator
from softway.solve.operators.operator_memory import OperatorMemory


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Change:
    """Change of the parts of a march state; each function is called in the same order for every state.

    Parameters
    ----------
    nodal
        Changes a nodal field (n, ...).
    material
        Changes the material state of the solid with this number.
    rows
        Changes contact rows.
    operator
        Changes the operator that a memory names.
    """

    nodal: Callable[[Array], Array]
    material: Callable[[int, MaterialState], MaterialState]
    rows: Callable[[ContactRows], ContactRows]
    operator: Callable[[Operator], Operator]


def changed_state(state: MarchState, change: Change) -> MarchState:
    """March state with changed parts."""
    model_state = state.state
    start, rows = model_state.start, model_state.rows
    start = replace(
        start,
        displacement=change.nodal(start.displacement),
        velocity=change.nodal(start.velocity),
        force=change.nodal(start.force),
        viscous=None if start.viscous is None else change.nodal(start.viscous),
        states=_materials(start.states, change),
        fields=tuple(replace(f, values=change.nodal(f.values), force=change.nodal(f.force)) for f in start.fields),
    )
    acceleration = change.nodal(model_state.acceleration)
    changed = replace(
        model_state, start=start, acceleration=acceleration, rows=None if rows is None else change.rows(rows)
    )
    return replace(state, state=changed, memory=_memory(state.memory, change))


def _materials(states: MaterialStates, change: Change) -> MaterialStates:
    """Changed material states."""
    return tuple(None if s is None else change.material(k, s) for k, s in enumerate(states))


def _memory(memory: OperatorMemory, change: Change) -> OperatorMemory:
    """Changed memory, and memories of other lengths."""
    origin, choice = memory.origin, memory.choice
    if origin is not None:
        maker, analyst = (None if o is None else change.operator(o) for o in (origin.operator, origin.analyst))
        at, states = change.nodal(origin.at), _materials(origin.states, change)
        origin = replace(origin, operator=maker, analyst=analyst, at=at, states=states)
    if choice is not None:
        choice = replace(choice, operator=change.operator(choice.operator))
    others = tuple(_memory(other, change) for other in memory.others)
    return replace(memory, origin=origin, choice=choice, others=others)
