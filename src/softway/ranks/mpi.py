"""Ranks as processes of MPI."""

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array
from softway.errors import InputError
from softway.ranks.interface import Exchange

LAUNCHERS = ("PMI_SIZE", "OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "MPI_LOCALNRANKS")
"""Variables that a launcher of MPI sets for its processes."""
TAG = 7


@dataclass(frozen=True, slots=True, eq=False)
class Processes:
    """One process of a communicator; see :class:`~softway.ranks.interface.Ranks`."""

    comm: Any
    rank: int
    size: int

    def added(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Sum over the ranks."""
        out = np.empty_like(numbers)
        self.comm.Allreduce(np.ascontiguousarray(numbers), out)
        return out

    def greatest(self, values: Array) -> Array:
        """Greatest values over the ranks."""
        from mpi4py import MPI

        out = np.empty_like(values)
        self.comm.Allreduce(np.ascontiguousarray(values), out, op=MPI.MAX)
        return out

    def exchanged(self, exchange: Exchange, field: Array) -> Array:
        """Field with the received values."""
        from mpi4py import MPI

        got = {
            other: np.empty((len(nodes), *field.shape[1:]), field.dtype) for other, nodes in exchange.receive.items()
        }
        sent = {other: np.ascontiguousarray(field[nodes]) for other, nodes in exchange.send.items()}
        waits = [self.comm.Irecv(values, source=other, tag=TAG) for other, values in got.items()]
        waits += [self.comm.Isend(values, dest=other, tag=TAG) for other, values in sent.items()]
        MPI.Request.Waitall(waits)
        out = field.copy()
        for other, nodes in exchange.receive.items():
            out[nodes] = got[other]
        return out

    def gathered(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks."""
        return tuple(self.comm.allgather(field))

    def collected(self, field: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Arrays of all ranks on rank 0."""
        return tuple(self.comm.gather(field) or ())

    def told(self, value: Any) -> Any:
        """The value of rank 0."""
        return self.comm.bcast(value)

    def abort(self, code: int) -> None:
        """End the processes of all ranks with an exit code."""
        self.comm.Abort(code)


def launched() -> bool:
    """True if a launcher of MPI has started this process."""
    return any(name in os.environ for name in LAUNCHERS)


def processes() -> Processes:
    """The processes that a launcher of MPI has started.

    Raises
    ------
    InputError
        Without mpi4py, or without a library of MPI for it.
    """
    try:
        from mpi4py import MPI
    except (ImportError, RuntimeError) as error:
        raise InputError("ranks", f"mpi4py cannot be loaded: {error}", "pip install softway[mpi]") from None
    return Processes(comm=MPI.COMM_WORLD, rank=MPI.COMM_WORLD.Get_rank(), size=MPI.COMM_WORLD.Get_size())
