"""Tasks computed by Dask. This is the only module that uses Dask."""

import logging
import time as clock
from collections.abc import Callable, Generator, Iterator, Sequence
from math import nan
from typing import Any, TypeVar

from softway.errors import Cancel, Cancelled, InputError
from softway.studies.processes import LOOK, Complaint

Task = TypeVar("Task")
Reply = TypeVar("Reply")
PATIENCE = 10.0
"""Time limit for the answer of a scheduler, and time without a worker after which that is told [s]."""
log = logging.getLogger(__name__)


def connected(address: str) -> Any:
    """Connect to a Dask scheduler and return the client.

    Raises
    ------
    InputError
        If Dask is not installed, or the scheduler does not answer.
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
    client: Any, tasks: Sequence[Task], work: Callable[[Task], Reply], cancel: Cancel | None = None
) -> Generator[tuple[Task, Reply | Complaint, float], None, None]:
    """Compute tasks like :func:`softway.studies.processes.answers`, on Dask workers that share the file system.

    The client is closed at the end.  If a worker is lost, its run goes on with another one, which resumes it.

    Raises
    ------
    Cancelled
        If ``cancel`` returns True; workers finish the tasks that they have started.
    """
    from distributed import as_completed

    with client:
        futures = {client.submit(work, task, pure=False, retries=0): task for task in tasks}
        for future in _ended(client, as_completed(list(futures), loop=client.loop), cancel):
            error = future.exception()
            answer = future.result() if error is None else Complaint(f"{type(error).__name__}: {error}")
            yield futures[future], answer, nan


def _ended(client: Any, coming: Any, cancel: Cancel | None) -> Iterator[Any]:
    """Yield the futures of ``as_completed`` until the caller cancels; say when there is no worker."""
    seen, told = clock.monotonic(), False
    while not coming.is_empty():
        while not coming.has_ready():
            if cancel is not None and cancel():
                raise Cancelled(f"with {coming.count()} left")
            if client.scheduler_info()["workers"]:
                seen, told = clock.monotonic(), False
            elif not told and clock.monotonic() - seen > PATIENCE:
                address, told = client.scheduler.address, True
                log.warning(
                    "%d runs wait: the scheduler has no worker; start one: dask worker %s", coming.count(), address
                )
            clock.sleep(LOOK)
        if cancel is not None and cancel():
            raise Cancelled(f"with {coming.count()} left")
        yield next(coming)
