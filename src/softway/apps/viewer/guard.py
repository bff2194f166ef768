"""Guard of the page: each request must come from this machine's own page and show the token.

The token is in the address of the page.  The first answer sets it as a cookie, which the browser sends with all further
requests, those for files and for the web socket included.
"""

import secrets
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web

NAMES = ("127.0.0.1", "localhost", "::1")
"""Names of this machine in the address of the page; a port forwarded by ssh has another number."""
SOCKET = "/ws"
"""Path of the web socket."""
HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
"""Headers of every answer: no other page can show this one or read from it, and the address is not passed on."""
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


@dataclass(frozen=True, slots=True)
class Guard:
    """Guard of the requests to a page.

    Parameters
    ----------
    token
        Token that a request must show, in its address or as a cookie.
    """

    token: str

    def refusal(self, request: web.Request) -> web.HTTPException | None:
        """Answer to a request that is refused; None if it is admitted."""
        if _hostname(f"//{request.host}") not in NAMES:
            return web.HTTPForbidden(text="another name than that of this machine: open the address that was printed\n")
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc.lower() != request.host.lower():
            return web.HTTPForbidden(text="a request from another page\n")
        shown = (request.query.get("secret"), request.cookies.get(self.cookie(request)))
        if not any(self._same(word) for word in shown):
            return web.HTTPForbidden(text="no token: open the address that was printed\n")
        if request.path == SOCKET and not web.WebSocketResponse().can_prepare(request).ok:
            return web.HTTPBadRequest(text="a web socket: it opens with the page\n")
        return None

    def cookie(self, request: web.Request) -> str:
        """Name of the cookie; the pages of two ports have two."""
        return f"softway-{request.host.rpartition(':')[2]}"

    def _same(self, word: str | None) -> bool:
        return word is not None and secrets.compare_digest(word.encode(), self.token.encode())

    async def answer(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Answer to a request: a refusal, or what the page answers."""
        refused = self.refusal(request)
        if refused is not None:
            refused.headers.update(HEADERS)
            raise refused
        try:
            found = await handler(request)
        except web.HTTPException as other:  # such as the way from / to index.html
            self._sign(request, other)
            raise
        if not found.prepared:
            self._sign(request, found)
        return found

    def _sign(self, request: web.Request, answer: web.StreamResponse | web.HTTPException) -> None:
        answer.headers.update(HEADERS)
        answer.set_cookie(self.cookie(request), self.token, httponly=True, samesite="Strict", path="/")

    def watch(self, server: Any, **_: object) -> None:
        """Put the guard in front of all that a server answers, before it starts."""

        @web.middleware
        async def guarded(request: web.Request, handler: Handler) -> web.StreamResponse:
            return await self.answer(request, handler)

        server.app.middlewares.append(guarded)


@contextmanager
def signpost(address: str) -> Iterator[str]:
    """Address of a local file that leads a browser to ``address`` and that only its owner can read.

    The arguments of a process, such as a browser, can be read by all users of a machine.
    """
    with TemporaryDirectory(prefix="softway-view-") as folder:
        file = Path(folder) / "page.html"
        to = escape(address, quote=True)
        head = '<!doctype html><meta charset="utf-8"><meta name="referrer" content="no-referrer"><title>softway</title>'
        lead = f'<meta http-equiv="refresh" content="0; url={to}"><a href="{to}">page of the run</a>'
        file.write_text(f"{head}\n{lead}\n", encoding="utf-8")
        file.chmod(0o600)
        yield file.as_uri()


def _hostname(address: str) -> str | None:
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None
