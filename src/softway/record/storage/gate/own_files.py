"""Files of a run folder that somebody sent: they are what they seem, and none of them leads out of the folder."""

from pathlib import Path

from softway.errors import InputError


def plain_file(path: Path) -> Path:
    """Return the path of a record after a check that it is a file or missing; a pipe or a device has no end.

    Raises
    ------
    OSError
        If it is something else.

    Examples
    --------
    >>> plain_file(Path("/dev/null"))
    Traceback (most recent call last):
    OSError: [Errno 22] no plain file: '/dev/null'
    """
    if path.exists() and not path.is_file():
        raise OSError(22, "no plain file", str(path))
    return path


def readable_file(path: Path) -> bool:
    """True if a path leads to a file; a path that no file system takes leads to none.

    Examples
    --------
    >>> readable_file(Path("x" * 5000))
    False
    """
    try:
        return path.is_file()
    except OSError:
        return False


def require_own(folder: Path) -> None:
    """Refuse a run folder that a resumed run must not write to: a link in it may lead to files of the user.

    Raises
    ------
    InputError
        With the link, pipe or device.
    """
    for path in (*folder.iterdir(), *(folder / "checkpoints").glob("*")):
        if path.is_symlink() or not (path.is_file() or path.is_dir()):
            problem = "is a link or a device, which a resumed run would write to"
            raise InputError(str(path), problem, "a copy of the run folder with plain files: cp -rL FOLDER COPY")
