"""Step of all methods: correction by an operator with contact."""

from collections.abc import Callable
from dataclasses import dataclass

from softway.arrays import Array, BoolArray
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.friction_contact import solve_friction
from softway.solve.constraints.normal_active_set import solve_normal_contact, without_contact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactStep:
    """Corrected q (n, d) that satisfies the contact rows.

    ``impulse`` (m,) and ``active`` (m,) belong to the rows.  ``bare`` gives the components (m,) of the rows without
    contact forces.  The step is ``settled`` if its multipliers and gaps agree with the active rows; forces of slip
    still ``miss`` a velocity [m/s].
    """

    q: Array
    impulse: Array
    active: BoolArray
    bare: Callable[[], Array]
    settled: bool = True
    missed: float = 0.0


def contact_step(
    system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array, active: BoolArray
) -> ContactStep:
    """Compute ``y = q - P (r - G^T p)`` and ``y + P G^T (p_new - p)`` from the impulses p (m,) and active rows (m,)."""
    dofs = system.model.dofs
    rows, conditions = system.conditions(q, end, frozen)
    before = rows.spread(impulse)
    free = dofs.unknowns(q) - frozen.solve(dofs.forces(end.residual) - frozen.prolong(before))
    solve = solve_normal_contact if conditions.slipping.frictionless else solve_friction
    solved, pressed, now = solve(free, frozen, rows, conditions, active, impulse, system.effort)
    return ContactStep(
        q=dofs.nodes(solved, system.given),
        impulse=pressed,
        active=now,
        bare=lambda: rows.from_basis(without_contact(free, frozen, before)),
    )
