"""The page of a run served to this machine alone."""

import secrets
import socket
import webbrowser
from collections.abc import Callable
from functools import partial
from typing import Any

from softway.errors import InputError
from softway.record.run import Run

HOST = "127.0.0.1"
Ready = Callable[[str], None]
"""Called with the address when the page can be opened."""


def serve(run: Run, *, port: int = 0, browser: bool = True, live: bool = False, ready: Ready | None = None) -> None:
    """Serve the page of a run until interrupted; nothing but this machine can reach it, and only with the token that
    is in its address.

    Parameters
    ----------
    run
        The run.
    port
        Port; 0 for any that is free.
    browser
        Whether a browser is opened.
    live
        Whether frames that are appended are taken up.
    ready
        Called with the address.

    Raises
    ------
    InputError
        If the extra ``view`` is not installed, there is no frame, or the port is taken.
    """
    try:
        from softway.page.app import page
    except ImportError as error:
        problem = f"'{error.name}' is not installed"
        raise InputError("view", problem, "pip install 'softway[view]'") from None
    if not len(run.fields):
        raise InputError("view", "the run has no frames yet", "a run that has begun")
    require_free(port)
    made, token = page(run, live), secrets.token_urlsafe(16)
    server = made.server
    server.cli.parse_known_args = partial(server.cli.parse_known_args, ["--authKey", token])
    server.controller.on_server_ready.add(partial(_opened, server, token, browser, ready))
    server.start(port=port, host=HOST, open_browser=False, show_connection_info=False, disable_logging=True, timeout=0)


def require_free(port: int) -> None:
    """Refuse a port that is taken."""
    try:
        with socket.socket() as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind((HOST, port))
    except OSError as error:
        raise InputError("--port", f"{port}: {error.strerror}", "another port, or none for any that is free") from None


def _opened(server: Any, token: str, browser: bool, ready: Ready | None, **_: object) -> None:
    address = f"http://{HOST}:{server.port}/?secret={token}"
    if ready is not None:
        ready(address)
    if browser:
        webbrowser.open(address)
