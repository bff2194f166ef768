"""One writer for each run folder."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from softway.errors import InputError

if sys.platform != "win32":
    import fcntl


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Hold a run folder as its only writer; the hold ends with the process in any case.  Windows has no such hold.

    Raises
    ------
    InputError
        If a run is still writing to it.
    """
    if sys.platform == "win32":
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(str(folder), "a run is still writing to it", "stop that run, or wait for it") from None
        yield
    finally:
        os.close(handle)
