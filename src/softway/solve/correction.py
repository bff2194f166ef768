"""The step that all methods share: what an operator makes of a residual, corrected for contact."""

from dataclasses import dataclass

from softway.solve.along import Along
from softway.solve.friction import rubbed
from softway.solve.frozen import Frozen
from softway.solve.normal import constrain
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Correction:
    """A corrected q (n, d), which satisfies the contact rows.

    ``rows`` are the contact rows along the directions of the operator, ``free`` (f,) what it makes of the residual
    alone; ``impulse`` (m,) and ``active`` (m,) belong to the rows.
    """

    q: Array
    rows: Along
    free: Array
    impulse: Array
    active: BoolArray


def corrected(
    system: SlabSystem, frozen: Frozen, q: Array, end: Evaluation, impulse: Array, active: BoolArray
) -> Correction:
    """``y = q - P (r - G^T p)`` and ``y + P G^T (p_new - p)`` for the impulses p (m,) and active rows (m,) so far."""
    keep = system.model.free
    rows, conditions = system.conditions(q, end, frozen)
    free = q[keep] - frozen.solve(end.residual[keep] - frozen.push(rows.spread(impulse)))
    solve = constrain if conditions.slipping is None else rubbed
    solved, pressed, now = solve(free, frozen, rows, conditions, active, impulse)
    new = system.filled()
    new[keep] = solved
    return Correction(q=new, rows=rows, free=free, impulse=pressed, active=now)
