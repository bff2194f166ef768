"""Attempt at a slab (time step) in progress."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import nan

from softway.solve.effort import Effort


@dataclass(frozen=True, slots=True, kw_only=True)
class Trying:
    """State of an attempt at a slab.

    Parameters
    ----------
    slab
        Number of the slab, from 1 at the start of the march; 0 for the equilibrium at the start.
    time, span
        Start and length of the slab [s].
    iteration
        Number of iterates so far; 0 before the first one.
    change
        Change of velocity by the last iterate, relative to the greatest velocity.
    active
        Number of contact rows with a force.
    doing
        What is being done inside the next iterate; empty at the start of the attempt and after an iterate.
    seconds
        Estimate of the time that this takes [s].

    Examples
    --------
    >>> print(Trying(slab=3, time=0.25, span=0.125, iteration=17, change=3e-4, active=12))
    slab 3 at t = 0.25 s, h = 0.125 s: iteration 17, relative change 3.0e-04, 12 active rows
    >>> print(Trying(slab=0, iteration=0, doing="factoring 90000 unknowns"))
    equilibrium at the start: factoring 90000 unknowns
    """

    slab: int
    time: float = 0.0
    span: float = 0.0
    iteration: int
    change: float = nan
    active: int = 0
    doing: str = ""
    seconds: float = 0.0

    def __str__(self) -> str:
        where = f"slab {self.slab} at t = {self.time:.6g} s, h = {self.span:.3g} s"
        done = f"iteration {self.iteration}, relative change {self.change:.1e}, {self.active} active rows"
        words = [done] * (self.iteration > 0) + [self.doing] * bool(self.doing)
        return f"{where if self.slab else 'equilibrium at the start'}: {', '.join(words) or 'begins'}"


TryWatch = Callable[[Trying], None]
"""Callback at the start of an attempt at a slab, after every iterate and inside it.  It is called often and must be
fast."""


def watched(
    trying: TryWatch | None, slab: int = 0, time: float = 0.0, span: float = 0.0
) -> Callable[[Effort, str, float], None] | None:
    """Callback of the counted work of an attempt, which begins now; None without a watch."""
    if trying is None:
        return None
    begun = Trying(slab=slab, time=time, span=span, iteration=0)
    trying(begun)

    def tell(effort: Effort, doing: str, seconds: float) -> None:
        trying(
            replace(
                begun,
                iteration=effort.iterations,
                change=effort.change,
                active=effort.active,
                doing=doing,
                seconds=seconds,
            )
        )

    return tell
