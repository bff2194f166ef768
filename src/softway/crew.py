"""Tasks worked off in processes of their own: what one of them does, or dies of, does not reach another."""

import signal
import sys
import time as clock
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any, TypeVar

from softway.errors import Cancel, Cancelled
from softway.kernels.threads import threads, use

Task = TypeVar("Task")
Reply = TypeVar("Reply")
GRACE = 20.0
"""Seconds that a process has to put its records in order when it is told to end."""
MOMENT = 0.01
"""Seconds after which an interruption that was lost comes again."""
LOOK = 0.1
"""Seconds after which the caller is asked again whether it wants the rest."""


@dataclass(frozen=True, slots=True)
class Complaint:
    """Why a task has no answer.

    Parameters
    ----------
    text
        The error that it raised, or how its process ended.
    """

    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Worker:
    """A process and the line to it."""

    process: SpawnProcess
    line: Connection

    def dismiss(self) -> None:
        """Tell the process to end: what it computes sees a ``KeyboardInterrupt``."""
        self.line.close()
        self.process.terminate()

    def ended(self) -> int | None:
        """Wait for the end of the process, which is forced after a while; its exit code."""
        self.process.join(GRACE)
        self.process.kill()
        self.process.join()
        return self.process.exitcode


def answers(
    tasks: Sequence[Task], work: Callable[[Task], Reply], jobs: int, cancel: Cancel | None = None
) -> Generator[tuple[Task, Reply | Complaint, float], None, None]:
    """Work off the tasks, the first first, and yield each with its answer and the seconds it took, as they come.

    Close the generator (``contextlib.closing``) to be sure that no process is left.

    Parameters
    ----------
    tasks
        Each can be pickled.
    work
        A function of a module; whatever it raises is the complaint of that task.
    jobs
        Processes beside each other; the kernels of each use its share of the threads.
    cancel
        Asked a few times a second whether the caller wants no more.

    Raises
    ------
    Cancelled
        If it says so, after all processes have ended.

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
    """Processes that wait for tasks; all are gone at the end, whatever happens."""
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
    """Hand out the tasks, one at a time to each worker, and yield what comes back; one who died is replaced."""
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
    """A process that works off the tasks sent to it; its kernels use ``share`` threads."""
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, work, share), daemon=True)
    process.start()
    theirs.close()
    return Worker(process, ours)


def _serve(line: Connection, work: Callable[[Any], Any], share: int) -> None:
    """Answer every task that comes, until the line closes or the process is told to end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interruption is for the one who hired, who ends the processes
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    sys.unraisablehook = _again
    try:
        with use(share):
            while True:
                line.send(_answer(line.recv(), work))
    except (EOFError, ConnectionError, KeyboardInterrupt):
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # it ends by itself


def _again(lost: "sys.UnraisableHookArgs") -> None:
    """An interruption that fell into a finaliser, which cannot pass it on, comes again a moment later."""
    if lost.exc_type is KeyboardInterrupt and hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_REAL, MOMENT)
    else:
        sys.__unraisablehook__(lost)


def _answer(task: Any, work: Callable[[Any], Any]) -> Any:
    try:
        return work(task)
    except Exception as error:  # whatever a task raises is what is wrong with it
        return Complaint(f"{type(error).__name__}: {error}")
