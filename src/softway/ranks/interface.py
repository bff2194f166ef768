"""Protocol of the ranks: processes, or threads, that each hold a part of the nodes (docs/theory/solver/ranks.md).

Every method is collective: all ranks call it in the same order.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Exchange:
    """Who sends which nodes to whom.

    Parameters
    ----------
    send, receive
        Rank -> numbers (k,) of the local nodes that it gets, or that come from it, in the same order on both sides.
    """

    send: Mapping[int, IntArray]
    receive: Mapping[int, IntArray]


class Ranks(Protocol):
    """Communication between the ranks."""

    @property
    def rank(self) -> int:
        """Number of this rank, from 0."""
        ...

    @property
    def size(self) -> int:
        """Number of ranks."""
        ...

    def added(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Sum over the ranks of integer arrays of one shape: exact, and the same on all ranks."""
        ...

    def greatest(self, values: Array) -> Array:
        """Greatest values over the ranks of arrays of one shape, which have no nan."""
        ...

    def exchanged(self, exchange: Exchange, field: Array) -> Array:
        """Field (n, ...) with the received values at the nodes that come from other ranks."""
        ...

    def gathered(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks, in their order, on every rank."""
        ...

    def collected(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks, in their order, on rank 0; empty on the others."""
        ...

    def told(self, value: Any) -> Any:
        """The value of rank 0."""
        ...
