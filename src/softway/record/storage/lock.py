"""Lock of a run folder: only one process writes to it, and readers can tell whether it still does."""

import os
import sys
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from softway.errors import InputError

if sys.platform != "win32":
    import fcntl

MOMENT = 0.001
"""Pause before the lock is tried again while a reader looks at it [s]."""


@contextmanager
def locked(folder: Path, shown: Path | None = None) -> Iterator[bool]:
    """Lock a run folder for writing; the lock ends with the process at the latest.  There is no lock on Windows.

    The lock belongs to the folder, not to its name: it stays when the folder is renamed.  The value is False if the
    path led to another folder by the time the lock was taken.

    Parameters
    ----------
    folder
        Folder to lock.
    shown
        Name of the folder in messages, if it is another.

    Raises
    ------
    InputError
        If another run is writing to the folder, or if its file system has no locks.
    """
    if sys.platform == "win32":
        yield True
        return
    try:
        handle = os.open(folder, os.O_RDONLY)
    except FileNotFoundError:
        yield False
        return
    try:
        while not _taken(handle, fcntl.LOCK_EX, folder):
            if not _taken(handle, fcntl.LOCK_SH, folder):
                problem = "a run is still writing to it"
                raise InputError(str(shown or folder), problem, "stop that run, or wait for it")
            fcntl.flock(handle, fcntl.LOCK_UN)  # only readers hold the lock, each for a moment
            clock.sleep(MOMENT)
        yield _leads_to(folder, handle)
    finally:
        os.close(handle)


def written_now(folder: Path) -> bool | None:
    """True if a process of this machine holds the lock of a folder; None if this cannot be told."""
    if sys.platform == "win32":
        return None
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return None
    try:
        return not _taken(handle, fcntl.LOCK_SH, folder)
    except InputError:
        return None
    finally:
        os.close(handle)


def _leads_to(folder: Path, handle: int) -> bool:
    """True if a path leads to an open folder."""
    try:
        return os.path.samestat(os.fstat(handle), folder.stat())
    except FileNotFoundError:
        return False


def _taken(handle: int, kind: int, folder: Path) -> bool:
    """Try to take a lock; False if another process or thread holds one that excludes it."""
    try:
        fcntl.flock(handle, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        raise InputError(str(folder), f"cannot be locked: {error.strerror}", "a folder on a local disk") from None
    return True
