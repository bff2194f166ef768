"""The frozen operator of the next slab: kept, turned with the nodes, made anew, or made again as it was."""

from dataclasses import replace
from typing import Literal

from softway.bodies.past import remembering
from softway.solve.carry import Carry, Origin, Taken
from softway.solve.frozen import Frozen
from softway.solve.operators import Choice, Made, Operator, choose
from softway.solve.system import SlabSystem
from softway.solve.turning import SMALL, turning
from softway.typing import Array

WORTH = 0.1
"""Turning, as ``SMALL``, that is worth giving up contact directions that never change, whose answers are kept."""


def prepared(system: SlabSystem, q: Array, carry: Carry, operator: Operator | Literal["auto"]) -> Carry:
    """The carry with a frozen operator that fits the slab, of which q (n, d) is a first guess."""
    serves = not carry.stale and abs(carry.span / system.reach - 1.0) <= 1e-9
    carry = restored(system, carry, serves)
    if carry.frozen is None or not serves:
        carry = renewed(system, q, carry, operator)
    return carry if system.model.linear else _turned(system, carry)


def restored(system: SlabSystem, carry: Carry, serves: bool) -> Carry:
    """A bare carry with what the next slab uses of its operator: all of it, or the symbolic work for a new one."""
    origin = carry.origin
    if carry.frozen is not None or origin is None or origin.operator is None:
        return carry
    matrix, analysis = origin.stiffness(system.model), None
    if origin.analyst is not None and not (serves and origin.analyst == origin.operator):
        analysis = origin.analyst.make(matrix, origin.at, None).analysis
    if not serves:
        return replace(carry, analysis=analysis)
    made = origin.operator.make(matrix, origin.at, analysis)
    frozen = made.frozen(system.directions(turning=carry.mixed)).filled(carry.batches)
    return replace(carry, frozen=frozen, analysis=made.analysis)


def renewed(system: SlabSystem, q: Array, carry: Carry, operator: Operator | Literal["auto"]) -> Carry:
    """The carry with an operator made at the start of the slab, or where the guess ends if matter asks how it moved."""
    u = system.path.end(q) if remembering(system.model.parts) else system.start.displacement
    choice = carry.choice
    if choice is None:
        choice = choose(system) if operator == "auto" else Choice(operator=operator, reason="as asked for")
    made = choice.operator.make(system.stiffness, u, carry.analysis)
    return replace(
        carry,
        frozen=made.frozen(system.directions()),
        origin=Origin.of(system, u, choice.operator, analyst(carry, made, choice.operator)),
        choice=choice,
        analysis=made.analysis,
        span=system.reach,
        stale=False,
        factorisations=carry.factorisations + 1,
        taken=Taken(),
        price=made.price,
    )


def analyst(carry: Carry, made: Made, operator: Operator) -> Operator | None:
    """What did the symbolic work that an operator made with a carry uses."""
    if made.analysis is None or carry.analysis is None or carry.origin is None:
        return None if made.analysis is None else operator
    return carry.origin.analyst


def _turned(system: SlabSystem, carry: Carry) -> Carry:
    """The carry with the turning of the nodes from where the operator was made to the start of the slab."""
    frozen, measure = carry.frozen, carry.turning or turning(system.model.parts)
    assert frozen is not None and carry.origin is not None
    fixed = frozen.basis.component is None and frozen.basis.directions.shape[1] > 0
    limit = WORTH if fixed else SMALL
    R = measure.since(carry.origin.at, system.start.displacement, system.model.free, limit)
    if R is not None and frozen.basis.component is None:
        frozen = Frozen(frozen.factor, system.directions(turning=True), local=frozen.local, kind=frozen.kind)
    return replace(carry, frozen=frozen.turned(R), turning=measure)
