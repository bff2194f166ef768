"""Commands over ranks: only rank 0 speaks, and no rank waits for one that has failed."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from softway.errors import Cancelled, InputError, NumericsError
from softway.ranks.interface import Ranks
from softway.ranks.launch import ranks_here, started, without_option
from softway.ranks.mpi import Processes, launched

WRONG_INPUT, FAILED, INTERRUPTED = 2, 3, 130


def begun(asked: int | None, arguments: list[str]) -> int | None:
    """Exit code of the command on as many processes as ``asked`` for; None if this process computes itself."""
    ranks_here(asked if asked is None or asked < 2 else None)
    if asked is None or asked < 2 or launched():
        return None
    return started(asked, without_option(arguments, "--ranks"))


@contextmanager
def among(ranks: Ranks | None) -> Iterator[None]:
    """End all ranks where this one fails alone; errors that all of them have are told by rank 0.

    Errors of the input and of the march are the same on all ranks.  All others, such as a full disk, an interruption or
    too little memory, are those of one rank.
    """
    try:
        yield
    except (InputError, NumericsError, Cancelled) as error:
        if ranks is None or not ranks.rank:
            raise
        raise SystemExit(WRONG_INPUT if isinstance(error, InputError) else FAILED) from None
    except BaseException as error:
        if isinstance(ranks, Processes) and ranks.size > 1 and not isinstance(error, SystemExit):
            told = f"{error}" or type(error).__name__
            sys.stderr.write(f"error rank {ranks.rank} of {ranks.size} ends the run: {told}\n")
            sys.stderr.flush()
            ranks.abort(INTERRUPTED if isinstance(error, KeyboardInterrupt) else FAILED)
        raise
