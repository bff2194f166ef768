"""Log messages of the library on the terminal during a command."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.logging import RichHandler

Verbose = Annotated[bool, Parameter(name=["--verbose", "-v"], negative=())]
_TREE = "softway"


@contextmanager
def heard(console: Console) -> Iterator[None]:
    """Show warnings on a console; restore the log settings afterwards."""
    tree, handler = logging.getLogger(_TREE), RichHandler(console=console, show_time=False, show_path=False)
    before = tree.level
    tree.addHandler(handler)
    tree.setLevel(logging.WARNING)
    try:
        yield
    finally:
        tree.setLevel(before)
        tree.removeHandler(handler)


def listen(verbose: bool) -> None:
    """If ``verbose``, also show automatic choices and rejected slabs for the rest of the command."""
    if verbose:
        logging.getLogger(_TREE).setLevel(logging.INFO)
