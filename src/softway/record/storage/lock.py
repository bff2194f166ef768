"""Lock of a run folder: only one process writes to it."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from softway.errors import InputError

if sys.platform != "win32":
    import fcntl


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Lock a run folder for writing; the lock ends with the process at the latest.  There is no lock on Windows.

    Raises
    ------
    InputError
        If another run is writing to the folder.
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
