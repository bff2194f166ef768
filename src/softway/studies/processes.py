"""Tasks computed in separate processes: a failure or crash of one task does not affect the others."""

import signal
import time as clock
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any, TypeVar

from softway.errors import Cancel, Cancelled
from softway.interrupts import raised_again
from softway.kernels.jit.threads import threads, use

Task = TypeVar("Task")
Reply = TypeVar("Reply")
GRACE = 20.0
"""Seconds that a terminated process has to complete its records."""
LOOK = 0.1
"""Seconds between two calls of ``cancel``."""


@dataclass(frozen=True, slots=True)
class Complaint:
    """Error of a task that returned no result.

    Parameters
    ----------
    text
        Message of the exception, or the exit code of the process.
    """

    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Worker:
    """Worker process and the connection to it."""

    process: SpawnProcess
    line: Connection

    def dismiss(self) -> None:
        """Terminate the process; the running task receives a ``KeyboardInterrupt``."""
        self.line.close()
        self.process.terminate()

    def ended(self) -> int | None:
        """Wait for the end of the process, kill it after a grace period, and return its exit code."""
        self.process.join(GRACE)
        self.process.kill()
        self.process.join()
        return self.process.exitcode


def answers(
    tasks: Sequence[Task], work: Callable[[Task], Reply], jobs: int, cancel: Cancel | None = None
) -> Generator[tuple[Task, Reply | Complaint, float], None, None]:
    """Compute the tasks in order of the sequence; yield each one with its result and wall time [s] when it is finished.

    Close the generator (``contextlib.closing``) to make sure that all processes end.

    Parameters
    ----------
    tasks
        Tasks that can be pickled.
    work
        Function defined in a module; an exception becomes the :class:`Complaint` of its task.
    jobs
        Number of parallel processes; the threads are shared equally among their kernels.
    cancel
        Called several times per second; returns True to stop.

    Raises
    ------
    Cancelled
        If ``cancel`` returns True, after all processes have ended.

    Examples
    --------
    >>> [answer for _, answer, _ in answers([], len, 2)]
    []
    """
    share = max(1, threads() // max(1, jobs))
    with _crew(min(jobs, len(tasks)), work, share) as crew:
        yield from _answers(list(tasks), crew, work, share, cancel)


@contextmanager
def _crew(number: int, work: Callable[[Any], Any], share: int) -> Iterator[list[Worker]]:
    """Worker processes that wait for tasks; all are ended on exit, also after an error."""
    crew: list[Worker] = []
    try:
        crew += [_hired(work, share) for _ in range(number)]
        yield crew
    finally:
        for worker in crew:
            worker.dismiss()
        for worker in crew:
            worker.ended()


def _answers(
    waiting: list[Any], crew: list[Worker], work: Callable[[Any], Any], share: int, cancel: Cancel | None
) -> Iterator[tuple[Any, Any, float]]:
    """Send the tasks to the workers, one at a time, and yield the results; a crashed worker is replaced."""
    busy: dict[Connection, tuple[int, Any, float]] = {}
    idle = list(range(len(crew)))
    while waiting or busy:
        while waiting and idle:
            place, task = idle.pop(), waiting.pop(0)
            crew[place].line.send(task)
            busy[crew[place].line] = place, task, clock.perf_counter()
        if cancel is not None and cancel():
            raise Cancelled(f"with {len(waiting) + len(busy)} left")
        for line in [line for line in wait(list(busy), LOOK if cancel else None) if isinstance(line, Connection)]:
            place, task, since = busy.pop(line)
            try:
                answer = line.recv()
            except (EOFError, ConnectionError):
                answer = Complaint(f"its process ended with code {crew[place].ended()}")
                line.close()
                crew[place] = _hired(work, share)
            yield task, answer, clock.perf_counter() - since
            idle.append(place)


def _hired(work: Callable[[Any], Any], share: int) -> Worker:
    """Start a worker process whose kernels use ``share`` threads."""
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, work, share), daemon=True)
    with _deferred():
        process.start()
    theirs.close()
    return Worker(process, ours)


@contextmanager
def _deferred() -> Iterator[None]:
    """Let Ctrl-C wait: a process that starts meanwhile is not interrupted before it has chosen to ignore it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing.resource_tracker import ensure_running

    ensure_running()  # its own start lets Ctrl-C through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(line: Connection, work: Callable[[Any], Any], share: int) -> None:
    """Compute incoming tasks until the connection closes or the process is terminated."""
    with suppress(KeyboardInterrupt):  # it is terminated after its connection was closed, before it ignores that
        try:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent handles Ctrl-C and ends its workers
            signal.signal(signal.SIGTERM, signal.default_int_handler)
            with raised_again(), use(share):
                while True:
                    line.send(_answer(line.recv(), work))
        except (EOFError, ConnectionError, KeyboardInterrupt):
            signal.signal(signal.SIGTERM, signal.SIG_IGN)  # it is already ending


def _answer(task: Any, work: Callable[[Any], Any]) -> Any:
    try:
        return work(task)
    except Exception as error:  # any exception of a task is reported
        return Complaint(f"{type(error).__name__}: {error}")
