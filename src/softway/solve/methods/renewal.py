"""Renewal of the operator inside a slab (time step): when it pays, and from which iterate the slab goes on."""

from dataclasses import dataclass, replace
from math import inf, isfinite, log

from softway.solve.methods.iteration import Iterate
from softway.solve.operators.operator_memory import USUAL

WINDOW = 10
"""Number of iterations over which the contraction is measured."""
ASTRAY = 100.0
"""Change of an iterate, relative to the least one before, above which the iterates have left their solution."""
RETREATS = 2
"""Number of times that the iterates of a slab may go astray."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Course:
    """Iterates of a slab with one operator.

    Parameters
    ----------
    window
        Number of iterations over which the contraction is measured.
    changes
        Last changes of these iterates [m/s], one more than the window at most.
    last, closest
        Last iterate, and the one with the least change before it: only the next iterate shows that one is admissible.
    before
        Contraction by the operator before, if that was renewed inside the slab for its poor contraction.
    retreats
        Number of times that the iterates of the slab went astray.
    """

    window: int = WINDOW
    changes: tuple[float, ...] = ()
    last: Iterate | None = None
    closest: Iterate | None = None
    before: float = inf
    retreats: int = 0

    def after(self, it: Iterate) -> "Course":
        """Course with one more iterate."""
        known = [i for i in (self.closest, self.last) if i is not None]
        closest = min(known, key=lambda i: i.change, default=None)
        return replace(self, changes=(*self.changes[-self.window :], it.change), last=it, closest=closest)

    @property
    def way_back(self) -> Iterate | None:
        """Iterate to return to if the last one is not admissible, or far from all before it; None otherwise."""
        if self.closest is None or self.retreats == RETREATS:
            return None
        change = self.changes[-1]
        return self.closest if not isfinite(change) or change > ASTRAY * self.closest.change else None

    @property
    def contraction(self) -> float:
        """Mean ratio of successive changes over the window; zero before its end."""
        return contracted(self.changes) if len(self.changes) > self.window else 0.0

    def asks_for_renewal(self, wanted: float, price: float) -> bool:
        """True if a new operator saves iterations on the way to a change ``wanted`` [m/s].

        The iterations that are left at the measured contraction exceed the ``price`` of the operator and the usual
        number with a new one.  An operator that contracts no better than the one before it is the last.
        """
        rate = self.contraction
        return rate < self.before and iterations_left(rate, self.changes[-1] / wanted) > price + USUAL

    def renewed(self) -> "Course":
        """Course with a new operator, from the last iterate or from the way back."""
        if self.way_back is not None:
            return Course(window=self.window, retreats=self.retreats + 1)
        return Course(window=self.window, before=self.contraction, retreats=self.retreats)


def contracted(changes: tuple[float, ...]) -> float:
    """Mean ratio of successive changes.

    Examples
    --------
    >>> contracted((1.0, 0.6, 0.25))
    0.5
    """
    return float((changes[-1] / changes[0]) ** (1.0 / (len(changes) - 1))) if changes[0] > 0.0 else 0.0


def iterations_left(rate: float, distance: float) -> float:
    """Number of iterations that divide a change by ``distance`` at the contraction ``rate``.

    Examples
    --------
    >>> round(iterations_left(0.1, 1e6), 9)
    6.0
    >>> iterations_left(1.0, 1e6)
    inf
    """
    if rate >= 1.0:
        return inf
    return log(max(distance, 1.0)) / -log(rate) if rate > 0.0 else 0.0
