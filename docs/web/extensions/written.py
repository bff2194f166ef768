"""Sphinx: what is looked at when the pages are written, each complaint a warning.

A page asks the network for no script, style, font or picture; every link to a page, to a place on it, or to a file
leads there.
"""

import re
from collections.abc import Iterator, Mapping
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from sphinx.util import logging

LOG = logging.getLogger(__name__)
TAG = r"""<(?:script|img|iframe|link)\b[^>]*?\b(?:src|href)=["']((?:https?:)?//[^"']+)"""
ASKS = re.compile(rf"""{TAG}|url\(["']?(https?:[^)"']+)""")
LINK = re.compile(r"""<(?:a|img)\b[^>]*?\b(?:href|src)="([^"]+)\"""")
PLACE = re.compile(r"""\b(?:id|name)="([^"]+)\"""")
ELSEWHERE = re.compile(r"[a-z]+:|//")


def setup(app: Any) -> dict[str, bool]:
    """Look at the pages and styles when they are written."""
    app.connect("build-finished", look)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def look(app: Any, failure: Exception | None) -> None:
    """Warn of each address on the network, and of each link that leads nowhere."""
    if failure is not None or app.builder.format != "html":
        return
    folder = Path(app.outdir)
    texts = {path: path.read_text(encoding="utf-8") for path in folder.rglob("*") if path.suffix in (".html", ".css")}
    places = {path: {unescape(place) for place in PLACE.findall(text)} for path, text in texts.items()}
    for path, text in sorted(texts.items()):
        for found in ASKS.findall(text):
            LOG.warning("%s asks the network for %s", path.relative_to(folder), "".join(found))
        for link in lost(path, text, places):
            LOG.warning("%s: the link %s leads nowhere", path.relative_to(folder), link)


def lost(page: Path, text: str, places: Mapping[Path, set[str]]) -> Iterator[str]:
    """Links of a page to files or to places on pages that are not there."""
    for link in {unescape(found) for found in LINK.findall(text)}:
        if page.suffix != ".html" or ELSEWHERE.match(link):
            continue
        address, _, place = link.partition("#")
        target = (page.parent / unquote(address.partition("?")[0])).resolve() if address else page
        if not target.exists() or place and target in places and unquote(place) not in places[target]:
            yield link
