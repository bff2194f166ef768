"""What the library tells on the terminal, as long as a command lasts."""

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
    """Show warnings on a console; the log is as it was afterwards."""
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
    """Show for the rest of the command what is chosen and rejected, too."""
    if verbose:
        logging.getLogger(_TREE).setLevel(logging.INFO)
