"""Slabs that one solution solves: linear laws on rows that never change, with an exact operator.

The residual of the next iterate tells so, and the second solution that would only confirm it is spared
(docs/theory/solver/solver.md).
"""

from collections.abc import Iterator
from dataclasses import dataclass

from softway.arrays import Array
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.methods.iteration import FINEST, Guess, Iterate

SAFE = 1e4
"""Factor by which the operator may amplify what is left of the residual more than the residual itself: enough where
waves cross up to 200 cells in a slab (docs/theory/solver/solver.md, "One solution")."""


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

    def confirmed(
        self, now: Guess, system: SlabEquations, end: Evaluation, made: tuple[Array, float], tolerance: float
    ) -> Iterator[Iterate]:
        """The values ``now``, with their evaluation ``end``, as a second iterate if another solution would change them
        by less than the tolerance; none otherwise.

        ``made`` are the normal components (m,) of the first solution without contact, and the change that it made of
        the first residual [m/s].
        """
        frozen, space = now.memory.frozen, system.model.space
        assert frozen is not None
        left = _left(system, frozen, now.q, end, now.impulse) / max(self.greatest, 1e-300)
        change = max(SAFE * made[1] * left, 2.0 * FINEST * space.greatest(now.q))  # more accurate ones may follow
        if change <= tolerance * space.greatest(now.q, system.start.velocity):
            yield Iterate(
                q=now.q,
                change=change,
                impulse=now.impulse,
                active=now.active,
                free=made[0],
                memory=now.memory,
                system=system,
                sound=True,
                end=end,
            )


def _left(system: SlabEquations, frozen: FrozenOperator, q: Array, end: Evaluation, impulse: Array) -> float:
    """Greatest value of the residual without the contact forces [N s]."""
    rows, _ = system.conditions(q, end, frozen)
    forces = system.model.dofs.forces(end.residual) - frozen.prolong(rows.spread(impulse))
    return system.model.space.greatest(forces)
