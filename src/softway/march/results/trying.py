"""Attempt at a slab (time step) in progress."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Trying:
    """Iterate of an attempt at a slab.

    Parameters
    ----------
    slab
        Number of the slab, from 1 at the start of the march.
    time, span
        Start and length of the slab [s].
    iteration
        Number of the iterate, from 1.
    change
        Change of velocity by the iterate, relative to the greatest velocity.
    active
        Number of contact rows with a force.

    Examples
    --------
    >>> print(Trying(slab=3, time=0.25, span=0.125, iteration=17, change=3e-4, active=12))
    slab 3 at t = 0.25 s, h = 0.125 s: iteration 17, relative change 3.0e-04, 12 active rows
    """

    slab: int
    time: float
    span: float
    iteration: int
    change: float
    active: int

    def __str__(self) -> str:
        return (
            f"slab {self.slab} at t = {self.time:.6g} s, h = {self.span:.3g} s: iteration {self.iteration}, "
            f"relative change {self.change:.1e}, {self.active} active rows"
        )


TryWatch = Callable[[Trying], None]
"""Callback after every iterate of an attempt at a slab.  It is called often and must be fast."""
