"""Tasks worked off by Dask: the one door to it."""

from collections.abc import Callable, Generator, Sequence
from math import nan
from typing import Any, TypeVar

from softway.crew import Complaint
from softway.errors import InputError

Task = TypeVar("Task")
Reply = TypeVar("Reply")
PATIENCE = 10.0
"""Seconds in which a scheduler has to answer."""


def connected(address: str) -> Any:
    """A client of the scheduler at an address.

    Raises
    ------
    InputError
        Dask is not installed, or nobody answers.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InputError("--scheduler", "Dask is not installed", "pip install 'softway[dask]'") from None
    try:
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        remedy = "the address that dask scheduler prints, such as tcp://127.0.0.1:8786"
        raise InputError("--scheduler", f"no answer from {address!r}: {error}", remedy) from None


def answers_from(
    client: Any, tasks: Sequence[Task], work: Callable[[Task], Reply]
) -> Generator[tuple[Task, Reply | Complaint, float], None, None]:
    """As :func:`softway.crew.answers`, from workers that see the same files; closes the client at the end."""
    from distributed import as_completed

    with client:
        futures = {client.submit(work, task, pure=False, retries=0): task for task in tasks}
        for future in as_completed(list(futures), loop=client.loop):
            error = future.exception()
            answer = future.result() if error is None else Complaint(f"{type(error).__name__}: {error}")
            yield futures[future], answer, nan
