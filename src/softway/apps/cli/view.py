"""Command view: a run in the browser."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console

from softway.apps.viewer.serve import serve
from softway.errors import InputError
from softway.record.run import Run


def view(
    folder: Path,
    /,
    *,
    port: int = 0,
    browser: bool = True,
    live: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Show a run in the browser: moving mesh, fields, curves, events. Only this machine can open the page.

    Parameters
    ----------
    folder
        Run folder; the run may still be running.
    port
        Port on 127.0.0.1; by default any free port.
    browser
        Open a browser.
    live
        Show new frames of a run that is still running.
    """
    if not 0 <= port <= 65535:
        raise InputError("--port", f"{port}", "a number from 1 to 65535, or 0 for any free port")
    console, run = Console(), Run(folder)
    if run.of_mechanism:
        remedy = f"softway plot {folder}, or softway plot {folder} --film film.mp4"
        raise InputError(str(folder), "is the run of a mechanism, which has no page yet", remedy)

    def ready(address: str) -> None:
        console.print(f"{address}  (Ctrl-C to stop)", soft_wrap=True, highlight=False)

    with suppress(KeyboardInterrupt):
        serve(run, port=port, browser=browser, live=live, ready=ready)
