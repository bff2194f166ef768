"""What is kept between slabs besides the state: the frozen operator, and when it is worth a new one."""

from dataclasses import dataclass, replace

from softway.solve.frozen import Frozen
from softway.solve.linear import Analysis
from softway.solve.operators import Choice
from softway.solve.turning import Turning
from softway.typing import Array

USUAL = 6
"""Iterations of a slab with a fresh factor, where the slabs since the last one were easier."""
WORN = 1.5
"""Multiple of the least iterations since the factor below which it never counts as worn."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Carry:
    """All of it disposable: without it the next slab makes its own.

    Parameters
    ----------
    frozen
        The operator.
    choice
        How operators are made, and why so.
    span
        The length of the slabs that ``frozen`` serves, of the default weight [s].
    analysis
        Symbolic work of the factor, the same for all lengths.
    turning, reference
        What the turning of nodes is measured with, and from: the displacement (n, d) of the factor [m].
    stale
        Whether the next slab asks for a new factor.
    factorisations
        Factors made so far.
    taken
        Iterations of each slab since the last factor.
    price
        What a factor costs, in iterations.
    """

    frozen: Frozen | None = None
    choice: Choice | None = None
    span: float = 0.0
    analysis: Analysis | None = None
    turning: Turning | None = None
    reference: Array | None = None
    stale: bool = False
    factorisations: int = 0
    taken: tuple[int, ...] = ()
    price: float = 0.0

    def after(self, iterations: int) -> "Carry":
        """The carry after a slab of so many iterations; a factor is ordered where it pays.

        A slab is dear when the last two slabs took more than the slabs since the factor took on average, the price of
        the factor included: to go on with the factor then costs more than to renew it as often as was done.
        """
        taken = (*self.taken, iterations)
        recent = 0.5 * sum(taken[-2:])
        mean = (sum(taken) + self.price) / len(taken)
        dear = len(taken) > 1 and recent > max(mean, WORN * max(min(taken), USUAL))
        return replace(self, taken=taken, stale=self.stale or dear)
