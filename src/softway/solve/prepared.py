"""The frozen operator of the next slab: kept, turned with the nodes, or made anew."""

from dataclasses import replace
from typing import Literal

from softway.bodies.past import remembering
from softway.solve.carry import Carry
from softway.solve.frozen import Frozen
from softway.solve.operators import Choice, Operator, choose
from softway.solve.system import SlabSystem
from softway.solve.turning import SMALL, turning
from softway.typing import Array

WORTH = 0.1
"""Turning, as ``SMALL``, that is worth giving up contact directions that never change, whose answers are kept."""


def prepared(system: SlabSystem, q: Array, carry: Carry, operator: Operator | Literal["auto"]) -> Carry:
    """The carry with a frozen operator that fits the slab, of which q (n, d) is a first guess."""
    if carry.frozen is None or carry.stale or abs(carry.span / system.reach - 1.0) > 1e-9:
        carry = renewed(system, q, carry, operator)
    return carry if system.model.linear else _turned(system, carry)


def renewed(system: SlabSystem, q: Array, carry: Carry, operator: Operator | Literal["auto"]) -> Carry:
    """The carry with an operator made at the start of the slab, or where the guess ends if matter asks how it moved."""
    u = system.path.end(q) if remembering(system.model.parts) else system.start.displacement
    choice = carry.choice
    if choice is None:
        choice = choose(system) if operator == "auto" else Choice(operator=operator, reason="as asked for")
    made = choice.operator.make(system, u, carry.analysis)
    return replace(
        carry,
        frozen=made.frozen(system.directions()),
        choice=choice,
        analysis=made.analysis,
        span=system.reach,
        stale=False,
        reference=u,
        factorisations=carry.factorisations + 1,
        taken=(),
        price=made.price,
    )


def _turned(system: SlabSystem, carry: Carry) -> Carry:
    """The carry with the turning of the nodes from where the operator was made to the start of the slab."""
    frozen, measure = carry.frozen, carry.turning or turning(system.model.parts)
    assert frozen is not None and carry.reference is not None
    fixed = frozen.basis.component is None and frozen.basis.directions.shape[1] > 0
    limit = WORTH if fixed else SMALL
    R = measure.since(carry.reference, system.start.displacement, system.model.free, limit)
    if R is not None and frozen.basis.component is None:
        frozen = Frozen(frozen.factor, system.directions(turning=True), local=frozen.local, kind=frozen.kind)
    return replace(carry, frozen=frozen.turned(R), turning=measure)
