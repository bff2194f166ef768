"""Names of the package itself, which load what they need when they are used, and hints for those that it has not.

The names are listed in ``__init__.pyi``.  This is the only module that uses lazy_loader.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import lazy_loader

PACKAGES = (
    "bodies", "contact", "heat", "laws", "mechanisms", "meshes", "model", "obstacles", "piles", "record", "solve",
    "studies",
)  # fmt: skip
"""Packages that export the names of softway that are one dot deeper."""


def public(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Functions ``__getattr__`` and ``__dir__`` of a package, and its ``__all__``, by the stub beside its file.

    Parameters
    ----------
    package, file
        Name of the package, and its ``__init__.py``.

    Examples
    --------
    >>> import softway
    >>> softway.public_names.public("softway", softway.__file__)[0]("march")
    <function march at ...>
    """
    load, directory, names = lazy_loader.attach_stub(package, file)

    def attribute(name: str) -> Any:
        return load(name) if name in names else missing(name)

    return attribute, directory, [name for name in names if name not in PACKAGES]


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
