"""Step of all methods: correction by an operator with contact."""

from dataclasses import dataclass

from softway.arrays import Array, BoolArray
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.friction_contact import solve_friction
from softway.solve.constraints.normal_active_set import solve_normal_contact
from softway.solve.constraints.row_basis import RowCoefficients
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactStep:
    """Corrected q (n, d) that satisfies the contact rows.

    ``rows`` are the contact rows along the directions of the operator, ``free`` (f,) is the correction without new
    contact forces; ``impulse`` (m,) and ``active`` (m,) belong to the rows.
    """

    q: Array
    rows: RowCoefficients
    free: Array
    impulse: Array
    active: BoolArray


def contact_step(
    system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array, active: BoolArray
) -> ContactStep:
    """Compute ``y = q - P (r - G^T p)`` and ``y + P G^T (p_new - p)`` from the impulses p (m,) and active rows (m,)."""
    dofs = system.model.dofs
    rows, conditions = system.conditions(q, end, frozen)
    free = dofs.unknowns(q) - frozen.solve(dofs.forces(end.residual) - frozen.prolong(rows.spread(impulse)))
    solve = solve_normal_contact if conditions.slipping.frictionless else solve_friction
    solved, pressed, now = solve(free, frozen, rows, conditions, active, impulse, system.effort)
    return ContactStep(q=dofs.nodes(solved, system.given), rows=rows, free=free, impulse=pressed, active=now)
