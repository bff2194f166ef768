"""How many processes work beside each other."""

import os

from softway.errors import InputError


def processes(asked: int | None) -> int:
    """Those of ``--jobs``; by default one for each processor.

    Examples
    --------
    >>> processes(3)
    3
    """
    if asked is not None and asked < 1:
        raise InputError("--jobs", f"{asked}", "1 or more")
    return asked or os.cpu_count() or 1
