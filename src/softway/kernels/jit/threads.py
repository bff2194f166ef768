"""Number of threads of the kernels; results do not depend on it, to the last bit.

Kernels release the lock of the interpreter and run side by side in ordinary threads.  The threads live for one call.
Models that are computed at the same time share nothing, and a forked process inherits no threads.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar

from numba import config

_PARTS = 2  # a thread is not started for fewer parts of a body
_CHOSEN: ContextVar[int] = ContextVar("softway.threads")


def threads() -> int:
    """Number of threads set by :func:`use`, otherwise the number of processors (``NUMBA_NUM_THREADS``)."""
    return _CHOSEN.get(int(config.NUMBA_NUM_THREADS))


@contextmanager
def use(number: int) -> Iterator[None]:
    """Let the kernels called in this context use ``number`` threads.

    Examples
    --------
    >>> with use(1):
    ...     threads()
    1
    """
    before = _CHOSEN.set(max(1, number))
    try:
        yield
    finally:
        _CHOSEN.reset(before)


def share(task: Callable[[int, int], object], parts: int) -> None:
    """Call ``task(first, last)`` on ranges that cover all parts, in as many threads as are worthwhile.

    Examples
    --------
    >>> share(lambda first, last: print(first, last), 3)
    0 3
    """
    crew = min(threads(), parts // _PARTS)
    if crew < 2:
        task(0, parts)
        return
    cuts = [parts * k // crew for k in range(crew + 1)]
    with ThreadPoolExecutor(crew - 1) as pool:
        others = [pool.submit(task, *cut) for cut in zip(cuts[1:-1], cuts[2:], strict=True)]
        task(cuts[0], cuts[1])
        for other in others:
            other.result()
