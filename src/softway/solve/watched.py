"""A method that can be called off between two iterates."""

from collections.abc import Iterator
from dataclasses import dataclass

from softway.errors import Cancel, heed
from softway.solve.carry import Carry
from softway.solve.driver import Iterate
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.solve.system import SlabSystem
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Watched:
    """A method whose iterates come until ``cancel`` says that no more are wanted, in the slab from the time ``when``
    [s] on.
    """

    method: FixedPoint | Newton
    cancel: Cancel
    when: float

    @property
    def tolerance(self) -> float:
        """That of the method."""
        return self.method.tolerance

    @property
    def limit(self) -> int:
        """That of the method."""
        return self.method.limit

    def iterate(
        self, system: SlabSystem, q: Array, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        """Those of the method.

        Raises
        ------
        Cancelled
            Before the next one is computed.
        """
        heed(self.cancel, self.when)
        for it in self.method.iterate(system, q, carry, impulse, active):
            yield it
            heed(self.cancel, self.when)
