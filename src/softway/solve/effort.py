"""Counted work of one attempt at a slab (time step), with its limit and progress lines."""

from collections.abc import Callable
from math import inf, nan

from softway.errors import NoConvergence
from softway.solve.linear.interface import Factor

EARLY = 50
"""Iterates whose steps are allowed before they are made: the first contact problem of a slab is the hardest."""
SPEED = 2e9
"""Floating-point operations of a sparse factorisation per second, for the estimate that is shown."""


class Effort:
    """Counted work of one attempt at a slab: iterates, factors, and steps of the contact problems.

    It knows, too, if the last operator of the attempt was indefinite, and how often no forces let the rows at rest
    stick (``unstuck``).

    A step is an exchange of active rows, a step of Newton's method for friction, or a Gauss-Seidel sweep.  Counts alone
    end an attempt, so that every machine decides alike.

    Parameters
    ----------
    limit
        Steps of the contact problems for each iterate, and as many for ``EARLY`` iterates in advance, above which the
        attempt is given up.
    tell
        Callback with the effort, a text that says what is being done, and an estimate of the seconds that it takes; the
        text is empty after an iterate.

    Examples
    --------
    >>> effort = Effort(limit=0.02, tell=lambda effort, doing, seconds: print(effort.iterations, doing or "done"))
    >>> effort.step("exchange 1 of 5 active rows")
    0 exchange 1 of 5 active rows
    >>> effort.iterated(1, 0.5, 5)
    1 done
    >>> effort.step("exchange 1 of 5 active rows")
    Traceback (most recent call last):
    softway.errors.NoConvergence: attempt given up after 1 iterations, 0 factors and 2 steps of the contact problems, \
of 1 allowed; the last: exchange 1 of 5 active rows
    """

    __slots__ = (
        "_tell",
        "_factor",
        "active",
        "change",
        "factors",
        "iterates",
        "iterations",
        "limit",
        "steps",
        "unstuck",
    )

    def __init__(self, limit: float = inf, tell: Callable[["Effort", str, float], None] | None = None) -> None:
        self.limit, self._tell = limit, tell
        self.iterations, self.change, self.active = 0, nan, 0
        self.iterates = self.factors = self.steps = self.unstuck = 0
        self._factor: Factor | None = None

    def tell(self, doing: str, seconds: float = 0.0) -> None:
        """Say what is being done, and about how long it takes [s]."""
        if self._tell is not None:
            self._tell(self, doing, seconds)

    def iterated(self, iteration: int, change: float, active: int) -> None:
        """Take an iterate: its number, its change relative to the greatest velocity, and its active rows."""
        self.iterations, self.change, self.active = iteration, change, active
        self.iterates += 1
        self.tell("")

    def factor(self, size: int, operations: float) -> None:
        """Count a factor of ``size`` unknowns that takes about so many floating-point operations, before it is made."""
        self.factors += 1
        self._factor = None
        self.restored(size, operations)

    def restored(self, size: int, operations: float) -> None:
        """Tell a factor that is made again; the attempt counts its own ones, as if the march had not been resumed."""
        self.tell(f"factoring {size} unknowns, about {operations:.0e} operations", operations / SPEED)

    def factored(self, factor: Factor) -> None:
        """Take the factor that was made."""
        self._factor = factor

    @property
    def indefinite(self) -> bool:
        """True if the last operator is not positive definite, or could not be factored."""
        return self.factors > 0 and (self._factor is None or self._factor.indefinite)

    def step(self, doing: str) -> None:
        """Count a step of a contact problem, before it is made.

        Raises
        ------
        NoConvergence
            If the steps are used up.
        """
        self.steps += 1
        allowed = self.limit * (self.iterates + EARLY)
        if self.steps > allowed:
            raise NoConvergence(
                f"attempt given up after {self.iterates} iterations, {self.factors} factors and {self.steps} steps of "
                f"the contact problems, of {allowed:.0f} allowed; the last: {doing}"
            )
        self.tell(doing)
