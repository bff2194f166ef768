"""Ranks as threads of one process: the same communication without another library, to compare numbers of ranks."""

from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Barrier, BrokenBarrierError, Thread
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array
from softway.ranks.interface import Exchange

Result = TypeVar("Result")


class RankLost(Exception):
    """Another rank has ended with an error."""


@dataclass(frozen=True, slots=True, eq=False)
class Team:
    """Place where threads meet: what each of them has brought, and a barrier."""

    size: int
    board: dict[int, Any] = field(default_factory=dict)
    barrier: Barrier = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "barrier", Barrier(self.size))

    def meet(self, rank: int, brought: Any) -> tuple[Any, ...]:
        """What all ranks have brought, in their order."""
        try:
            self.board[rank] = brought
            self.barrier.wait()
            found = tuple(self.board[k] for k in range(self.size))
            self.barrier.wait()
        except BrokenBarrierError:
            raise RankLost(f"rank {rank} waits for a rank that has ended") from None
        return found


@dataclass(frozen=True, slots=True, eq=False)
class Threads:
    """One rank of a :class:`Team`; see :class:`~softway.ranks.interface.Ranks`."""

    rank: int
    team: Team

    @property
    def size(self) -> int:
        """Number of ranks."""
        return self.team.size

    def added(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Sum over the ranks."""
        return np.sum(self.team.meet(self.rank, numbers), axis=0)

    def greatest(self, values: Array) -> Array:
        """Greatest values over the ranks."""
        return np.max(self.team.meet(self.rank, values), axis=0)

    def exchanged(self, exchange: Exchange, field: Array) -> Array:
        """Field with the received values."""
        brought = self.team.meet(self.rank, {other: field[nodes] for other, nodes in exchange.send.items()})
        out = field.copy()
        for other, nodes in exchange.receive.items():
            out[nodes] = brought[other][self.rank]
        return out

    def gathered(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks."""
        return self.team.meet(self.rank, field)

    def collected(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks on rank 0."""
        found = self.team.meet(self.rank, field)
        return found if self.rank == 0 else ()

    def told(self, value: Any) -> Any:
        """The value of rank 0."""
        return self.team.meet(self.rank, value)[0]


def in_threads(size: int, task: Callable[[Threads], Result]) -> list[Result]:
    """Results of a ``task`` on every rank, each in a thread of its own.

    Raises
    ------
    Exception
        The error of the first rank that did not end because of another one, with a note of its rank.

    Examples
    --------
    >>> in_threads(3, lambda ranks: int(ranks.added(np.array([ranks.rank]))[0]))
    [3, 3, 3]
    """
    team, results, errors = Team(size), {}, {}

    def run(rank: int) -> None:
        try:
            results[rank] = task(Threads(rank, team))
        except BaseException as error:
            error.add_note(f"on rank {rank} of {size}")
            errors[rank] = error
            team.barrier.abort()

    threads = [Thread(target=run, args=(rank,)) for rank in range(size)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for _, error in sorted(errors.items(), key=lambda item: (isinstance(item[1], RankLost), item[0])):
        raise error
    return [results[rank] for rank in range(size)]
