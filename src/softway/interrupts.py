"""Interruptions of a process of our own, such as the command line or a worker."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

MOMENT = 0.01
"""Seconds after which a lost interruption is raised again."""


@contextmanager
def raised_again() -> Iterator[None]:
    """Raise interruptions again that are lost in finalisers and callbacks; for a process of our own."""
    before = sys.unraisablehook
    sys.unraisablehook = _again
    try:
        yield
    finally:
        sys.unraisablehook = before


def _again(lost: "sys.UnraisableHookArgs") -> None:
    """Raise an interruption again that was lost where exceptions cannot propagate."""
    if lost.exc_type is KeyboardInterrupt and hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_REAL, MOMENT)
    else:
        sys.__unraisablehook__(lost)
