"""Files that are there as a whole or not at all."""

import os
from pathlib import Path


def replaced(path: Path, data: bytes, sync: bool = False) -> None:
    """Write a whole file or none, in place of the one of that name; readers never see half of it.

    Parameters
    ----------
    path, data
        Name and content.
    sync
        Whether it shall be on the disk, and not only on its way, before anything else is done.

    Raises
    ------
    OSError
        If there is no room; the old file stays.
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
    """Bring the names in a folder to the disk, where folders can be opened."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
