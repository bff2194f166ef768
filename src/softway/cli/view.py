"""The verb view: a run in the browser."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console

from softway.errors import InputError
from softway.page.serve import serve
from softway.record.run import Run


def view(
    folder: Path,
    /,
    *,
    port: int = 0,
    browser: bool = True,
    live: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Show a run in the browser: moving mesh, fields, curves, events; only this machine can open the page.

    Parameters
    ----------
    folder
        Run folder, also of a run that goes on.
    port
        Port on 127.0.0.1; by default any that is free.
    browser
        Whether to open a browser.
    live
        Follow a run that goes on.
    """
    if not 0 <= port <= 65535:
        raise InputError("--port", f"{port}", "a number from 1 to 65535, or 0 for any that is free")
    console = Console()

    def ready(address: str) -> None:
        console.print(f"{address}  (Ctrl-C to stop)", soft_wrap=True, highlight=False)

    with suppress(KeyboardInterrupt):
        serve(Run(folder), port=port, browser=browser, live=live, ready=ready)
