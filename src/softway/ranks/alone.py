"""One rank alone."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array
from softway.ranks.interface import Exchange


@dataclass(frozen=True, slots=True)
class Alone:
    """One rank, which has all nodes; see :class:`~softway.ranks.interface.Ranks`.

    Examples
    --------
    >>> Alone().added(np.array([1, 2])).tolist()
    [1, 2]
    """

    rank: int = 0
    size: int = 1

    def added(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """The numbers."""
        return numbers

    def greatest(self, values: Array) -> Array:
        """The values."""
        return values

    def exchanged(self, exchange: Exchange, field: Array) -> Array:
        """The field."""
        return field

    def gathered(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """The field alone."""
        return (field,)

    def collected(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """The field alone."""
        return (field,)

    def told(self, value: Any) -> Any:
        """The value."""
        return value
