"""A process of the suite, seen from inside and from outside."""

import logging
import signal
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess

from softway.kernels.threads import use
from softway.verify.case import Case
from softway.verify.result import Result, examined


@dataclass(frozen=True, slots=True, eq=False)
class Worker:
    """A process and the line to it."""

    process: SpawnProcess
    line: Connection

    def dismissed(self) -> int | None:
        """End the process, if it has not ended; its exit code."""
        self.line.close()
        self.process.terminate()
        self.process.join()
        return self.process.exitcode


def hired(share: int) -> Worker:
    """A process that computes the cases sent to it; its kernels use ``share`` threads."""
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=serve, args=(theirs, share), daemon=True)
    process.start()
    theirs.close()
    return Worker(process, ours)


def serve(line: Connection, share: int) -> None:
    """Answer every case that comes with its result, or with the error that it raised as text, until the line closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interruption is for the suite, which ends its processes
    logging.getLogger("softway").setLevel(logging.ERROR)  # what a march of the suite warns of is known
    with use(share):
        while True:
            try:
                case: Case = line.recv()
            except EOFError:
                return
            line.send(_answer(case))


def _answer(case: Case) -> Result | str:
    try:
        return examined(case)
    except Exception as error:  # whatever a case raises is what is wrong with it
        return f"{type(error).__name__}: {error}"
