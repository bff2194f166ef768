"""Errors of a command on the terminal."""

from cyclopts import CycloptsError
from rich.console import Console
from rich.markup import escape

from softway.errors import InputError


def failed(console: Console, error: Exception, code: int) -> int:
    """Print an error with its remedy and return the exit code."""
    told = str(error)
    if isinstance(error, CycloptsError):
        told += f"\n  try: {' '.join(('softway', *(error.command_chain or ()), '--help'))}"
    console.print(f"[bold red]error[/] {escape(told)}", soft_wrap=True, highlight=False)
    return code


def unusable(error: OSError) -> InputError:
    """Error for a path that cannot be used: too long, without permission, or on a file system that fails.

    Examples
    --------
    >>> unusable(OSError(36, "File name too long", "x.toml")).where
    'x.toml'
    """
    place = f"{error.filename}" if error.filename else "files"
    return InputError(place, f"{error.strerror or error}", "another path, in a folder that you can read and write")
