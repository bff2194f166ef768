"""Server of the page of a run, for this machine only."""

import secrets
import socket
import webbrowser
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial

from softway.errors import InputError
from softway.record.run import Run

HOST = "127.0.0.1"
Ready = Callable[[str], None]
"""Function called with the address when the page is ready."""


def serve(run: Run, *, port: int = 0, browser: bool = True, live: bool = False, ready: Ready | None = None) -> None:
    """Serve the page of a run until interrupted.

    Only this machine can open the page, and only with the token in its address.  Neither the page nor its files nor its
    web socket answer to requests without the token, to another name of the host, or to another page in the browser.

    Parameters
    ----------
    run
        The run.
    port
        Port; 0 for any free port.
    browser
        Open a browser.
    live
        Show new frames of a run that is still running.
    ready
        Function called with the address.

    Raises
    ------
    InputError
        If the extra ``view`` is not installed, the run has no frames, or the port is in use.
    """
    try:
        from softway.apps.viewer.app import page
        from softway.apps.viewer.guard import Guard, signpost
    except ImportError as error:
        problem = f"'{error.name}' is not installed"
        raise InputError("view", problem, "pip install 'softway[view]'") from None
    if not len(run.fields):
        raise InputError("view", "the run has no frames yet", "a run with at least one frame")
    require_free(port)
    made, token = page(run, live), secrets.token_urlsafe(16)
    server = made.server
    server.cli.parse_known_args = partial(server.cli.parse_known_args, [f"--authKey={token}"])
    server.controller.on_server_bind.add(Guard(token).watch)
    with ExitStack() as held:

        def opened(**_: object) -> None:
            address = f"http://{HOST}:{server.port}/?secret={token}"
            if ready is not None:
                ready(address)
            if browser:
                webbrowser.open(held.enter_context(signpost(address)))

        server.controller.on_server_ready.add(opened)
        server.start(
            port=port, host=HOST, backend="aiohttp", open_browser=False, show_connection_info=False,
            disable_logging=True, timeout=0,
        )  # fmt: skip


def require_free(port: int) -> None:
    """Raise :class:`InputError` if a port is in use."""
    try:
        with socket.socket() as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind((HOST, port))
    except OSError as error:
        raise InputError("--port", f"{port}: {error.strerror}", "another port, or no --port for any free one") from None
