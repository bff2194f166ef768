"""Atomic writing of files: a file is complete or does not exist."""

import os
from pathlib import Path


def replaced(path: Path, data: bytes, sync: bool = False) -> None:
    """Replace a file atomically; readers never see a partial file.

    Parameters
    ----------
    path, data
        File and its new content.
    sync
        If True, return only after the data are physically on the disk.

    Raises
    ------
    OSError
        If the file cannot be written, for example on a full disk; the old file stays.
    """
    partial = path.with_name(f".{path.name}.partial")
    try:
        with partial.open("wb") as file:
            file.write(data)
            file.flush()
            if sync:
                os.fsync(file.fileno())
        partial.replace(path)
    except OSError:
        partial.unlink(missing_ok=True)
        raise
    if sync:
        synced(path.parent)


def synced(folder: Path) -> None:
    """Flush the entries of a folder to the disk, on systems where folders can be opened."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
