"""Cases computed in processes of their own: what one of them does, or dies of, does not reach another."""

import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait

from softway.kernels.threads import threads
from softway.verify.case import Case
from softway.verify.result import Result, failed
from softway.verify.worker import Worker, hired

Watch = Callable[[Result], None]


def verified(cases: Sequence[Case], *, jobs: int = 1, watch: Watch | None = None) -> tuple[Result, ...]:
    """Compute the cases in processes, the longest first, and compare them.

    Parameters
    ----------
    cases
        Which ones.
    jobs
        Processes beside each other; the kernels of each use its share of the threads.
    watch
        Is called with each result as it comes.

    Returns
    -------
    tuple[Result, ...]
        In the order of the cases; one that raised an error, or whose process died, is a failed one with the reason.
    """
    found: dict[str, Result] = {}
    share = max(1, threads() // max(1, jobs))
    with _crew(min(jobs, len(cases)), share) as crew:
        for result in _results(sorted(cases, key=lambda c: -c.seconds), crew, share):
            found[result.case.id] = result
            if watch is not None:
                watch(result)
    return tuple(found[case.id] for case in cases)


@contextmanager
def _crew(number: int, share: int) -> Iterator[list[Worker]]:
    """Processes that wait for cases; all are gone at the end, whatever happens."""
    crew: list[Worker] = []
    try:
        crew += [hired(share) for _ in range(number)]
        yield crew
    finally:
        for worker in crew:
            worker.dismissed()


def _results(waiting: list[Case], crew: list[Worker], share: int) -> Iterator[Result]:
    """Hand out the cases, one at a time to each worker, and yield what comes back; one who died is replaced."""
    busy: dict[Connection, tuple[int, Case, float]] = {}
    idle = list(range(len(crew)))
    while waiting or busy:
        while waiting and idle:
            place, case = idle.pop(), waiting.pop(0)
            crew[place].line.send(case)
            busy[crew[place].line] = place, case, clock.perf_counter()
        for line in [line for line in wait(list(busy)) if isinstance(line, Connection)]:
            place, case, since = busy.pop(line)
            try:
                answer = line.recv()
            except (EOFError, ConnectionError):
                answer = f"its process ended with code {crew[place].dismissed()}"
                crew[place] = hired(share)
            yield failed(case, answer, clock.perf_counter() - since) if isinstance(answer, str) else answer
            idle.append(place)
