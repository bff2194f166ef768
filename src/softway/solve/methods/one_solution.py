"""Slabs that one solution solves: linear laws on rows that never change, with an exact operator.

The residual of the next iterate tells so, and the second solution that would only confirm it is spared
(docs/theory/solver/solver.md).
"""

from dataclasses import dataclass

from softway.arrays import Array
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation

SAFE = 1e4
"""Factor by which the operator may amplify what is left of the residual more than the residual itself."""


@dataclass(frozen=True, slots=True, eq=False)
class FirstResidual:
    """Residual before the first step of a slab: its ``greatest`` value without the contact forces [N s]."""

    greatest: float

    @classmethod
    def of(
        cls, system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array
    ) -> "FirstResidual | None":
        """Residual at q (n, d) with impulses (m,); None where more than one solution may be needed."""
        fixed = frozen.basis.component is None and frozen.basis.place is not None
        served = fixed and frozen.exact and frozen.turning is None and system.follower is None
        plain = system.model.linear and not system.model.companions and system.contact.conditions.slipping.frictionless
        return cls(_left(system, frozen, q, end, impulse)) if served and plain else None

    def change(
        self, system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array, first: float
    ) -> float:
        """Bound of the change [m/s] that another solution would make at q, if the first one made the change ``first``
        [m/s] of the first residual.
        """
        left = _left(system, frozen, q, end, impulse)
        return SAFE * first * left / self.greatest if self.greatest > 0.0 else first


def _left(system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array) -> float:
    """Greatest value of the residual without the contact forces [N s]."""
    rows, _ = system.conditions(q, end, frozen)
    forces = system.model.dofs.forces(end.residual) - frozen.prolong(rows.spread(impulse))
    return system.model.space.greatest(forces)
