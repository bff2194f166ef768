"""Ranks that count what they send, and the time that it takes."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter, process_time
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array
from softway.ranks.interface import Exchange, Ranks

Result = TypeVar("Result")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Counted:
    """One rank, with the numbers of its calls by name, the bytes that it sends in them, and the time that it spends in
    all of them; see :class:`~softway.ranks.interface.Ranks`.

    Parameters
    ----------
    ranks
        The rank that is counted.
    calls, sent
        Calls, and bytes, by the name of the method.
    spent
        Time by the ``clock``, and of the processor, ``cpu`` [s].  Processes that wait for a message of MPI spin.

    Examples
    --------
    >>> from softway.ranks.alone import Alone
    >>> counted = Counted(ranks=Alone())
    >>> counted.added(np.array([1, 2])).tolist(), dict(counted.calls), dict(counted.sent)
    ([1, 2], {'added': 1}, {'added': 16})
    """

    ranks: Ranks
    calls: Counter[str] = field(default_factory=Counter)
    sent: Counter[str] = field(default_factory=Counter)
    spent: dict[str, float] = field(default_factory=lambda: {"clock": 0.0, "cpu": 0.0})

    @property
    def rank(self) -> int:
        """Number of this rank."""
        return self.ranks.rank

    @property
    def size(self) -> int:
        """Number of ranks."""
        return self.ranks.size

    def added(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Sum over the ranks."""
        return self._counted("added", numbers.nbytes, lambda: self.ranks.added(numbers))

    def greatest(self, values: Array) -> Array:
        """Greatest values over the ranks."""
        return self._counted("greatest", values.nbytes, lambda: self.ranks.greatest(values))

    def exchanged(self, exchange: Exchange, field: Array) -> Array:
        """Field with the received values."""
        nodes = sum(map(len, exchange.send.values()))
        size = nodes * int(np.prod(field.shape[1:])) * field.itemsize
        return self._counted("exchanged", size, lambda: self.ranks.exchanged(exchange, field))

    def gathered(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks."""
        return self._counted("gathered", field.nbytes, lambda: self.ranks.gathered(field))

    def collected(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks on rank 0."""
        return self._counted("collected", field.nbytes, lambda: self.ranks.collected(field))

    def told(self, value: Any) -> Any:
        """The value of rank 0."""
        return self._counted("told", 0, lambda: self.ranks.told(value))

    def _counted(self, name: str, size: int, call: Callable[[], Result]) -> Result:
        """Result of a call that sends ``size`` bytes."""
        self.calls[name] += 1
        self.sent[name] += size
        clock, cpu = perf_counter(), process_time()
        found = call()
        self.spent["clock"] += perf_counter() - clock
        self.spent["cpu"] += process_time() - cpu
        return found
