"""Step with contact by elimination of the closed rows inside conjugate gradients; no compliance is computed."""

from collections.abc import Callable

import numpy as np

from softway.arrays import Array, BoolArray
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.elimination.contact_sweeps import Elimination, Equations, normal_sweeps
from softway.solve.elimination.friction_sweeps import friction_sweeps, served
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.linear.conjugate_gradients import Descending
from softway.solve.methods.contact_step import ContactStep, contact_step

Steps = Callable[[SlabEquations, FrozenOperator, Array, Evaluation, Array, BoolArray], ContactStep]


def eliminated(system: SlabEquations, frozen: FrozenOperator) -> bool:
    """True if closed rows are eliminated: by iterative operators, but for friction on the rows of crossing edges."""
    iterative = isinstance(frozen.factor, Descending) and frozen.local is not None
    redundant = system.model.contacts.crossing_edges
    return iterative and not (redundant and not system.contact.conditions.slipping.frictionless)


def pushed_exactly(system: SlabEquations, frozen: FrozenOperator) -> bool:
    """True if the impulses of an iterate do not depend on those before it, but for the closure of the balance."""
    return frozen.exact or (eliminated(system, frozen) and system.contact.conditions.slipping.frictionless)


def contact_steps(system: SlabEquations, frozen: FrozenOperator) -> Steps:
    """Step of the iterations of a slab."""
    if not eliminated(system, frozen):
        return contact_step
    assert isinstance(frozen.factor, Descending) and frozen.local is not None
    elimination = Elimination(frozen.factor, frozen.local, system.model.contacts.crossing_edges)

    def step(
        system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array, active: BoolArray
    ) -> ContactStep:
        law = system.contact.conditions.slipping
        if not law.frictionless and not served(law, impulse[: len(law.sliding)]):
            return contact_step(system, frozen, q, end, impulse, active)
        return _eliminated_step(elimination, system, frozen, q, end, (active, impulse))

    return step


def _eliminated_step(
    elimination: Elimination,
    system: SlabEquations,
    frozen: FrozenOperator,
    q: Array,
    end: Evaluation,
    guess: tuple[BoolArray, Array],
) -> ContactStep:
    dofs = system.model.dofs
    coefficients, conditions = system.conditions(q, end, frozen)
    y, residual = frozen.unturned(dofs.unknowns(q)), frozen.unturned(dofs.forces(end.residual))
    equations = Equations(residual, y, elimination.rows(coefficients, frozen))
    if conditions.slipping.frictionless:
        found = normal_sweeps(elimination, equations, conditions, guess[0], system.effort)
    else:
        found = friction_sweeps(elimination, equations, conditions, guess, system.effort)

    def bare() -> Array:
        rows = equations.matrix
        return np.asarray(rows @ (y + found.d - elimination.local.solve(rows.T @ found.multiplier)))

    return ContactStep(
        q=dofs.nodes(frozen.turned_back(y + found.d), system.given),
        impulse=found.multiplier,
        active=found.active,
        bare=bare,
        settled=found.settled,
        missed=found.missed,
    )
