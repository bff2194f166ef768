"""Anderson mixing of iterates that converge steadily and slowly by operators that are shifted."""

import numpy as np

from softway.arrays import Array
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.methods.anderson import Anderson

DEPTH = 8
"""Number of previous iterates that are mixed."""
STEADY = 4
"""Number of successive decreases of the change, with the same active rows, after which iterates are mixed."""


class LateMixing:
    """Mixing of Newton iterates whose operators are made positive definite.

    The shift of an operator leaves most of a few components in every iteration, also near the solution; far from it
    mixed iterates would go astray.  Other operators contract fast: without a shift nothing is mixed.

    Examples
    --------
    >>> from softway.bodies.assembled.vector_space import LocalSpace
    >>> mixing = LateMixing(Anderson(2, LocalSpace(())), shifted=True)
    >>> [mixing.steady(change, kept=True) for change in (9.0, 5.0, 6.0, 5.0, 4.0, 3.0, 2.0)]
    [False, False, False, False, False, False, True]
    """

    __slots__ = ("accelerator", "decreases", "last", "shifted")

    def __init__(self, accelerator: Anderson, shifted: bool) -> None:
        self.accelerator, self.shifted = accelerator, shifted
        self.decreases, self.last = 0, np.inf

    @classmethod
    def of(cls, system: SlabEquations) -> "LateMixing":
        """Mixing for the operators of a slab."""
        return cls(Anderson(DEPTH, system.model.space.of_unknowns), system.stiffness.positive_definite)

    def steady(self, change: float, kept: bool) -> bool:
        """True if the iterate with this change is mixed; ``kept`` if its active rows are those of the one before."""
        self.decreases = self.decreases + 1 if kept and change < self.last else 0
        self.last = change
        if self.decreases < STEADY:
            self.accelerator.restart()
        return self.shifted and self.decreases >= STEADY

    def mixed(
        self, system: SlabEquations, before: Array, q: Array, impulse: Array
    ) -> tuple[Array, Array, Evaluation] | None:
        """Next q (n, d) and impulses (m,) with their evaluation, from the last q ``before`` and the iterate.

        None if the mixture is not admissible.
        """
        dofs = system.model.dofs
        found = self.accelerator.mix(dofs.unknowns(before), np.concatenate([dofs.unknowns(q), impulse]))
        new, pressed = dofs.nodes(found[: len(found) - len(impulse)], system.given), found[len(found) - len(impulse) :]
        end = system.evaluate(new, pressed)
        return (new, pressed, end) if system.model.space.every(np.isfinite(end.residual)) else None
