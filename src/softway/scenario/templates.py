"""Scenarios to start from."""

from collections.abc import Mapping
from importlib import resources


def templates() -> Mapping[str, str]:
    """TOML text of each template by its name: a bar on a wall, a block on a floor, a part from a mesh file.

    Examples
    --------
    >>> list(templates())
    ['bar', 'block', 'part']
    """
    folder = resources.files("softway.scenario") / "templates"
    return {name: (folder / f"{name}.toml").read_text(encoding="utf-8") for name in ("bar", "block", "part")}
