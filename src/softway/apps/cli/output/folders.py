"""Names of new folders."""

from pathlib import Path


def free(folder: Path) -> Path:
    """First of folder, folder-2, folder-3, ... that does not exist."""
    number = 1
    found = folder
    while found.exists():
        number += 1
        found = folder.with_name(f"{folder.name}-{number}")
    return found
