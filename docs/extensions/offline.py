"""Sphinx: a page that asks the network for a script, a style, a font or a picture is a warning."""

import re
from pathlib import Path
from typing import Any

from sphinx.util import logging

LOG = logging.getLogger(__name__)
TAG = r"""<(?:script|img|iframe|link)\b[^>]*?\b(?:src|href)=["']((?:https?:)?//[^"']+)"""
ASKS = re.compile(rf"""{TAG}|url\(["']?(https?:[^)"']+)""")


def setup(app: Any) -> dict[str, bool]:
    """Look at the pages and styles when they are written."""
    app.connect("build-finished", look)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def look(app: Any, failure: Exception | None) -> None:
    """Warn of each address."""
    if failure is None and app.builder.format == "html":
        for page in sorted(path for path in Path(app.outdir).rglob("*") if path.suffix in (".html", ".css")):
            for found in ASKS.findall(page.read_text(encoding="utf-8")):
                LOG.warning("%s asks the network for %s", page.relative_to(app.outdir), "".join(found))
