"""Methods that can be cancelled between two iterates."""

from collections.abc import Iterator
from dataclasses import dataclass

from softway.errors import Cancel, heed
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess, Iterate
from softway.solve.methods.newton import Newton


@dataclass(frozen=True, slots=True, kw_only=True)
class Cancellable:
    """Method that stops between iterates if ``cancel`` requests it, in the slab from the time ``when`` [s] on."""

    method: FixedPoint | Newton
    cancel: Cancel
    when: float

    @property
    def tolerance(self) -> float:
        """Relative tolerance of the method."""
        return self.method.tolerance

    @property
    def limit(self) -> int:
        """Greatest number of iterations of the method."""
        return self.method.limit

    def iterate(self, system: SlabEquations, guess: Guess) -> Iterator[Iterate]:
        """Iterates of the method from a guess.

        Raises
        ------
        Cancelled
            If ``cancel`` requests it, before the next iterate.
        """
        heed(self.cancel, self.when)
        for it in self.method.iterate(system, guess):
            yield it
            heed(self.cancel, self.when)


def cancellable(method: FixedPoint | Newton, cancel: Cancel | None, when: float) -> FixedPoint | Newton | Cancellable:
    """Make a method cancellable between iterates if there is a ``cancel``, in the slab from ``when`` [s] on."""
    return method if cancel is None else Cancellable(method=method, cancel=cancel, when=when)
