"""Command view: a run in the browser."""

import webbrowser
from contextlib import suppress
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console

from softway.apps.cli.output.tables import sentences_of
from softway.apps.viewer.serve import serve
from softway.errors import InputError
from softway.record.run import Run
from softway.record.storage.atomic_file import replaced
from softway.record.view.page import page

PAGE = "view.html"
"""File of the page of a mechanism, a pile or conductors."""


def view(
    folder: Path,
    /,
    *,
    port: int = 0,
    browser: bool = True,
    live: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Show a run in the browser: moving mesh, fields, curves, events. Only this machine can open the page.

    Of a mechanism, a pile or conductors the page is a file, view.html in the run folder, with its positions or
    temperatures, curves and events.

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
    if run.of_mechanism or run.of_pile or run.of_heat:
        if live or port:
            problem = "a page of its own is made of this run, without a server"
            raise InputError("--live, --port", problem, "omit them; softway view again for what is new")
        _page(run, console, browser)
        return

    def ready(address: str) -> None:
        console.print(f"{address}  (Ctrl-C to stop)", soft_wrap=True, highlight=False)

    with suppress(KeyboardInterrupt):
        serve(run, port=port, browser=browser, live=live, ready=ready)


def _page(run: Run, console: Console, browser: bool) -> None:
    """Write the page of a mechanism, a pile or conductors into its folder, and open it."""
    file = run.path / PAGE
    with console.status("first picture") as status:
        text = page(run, sentences_of(run, run.summary), lambda done, of: status.update(f"picture {done} of {of}"))
    try:
        replaced(file, text.encode())
    except OSError as error:
        raise InputError(str(file), f"cannot be written: {error.strerror}", "a copy of the run folder") from None
    console.print(file.resolve().as_uri(), soft_wrap=True, highlight=False)
    if browser:
        webbrowser.open(file.resolve().as_uri())
