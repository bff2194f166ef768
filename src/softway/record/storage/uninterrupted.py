"""Work that an interruption does not cut: Python raises ``KeyboardInterrupt`` in the main thread only.

HDF5 calls back into Python for each read and write of a file object.  An exception that is raised there cannot reach
the caller: it is printed and lost, and HDF5 takes the data for written.
"""

from collections.abc import Callable
from contextvars import copy_context
from threading import Event, Lock, Thread
from typing import Generic, TypeVar

Result = TypeVar("Result")


class _Task(Generic[Result]):
    """Work in a thread of its own, with its result or exception."""

    __slots__ = ("claim", "done", "error", "off", "result", "work")

    def __init__(self, work: Callable[[], Result]) -> None:
        self.work, self.claim, self.done, self.off = work, Lock(), Event(), False
        self.result: Result
        self.error: BaseException | None = None

    def run(self) -> None:
        with self.claim:
            if not self.off:
                try:
                    self.result = self.work()
                except BaseException as error:
                    self.error = error
                self.done.set()

    def drop(self) -> None:
        """Wait for the end of the work if it has begun; otherwise it never begins."""
        with self.claim:
            self.off = True


def uninterrupted(work: Callable[[], Result], release: Callable[[Result], object] = lambda result: None) -> Result:
    """Result of some work that a ``KeyboardInterrupt`` does not cut; the interruption is raised when the work is done.

    Parameters
    ----------
    work
        Function without arguments, called in a thread of its own.
    release
        Function that gives up a result that the interruption prevents from being returned.

    Examples
    --------
    >>> uninterrupted(lambda: 6 * 7)
    42
    """
    task = _Task(work)
    try:
        Thread(target=copy_context().run, args=(task.run,), daemon=True).start()
        task.done.wait()
    except BaseException:
        task.drop()
        if task.done.is_set() and task.error is None:
            release(task.result)
        raise
    if task.error is not None:
        raise task.error
    return task.result
