"""Hints for names that are not exported by the package itself."""

from importlib import import_module
from typing import Any

PACKAGES = (
    "bodies", "contact", "heat", "laws", "mechanisms", "meshes", "model", "obstacles", "piles", "record", "solve",
    "studies",
)  # fmt: skip
"""Packages that export the names of softway that are one dot deeper."""


def missing(name: str) -> Any:
    """Refuse a name that the package does not export, with the places where it is.

    Raises
    ------
    AttributeError
        Always.

    Examples
    --------
    >>> missing("Ball")
    Traceback (most recent call last):
    AttributeError: module 'softway' has no attribute 'Ball'; did you mean softway.meshes.Ball?
    """
    places = [f"softway.{package}" for package in PACKAGES if not name.startswith("_")]
    found = [f"{place}.{name}" for place in places if name in import_module(place).__all__]
    hint = f"; did you mean {' or '.join(found)}?" if found else ""
    raise AttributeError(f"module 'softway' has no attribute {name!r}{hint}")
