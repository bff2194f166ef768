"""Refresh of the frozen operator for the next slab: it is kept, rotated with the nodes, renewed or restored."""

from dataclasses import replace
from typing import Literal

from softway.arrays import Array
from softway.bodies.assembled.material_states import any_path_dependent
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.operators import BuiltOperator, Operator, OperatorChoice, choose_operator
from softway.solve.operators.choice import factor_operations
from softway.solve.operators.factored import Factored
from softway.solve.operators.nodal_rotation import SMALL, nodal_rotation
from softway.solve.operators.operator_memory import IterationCount, OperatorMemory, OperatorOrigin

WORTH = 0.1
"""Nodal rotation, measured as for ``SMALL``, above which constant directions with stored solutions are given up."""


def refreshed(
    system: SlabEquations, q: Array, memory: OperatorMemory, operator: Operator | Literal["auto"]
) -> OperatorMemory:
    """Operator memory with a frozen operator that fits the slab; q (n, d) is an initial guess."""
    memory = memory.serving(system.equivalent_span)
    serves = not memory.stale and memory.serves(system.equivalent_span)
    memory = restored(system, memory, serves)
    if memory.frozen is None or not serves:
        memory = renewed(system, _place(system, q), memory, operator)
    return memory if system.model.linear else _turned(system, memory)


def restored(system: SlabEquations, memory: OperatorMemory, serves: bool) -> OperatorMemory:
    """Restore a stored memory: its operator if it ``serves`` the next slab, else the symbolic work for a new one."""
    origin = memory.origin
    if memory.frozen is not None or origin is None or origin.operator is None:
        return memory
    matrix, analysis = origin.stiffness(system.model), None
    if origin.analyst is not None and not (serves and origin.analyst == origin.operator):
        analysis = origin.analyst.make(matrix, origin.at, None).analysis
    if not serves:
        return replace(memory, analysis=analysis)
    announce(system, origin.operator, again=True)
    made = origin.operator.make(matrix, origin.at, analysis)
    frozen = made.frozen(system.directions(turning=memory.mixed)).filled(memory.batches)
    return replace(memory, frozen=frozen, analysis=made.analysis)


def renewed(
    system: SlabEquations, u: Array, memory: OperatorMemory, operator: Operator | Literal["auto"]
) -> OperatorMemory:
    """Operator memory with a new operator, made at the displacement ``u`` (n, d)."""
    choice = memory.choice
    if choice is None:
        choice = (
            choose_operator(system) if operator == "auto" else OperatorChoice(operator=operator, reason="as requested")
        )
    announce(system, choice.operator)
    made = choice.operator.make(system.stiffness, u, memory.analysis)
    system.effort.factored(made.factor)
    return replace(
        memory,
        frozen=made.frozen(system.directions()),
        origin=OperatorOrigin.of(system, u, choice.operator, analyst(memory, made, choice.operator)),
        choice=choice,
        analysis=made.analysis,
        span=system.equivalent_span,
        stale=False,
        factorisations=memory.factorisations + 1,
        taken=IterationCount(),
        price=made.price,
        others=() if memory.stale or memory.serves(system.equivalent_span) else memory.others,
    )


def renewed_inside(
    system: SlabEquations, q: Array, memory: OperatorMemory, operator: Operator | Literal["auto"]
) -> OperatorMemory:
    """Operator memory with a new operator, made inside a slab at the end position of the iterate q (n, d)."""
    return replace(renewed(system, system.path.end(q), memory, operator), renewals=memory.renewals + 1)


def _place(system: SlabEquations, q: Array) -> Array:
    """Displacement (n, d) where an operator for the whole slab is made: the start.

    For path-dependent materials and ties that break it is the end position of the guess.
    """
    dependent = any_path_dependent(system.model.parts) or system.model.bonds
    return system.path.end(q) if dependent else system.start.displacement


def announce(system: SlabEquations, operator: Operator, again: bool = False) -> None:
    """Count the factor of a slab before it is made; one that is made ``again`` is told only."""
    if isinstance(operator, Factored):
        tell = system.effort.restored if again else system.effort.factor
        tell(system.model.dofs.size, factor_operations(system.model))


def analyst(memory: OperatorMemory, made: BuiltOperator, operator: Operator) -> Operator | None:
    """Operator that did the symbolic work used by a new operator; None without symbolic work."""
    if made.analysis is None or memory.analysis is None or memory.origin is None:
        return None if made.analysis is None else operator
    return memory.origin.analyst


def _turned(system: SlabEquations, memory: OperatorMemory) -> OperatorMemory:
    """Operator memory with the rotation of the nodes since the operator was made, up to the start of the slab."""
    frozen, measure = memory.frozen, memory.turning or nodal_rotation(system.model.parts)
    assert frozen is not None and memory.origin is not None
    fixed = frozen.basis.component is None and frozen.basis.directions.shape[1] > 0
    limit = WORTH if fixed else SMALL
    R = measure.since(system.model.space, memory.origin.at, system.start.displacement, system.model.dofs, limit)
    if R is not None and frozen.basis.place is not None:
        frozen = FrozenOperator(frozen.factor, system.directions(turning=True), local=frozen.local, kind=frozen.kind)
    return replace(memory, frozen=frozen.turned(R), turning=measure)
