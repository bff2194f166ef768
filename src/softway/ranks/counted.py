"""Ranks that count what they send."""

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array
from softway.ranks.interface import Exchange, Ranks


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Counted:
    """One rank, with the numbers of its calls by name, and the bytes that it sends in them; see
    :class:`~softway.ranks.interface.Ranks`.

    Parameters
    ----------
    ranks
        The rank that is counted.
    calls, sent
        Calls, and bytes, by the name of the method.

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
        self._count("added", numbers.nbytes)
        return self.ranks.added(numbers)

    def greatest(self, values: Array) -> Array:
        """Greatest values over the ranks."""
        self._count("greatest", values.nbytes)
        return self.ranks.greatest(values)

    def exchanged(self, exchange: Exchange, field: Array) -> Array:
        """Field with the received values."""
        nodes = sum(map(len, exchange.send.values()))
        self._count("exchanged", nodes * int(np.prod(field.shape[1:])) * field.itemsize)
        return self.ranks.exchanged(exchange, field)

    def gathered(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks."""
        self._count("gathered", field.nbytes)
        return self.ranks.gathered(field)

    def collected(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks on rank 0."""
        self._count("collected", field.nbytes)
        return self.ranks.collected(field)

    def told(self, value: Any) -> Any:
        """The value of rank 0."""
        self._count("told", 0)
        return self.ranks.told(value)

    def _count(self, name: str, size: int) -> None:
        """Count a call that sends ``size`` bytes."""
        self.calls[name] += 1
        self.sent[name] += size
